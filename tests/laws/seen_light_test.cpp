// SPDX-License-Identifier: GPL-3.0-or-later
// What chains leave out is what is sampled beside them.
#include <gtest/gtest.h>

#include "core/estimators/sampling.h"
#include "core/path/connection.h"
#include "core/util/parallel.h"
#include "mlt/render.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

constexpr int kReplicates = 64, kSamples = 1 << 15, kMaxDepth = 8;
/// Sums by path length, and moments over the film, of one replicate.
constexpr int kMoments = 3, kColumns = kMaxDepth + 2 + kMoments;
using Sums = std::array<double, kColumns>;
constexpr int kTests = 10 * kColumns;

void add(Sums& sums, const Contribution& c) {
  const double y = luminance(c.value) / kSamples;
  sums[c.k] += y;
  sums[kMaxDepth + 2] += y;
  sums[kMaxDepth + 3] += y * c.raster.x;
  sums[kMaxDepth + 4] += y * c.raster.y;
}

template <class Sample>
std::vector<Sums> replicates(Sample&& sample) {
  std::vector<Sums> all(kReplicates, Sums{});
  parallel_for(kReplicates, [&](std::int64_t r) {
    Workspace w;
    for (int i = 0; i < kSamples; ++i) sample(r, i, w, all[r]);
  });
  return all;
}

Estimate column(const std::vector<Sums>& all, int c) {
  std::vector<double> values;
  for (const Sums& sums : all) values.push_back(sums[c]);
  return estimate(values);
}

/// By the definition: nothing but degenerate vertices between the eye and what shines.
bool is_seen_light(const Path& path) {
  for (std::size_t i = 1; i + 1 < path.size(); ++i)
    if (!path[i].degenerate) return false;
  const VertexKind kind = path[0].kind;
  return kind == VertexKind::Surface || kind == VertexKind::InfiniteLight ||
         kind == VertexKind::Medium;
}

class SeenLight : public ::testing::TestWithParam<TestScene> {};

TEST_P(SeenLight, IsAllThatBdptLeavesOut) {
  const Scene scene(GetParam().make());
  const auto all = make_bdpt(scene, {.max_depth = kMaxDepth});
  const auto rest = make_bdpt(scene, {.max_depth = kMaxDepth, .seen_light = false});
  Workspace a, b;
  for (int i = 0; i < 5000; ++i) {
    for (const auto& [estimator, w] : {std::pair(all.get(), &a), {rest.get(), &b}}) {
      Rng rng(suite_seed(), RngDomain::Test, 6, i);
      RandomStream stream(rng);
      estimator->sample(stream, stream, *w);
    }
    std::erase_if(a.contributions, [&](const Contribution& c) {
      return is_seen_light(assemble(scene, a.light, c.s, a.eye, c.t));
    });
    ASSERT_EQ(a.contributions.size(), b.contributions.size());
    for (std::size_t j = 0; j < a.contributions.size(); ++j)
      ASSERT_EQ(a.contributions[j].value, b.contributions[j].value);
  }
}

