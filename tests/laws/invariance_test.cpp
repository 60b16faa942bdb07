// SPDX-License-Identifier: GPL-3.0-or-later
// Chains that start from the target law stay in it: E h(x_K) = E h(x_0), for every mutation alone
// (applied with probability π(x̄), else nothing happens) and for the mixture.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/util/parallel.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

const bool kLong = std::getenv("FOGBOW_LONG") != nullptr;
const int kSamples = kLong ? 1 << 18 : 1 << 14;
constexpr int kSteps = 6;
constexpr int kMaxDepth = 7;
constexpr double kPartsPerSample = 1;
/// Samples in which a feature must have changed for a z-test of its mean to mean anything.
constexpr int kLeastChanges = 50;
constexpr int kBlock = 256;

/// Nothing happens.
class Stay final : public Mutation<PathSample> {
 public:
  const char* name() const override { return "stay"; }
  double selection_weight(const PathSample&) const override { return 0.25; }
  Proposal propose(const PathSample& x, PathSample& y, Rng&) const override {
    y = x;
    return {};
  }
};

struct Sums {
  std::vector<double> difference, squares;
  std::vector<int> changes;
  MutationCounts counts;
  explicit Sums(std::size_t n) : difference(n), squares(n), changes(n) {}
};

/// Chains from the samples of one block.
void run_block(const Scene& scene, const PathPopulation& population,
               const MutationTable<PathSample>& table, const std::vector<Feature>& features,
               std::uint64_t block, Sums& sums) {
  std::vector<PathSample> parts;
  std::vector<double> d(features.size());
  for (std::uint64_t sample = block * kBlock; sample < (block + 1) * kBlock; ++sample) {
    population.draw(sample, kPartsPerSample, parts);
    std::ranges::fill(d, 0.0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      Chain<PathSample> chain(parts[part], table);
      for (int step = 0; step < kSteps; ++step) {
        Rng rng(suite_seed(), RngDomain::Chain, sample * 4096 + part, step);
        chain.step(table, rng, [](const PathSample&, double) {});
      }
      sums.counts.add(chain.counts()[0]);
      if (chain.counts()[0].accepted == 0 && table.size() == 2) continue;
      for (std::size_t i = 0; i < features.size(); ++i)
        d[i] += features[i].value(chain.state().path()) - features[i].value(parts[part].path());
    }
    for (std::size_t i = 0; i < features.size(); ++i) {
      sums.difference[i] += d[i];
      sums.squares[i] += d[i] * d[i];
      sums.changes[i] += d[i] != 0;
    }
  }
  (void)scene;
}

class Invariance : public ::testing::TestWithParam<TestScene> {};

TEST_P(Invariance, ChainsStayInTheTargetLaw) {
  const Scene scene(GetParam().make());
  const PathPopulation population(scene, kMaxDepth, suite_seed());
  const auto features = path_features(scene);
  const MutationWeights all = default_mutation_weights();
  std::vector<MutationWeights> mixtures = {all};
  for (const auto& [name, weight] : all) mixtures.push_back({{name, 1.0}});
  const int suites = static_cast<int>(test_scenes().size() * mixtures.size() * features.size());
  const double level = sidak(kSuiteFalseAlarm, suites);

  for (const MutationWeights& mixture : mixtures) {
    auto table = make_path_mutations(mixture, population.techniques(), population.max_vertices());
    if (table.size() == 1) table.push_back(std::make_unique<Stay>());
    const std::string name = mixture.size() > 1 ? "mixture" : mixture.begin()->first;
    const int blocks = kSamples / kBlock;
    std::vector<Sums> sums(blocks, Sums(features.size()));
    parallel_for(blocks, [&](std::int64_t b) {
      run_block(scene, population, table, features, static_cast<std::uint64_t>(b), sums[b]);
    });
    Sums total(features.size());
    for (const Sums& s : sums) {
      total.counts.add(s.counts);
      for (std::size_t i = 0; i < features.size(); ++i) {
        total.difference[i] += s.difference[i];
        total.squares[i] += s.squares[i];
        total.changes[i] += s.changes[i];
      }
    }
    double worst = 0;
    std::string worst_feature;
    for (std::size_t i = 0; i < features.size(); ++i) {
      if (total.changes[i] < kLeastChanges) continue;
      const double z = total.difference[i] / std::sqrt(total.squares[i]);
      if (std::abs(z) > std::abs(worst)) worst_feature = features[i].name, worst = z;
      EXPECT_GT(p_value_normal(z), level)
          << name << ": " << features[i].name << " drifts, z = " << z << " over "
          << total.changes[i] << " samples";
    }
    std::printf(
        "%-18s %-14s %7llu proposed %5.1f%% accepted, non-finite %llu; worst z %+.2f (%s)\n",
        GetParam().name.c_str(), name.c_str(),
        static_cast<unsigned long long>(total.counts.proposed),
        100.0 * static_cast<double>(total.counts.accepted) /
            std::max<double>(1, static_cast<double>(total.counts.proposed)),
        static_cast<unsigned long long>(
            total.counts.rejected[static_cast<std::size_t>(Rejection::NonFinite)]),
        worst, worst_feature.c_str());
    EXPECT_EQ(total.counts.rejected[static_cast<std::size_t>(Rejection::NonFinite)], 0u) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Invariance, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace fogbow::testing
