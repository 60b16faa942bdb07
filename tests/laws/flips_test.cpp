// SPDX-License-Identifier: GPL-3.0-or-later
// Moves that are hard to make are made: flips through specular chains, both ways and as often, and
// walks.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/util/parallel.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

const int kSamples = std::getenv("FOGBOW_LONG") ? 1 << 19 : 1 << 16;
constexpr int kMaxDepth = 7, kBlock = 256;
/// Steps from every path.
constexpr int kSteps = 4;

constexpr int kKinds = static_cast<int>(MutationCounts::kMostKinds);

/// Of one step from the target law, by kind: Σ a per sample, and its squares for the differences of
/// two directions (kinds 2i and 2i + 1).
struct Flows {
  std::array<double, kKinds> proposed{}, accepted{};
  std::array<double, kKinds / 2> squares{};
  void add(const Flows& f) {
    for (int i = 0; i < kKinds; ++i) {
      proposed[i] += f.proposed[i];
      accepted[i] += f.accepted[i];
      squares[i / 2] += i % 2 ? 0 : f.squares[i / 2];
    }
  }
};

Flows measure_flows(const std::string& scene_name, const std::string& mutation) {
  const Scene scene(make_test_scene(scene_name));
  const PathPopulation population(scene, kMaxDepth, suite_seed());
  const auto table =
      make_path_mutations({{mutation, 1.0}}, population.techniques(), population.max_vertices());
  std::vector<Flows> blocks(kSamples / kBlock);
  parallel_for(static_cast<std::int64_t>(blocks.size()), [&](std::int64_t b) {
    std::vector<PathSample> parts;
    for (std::uint64_t n = 0; n < kBlock; ++n) {
      const std::uint64_t sample = static_cast<std::uint64_t>(b) * kBlock + n;
      population.draw(sample, 1, parts);
      std::array<double, kKinds> a{};
      for (std::size_t part = 0; part < parts.size(); ++part) {
        if (!(table[0]->selection_weight(parts[part]) > 0)) continue;
        for (int step = 0; step < kSteps; ++step) {
          Chain<PathSample> chain(parts[part], table);
          Rng rng(suite_seed(), RngDomain::Chain, sample * 4096 + part, step);
          const StepInfo info = chain.step(table, rng, [](const PathSample&, double) {});
          blocks[b].proposed[info.proposal.kind] += 1;
          a[info.proposal.kind] += info.a;
        }
      }
      for (int i = 0; i < kKinds; ++i) blocks[b].accepted[i] += a[i];
      for (int i = 0; i < kKinds / 2; ++i) blocks[b].squares[i] += sqr(a[2 * i] - a[2 * i + 1]);
    }
  });
  Flows total;
  for (const Flows& f : blocks) total.add(f);
  return total;
}

/// The groups of flips that go together: bits of a kind as switch's kinds() list them.
struct Group {
  const char* name;
  int bit;
};
constexpr Group kGroups[] = {{"held through specular", 4}, {"re-connected through specular", 8}};
/// Least share of proposals that is accepted, each way.
constexpr double kLeastShare = 0.01;

class Flips : public ::testing::TestWithParam<const char*> {};

TEST_P(Flips, HappenBothWaysAndAsOften) {
  const Flows flows = measure_flows(GetParam(), "switch");
  for (const Group& group : kGroups) {
    double proposed[2] = {}, accepted[2] = {}, squares = 0;
    for (int kind = 0; kind < kKinds; ++kind) {
      if (!(kind & group.bit)) continue;
      proposed[kind % 2] += flows.proposed[kind];
      accepted[kind % 2] += flows.accepted[kind];
      if (kind % 2 == 0) squares += flows.squares[kind / 2];
    }
    for (const int direction : {0, 1}) {
      const double share = accepted[direction] / proposed[direction];
      std::printf("%-18s %-30s %s %.0f of %.0f accepted, %.2f%%\n", GetParam(), group.name,
                  direction ? "V-S" : "S-V", accepted[direction], proposed[direction], 100 * share);
      EXPECT_GT(proposed[direction], 1000) << group.name;
      EXPECT_GT(share, kLeastShare) << group.name << (direction ? " V-S" : " S-V");
    }
    EXPECT_LT(std::abs(accepted[0] - accepted[1]), 5 * std::sqrt(squares)) << group.name;
  }
}

/// Each kind has its reverse: what flips one way comes back by the same side, chains and walks.
TEST_P(Flips, AgreeKindByKind) {
  const Flows flows = measure_flows(GetParam(), "switch");
  for (int i = 0; i < kKinds / 2; ++i) {
    if (flows.accepted[2 * i] + flows.accepted[2 * i + 1] < 50) continue;
    EXPECT_LT(std::abs(flows.accepted[2 * i] - flows.accepted[2 * i + 1]),
              5 * std::sqrt(flows.squares[i]))
        << "kinds " << 2 * i << " and " << 2 * i + 1;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Flips, ::testing::Values("glass-sphere-fog", "water"),
                         [](const auto& info) {
                           return test_name({info.param, nullptr});
                         });

class Walks : public ::testing::TestWithParam<const char*> {};

TEST_P(Walks, ManifoldIsAcceptedOften) {
  const Flows flows = measure_flows(GetParam(), "manifold");
  const double share = flows.accepted[0] / flows.proposed[0];
  std::printf("%-18s manifold %.0f of %.0f accepted, %.2f%%\n", GetParam(), flows.accepted[0],
              flows.proposed[0], 100 * share);
  EXPECT_GT(flows.proposed[0], 1000);
  EXPECT_GT(share, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Walks, ::testing::Values("mirror-fog", "water"),
                         [](const auto& info) {
                           return test_name({info.param, nullptr});
                         });

}  // namespace
}  // namespace fogbow::testing