/// The eye's subpath chooses one event at a time and may stop in fog; what it runs into has no
/// weight here, for this is the only technique.
TEST_P(SeenLight, IsWhatTheEyeRunsInto) {
  const Scene scene(GetParam().make());
  const auto estimator = make_seen_light(scene, {.max_depth = kMaxDepth});
  const auto run_into = replicates([&](std::int64_t r, int i, Workspace& w, Sums& sums) {
    Rng rng(suite_seed(), RngDomain::Test, static_cast<std::uint64_t>(r), i);
    RandomStream stream(rng);
    Vec2 raster;
    trace_eye_subpath(scene, stream, kMaxDepth + 1, w.eye, raster);
    for (int t = 2; t <= static_cast<int>(w.eye.size()); ++t) {
      Vertex& x = w.eye[t - 1].x;
      if (t > 2 && !w.eye[t - 2].x.degenerate) break;
      if (!hittable(scene, x)) continue;
      const std::vector<int> sky = scene.infinite_emitters();
      for (const int emitter : x.infinite() ? sky : std::vector{x.emitter}) {
        x.emitter = emitter;
        if (const auto c = run_into_light(scene, w.eye, t)) add(sums, {raster, c->value, t, 0, t});
      }
    }
  });
  const auto seen = replicates([&](std::int64_t r, int i, Workspace& w, Sums& sums) {
    Rng rng(suite_seed(), RngDomain::Sampling, static_cast<std::uint64_t>(r), i);
    RandomStream stream(rng);
    estimator->sample(stream, stream, w);
    for (const Contribution& c : w.contributions) add(sums, c);
  });
  const double level = sidak(kSuiteFalseAlarm, kTests);
  for (int c = 0; c < kColumns; ++c) {
    const Estimate a = column(run_into, c), b = column(seen, c);
    if (a.standard_error == 0 && b.standard_error == 0) {
      EXPECT_EQ(a.mean, b.mean) << "column " << c;
      continue;
    }
    EXPECT_GT(welch(a, b), level) << "column " << c << ": " << a.mean << " ± " << a.standard_error
                                  << " against " << b.mean << " ± " << b.standard_error;
  }
  const Estimate a = column(run_into, kMaxDepth + 2), b = column(seen, kMaxDepth + 2);
  if (!(b.mean > 0)) return;
  constexpr double kBias = 0.3;
  std::printf("%-20s run into %.4g ± %.1g, seen light %.4g ± %.1g; finds a bias of 30%%: %.3f\n",
              GetParam().name.c_str(), a.mean, a.standard_error, b.mean, b.standard_error,
              power(a, b, kBias * b.mean, level));
  const std::string& name = GetParam().name;
  const bool rarely_found = name == "glass-sphere-fog" || name == "fog-in-glass" ||
                            name == "smoke-in-glass" || name == "overlapping-volumes";
  if (!rarely_found) {
    EXPECT_GT(power(a, b, kBias * b.mean, level), 0.99);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SeenLight, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

/// The same samples, without those of two vertices.
TEST(HiddenEmitters, AreLeftOutAndNothingElse) {
  for (const char* name : {"sky-lens", "two-kinds-of-glass", "sun-and-can"}) {
    const Scene scene(make_test_scene(name));
    EstimatorSettings settings{.max_depth = 4};
    EstimatorSettings hiding = settings;
    hiding.hide_emitters = true;
    for (const auto make : {make_path_tracer, make_light_tracer, make_bdpt, make_seen_light}) {
      const auto all = make(scene, settings), hidden = make(scene, hiding);
      int left_out = 0;
      Workspace a, b;
      for (std::uint64_t i = 0; i < 2000; ++i) {
        for (const auto& [estimator, w] : {std::pair{all.get(), &a}, {hidden.get(), &b}}) {
          Rng rng(suite_seed(), RngDomain::Test, 97, i);
          RandomStream stream(rng);
          estimator->sample(stream, stream, *w);
        }
        const std::size_t before = a.contributions.size();
        std::erase_if(a.contributions, [](const Contribution& c) { return c.k == 2; });
        left_out += before > a.contributions.size();
        ASSERT_EQ(a.contributions.size(), b.contributions.size()) << name << all->name();
        for (std::size_t j = 0; j < a.contributions.size(); ++j) {
          ASSERT_EQ(a.contributions[j].value, b.contributions[j].value);
          ASSERT_EQ(a.contributions[j].k, b.contributions[j].k);
        }
      }
      const bool pinhole = scene.sensor().dirac_position() || scene.sensor().parallel();
      const bool may_see_none = std::string(all->name()) == "light" && pinhole;
      EXPECT_TRUE(left_out > 0 || may_see_none) << name << ", " << all->name();
    }
  }
}

/// Emission of a medium is no emitter that could be hidden.
TEST(HiddenEmitters, AreNoFlames) {
  const Scene scene(make_test_scene("flame"));
  const auto path = make_path_tracer(scene, {.max_depth = 4, .hide_emitters = true});
  int seen = 0;
  Workspace w;
  for (std::uint64_t i = 0; i < 500; ++i) {
    Rng rng(suite_seed(), RngDomain::Test, 98, i);
    RandomStream stream(rng);
    path->sample(stream, stream, w);
    for (const Contribution& c : w.contributions) seen += c.k == 2;
  }
  EXPECT_GT(seen, 0);
}

/// Where there is nothing else to see, too.
TEST(SeenLightAlone, IsRenderedWithoutChains) {
  SceneDescription d = make_test_scene("sky-lens");
  d.surfaces.clear();
  const Scene scene(std::move(d));
  RenderOptions options;
  options.samples_per_pixel = 1;
  options.overrides = {{"luminance_samples", "64"}};
  for (const char* integrator : {"mlt", "pssmlt"}) {
    options.integrator = integrator;
    const RenderResult result = render(scene, options);
    const double sky = luminance(RGB(0.5, 0.7, 1));
    EXPECT_NEAR(result.b, sky, 6 * result.b_stderr);
    EXPECT_LT(result.b_stderr, 0.02 * sky);
    EXPECT_FALSE(result.notes.empty());
  }
}

}  // namespace
}  // namespace fogbow::testing
