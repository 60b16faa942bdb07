// SPDX-License-Identifier: GPL-3.0-or-later
// A walk that led to a proposal leads back: where several chains join the same ends, only those
// that are each other's image may be paired.
#include "mlt/manifold/walk.h"

#include <gtest/gtest.h>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "mlt/mutations/retrace.h"
#include "tests/helpers/statistics.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

/// The chain that a manifold mutation has solved, told from the path alone: beside the one vertex
/// that has moved freely there is a specular chain on one side only.
std::optional<Segment> solved_chain(const Scene& scene, const MeasuredPath& x,
                                    const MeasuredPath& y) {
  int moved = -1;
  for (int i = 1; i < x.last(); ++i) {
    if (is_glossy(scene, x[i])) return std::nullopt;
    if (x[i].degenerate || x[i].position() == y[i].position()) continue;
    if (moved >= 0) return std::nullopt;
    moved = i;
  }
  if (moved < 0 || x[moved - 1].degenerate == x[moved + 1].degenerate) return std::nullopt;
  const Side toward = x[moved - 1].degenerate ? Side::Light : Side::Eye;
  const auto there = segment_from(x, moved, toward);
  if (!there) return std::nullopt;
  return Segment{there->end, moved, toward == Side::Light ? Side::Eye : Side::Light};
}

TEST(Walk, LeadsBackToWhereItCameFrom) {
  constexpr int kPaths = 4000, kTries = 8;
  const Scene scene(make_test_scene("glass-sphere-fog"));
  const PathPopulation population(scene, 6, suite_seed());
  const auto table = make_path_mutations({{"manifold", 1.0}, {"large_step", 1.0}},
                                         population.techniques(), population.max_vertices());
  const auto& manifold = *std::ranges::find_if(
      table, [](const auto& m) { return std::string_view(m->name()) == "manifold"; });
  std::vector<PathSample> parts;
  int proposed = 0, one_way = 0, compared = 0;
  for (int sample = 0; compared < kPaths; ++sample) {
    population.draw(static_cast<std::uint64_t>(sample), 1, parts);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const PathSample& x = parts[part];
      if (!(manifold->selection_weight(x) > 0)) continue;
      PathSample y = x;
      for (int i = 0; i < kTries; ++i) {
        Rng rng(suite_seed(), RngDomain::Chain, sample * 64 + part, i);
        const Proposal proposal = manifold->propose(x, y, rng);
        ++proposed;
        one_way += proposal.rejection == Rejection::NotReversible;
        if (proposal.rejection) continue;
        const auto chain = solved_chain(scene, x.path(), y.path());
        if (!chain) continue;
        ++compared;
        MeasuredPath back = y.path();
        back.vertex(chain->end) = x.path()[chain->end];
        ASSERT_TRUE(walk(scene, back, *chain));
        for (int v = chain->anchor + chain->step(); v != chain->end; v += chain->step())
          ASSERT_LT(length(back[v].position() - x.path()[v].position()), 1e-5 * scene.radius());
      }
    }
  }
  // Else there was nothing to be refused, and the test could not fail.
  EXPECT_GT(one_way, proposed / 200);
}

/// Behind surfaces that light passes in part, a vertex lies beyond as many of them as before: else
/// the way back would end on another. In sight of panes that some directions meet and some do not.
TEST(Retrace, LeadsBackToWhereItCameFrom) {
  constexpr int kPaths = 16000, kTries = 4;
  const Scene scene(make_test_scene("coatings"));
  const PathPopulation population(scene, 6, suite_seed());
  std::vector<PathSample> parts;
  int compared = 0, through = 0, refused = 0;
  const auto passages = [](const MeasuredPath& x, const Segment& s) {
    std::int64_t sum = 0;
    for (int i = s.anchor; i != s.end; i += s.step())
      sum += x.edge(std::min(i, i + s.step())).passages;
    return sum;
  };
  const auto try_segment = [&](const MeasuredPath& x, const Segment& s, Rng& rng) {
    MeasuredPath y = x;
    const Vec3 w = departure(x, s);
    const Vec3 turned = normalize(w + 0.3 * warp::sample_sphere(uniform2(rng)));
    const auto why = retrace(scene, y, s, turned);
    refused += why == Rejection::WrongConfiguration && passages(x, s) > 0;
    if (why) return;
    ++compared;
    through += x[s.end].on_surface() && passages(x, s) > 0;
    MeasuredPath back = y;
    ASSERT_FALSE(retrace(scene, back, s, w)) << passages(x, s) << " passages";
    for (int i = s.anchor; i != s.end; i += s.step()) {
      const Vec3 apart = back[i + s.step()].position() - x[i + s.step()].position();
      ASSERT_LT(length(apart), 1e-6 * scene.radius()) << passages(x, s) << " passages";
    }
  };
  for (int sample = 0; compared < kPaths; ++sample) {
    population.draw(static_cast<std::uint64_t>(sample), 1, parts);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      const MeasuredPath& x = parts[part].path();
      Rng rng(suite_seed(), RngDomain::Test, sample * 64 + part, 0);
      for (int i = 0; i < x.size(); ++i)
        for (const Side toward : {Side::Light, Side::Eye}) {
          const auto segment = segment_from(x, i, toward);
          if (x[i].degenerate || x[i].infinite() || !segment || !movable(scene, x, *segment))
            continue;
          for (int j = 0; j < kTries; ++j) try_segment(x, *segment, rng);
          if (HasFatalFailure()) return;
        }
    }
  }
  // Else the panes were never in the way.
  EXPECT_GT(through, kPaths / 200);
  EXPECT_GT(refused, kPaths / 200);
}

}  // namespace
}  // namespace fogbow::testing
