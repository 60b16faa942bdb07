// SPDX-License-Identifier: GPL-3.0-or-later
// b between samples and chains that meet halfway, where neither side alone knows it.
#include <gtest/gtest.h>

#include "mlt/bootstrap.h"
#include "mlt/chain_ensemble.h"
#include "mlt/mutations/path_mutations.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "tests/helpers/statistics.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

constexpr int kMaxDepth = 7, kVertices = kMaxDepth + 1, kRuns = 32, kReferences = 64;
constexpr int kReferenceSamples = 1 << 14, kBootstrap = 4096, kChains = 4;
/// A render bridges what is 300 b and more; here it is b itself.
constexpr double kHalfway = 1.0 / 300;
constexpr double kWanted = 0.1;
const std::vector<std::string> kScenes{"floor-fog", "glass-sphere-fog", "two-kinds-of-glass"};

class BridgeLaw : public ::testing::TestWithParam<std::string> {
 protected:
  BridgeLaw()
      : scene_(make_test_scene(GetParam())),
        bdpt_(make_bdpt(scene_, {.max_depth = kMaxDepth, .seen_light = false})),
        pilot_(run_pilot(*bdpt_, 1, suite_seed(), 1 << 13)),
        techniques_(pilot_.techniques, kVertices),
        bridge_(kHalfway * pilot_.f_star) {}

  Estimate by_bdpt() const {
    std::vector<double> means(kReferences);
    parallel_for(kReferences, [&](std::int64_t r) {
      PrimarySample x(pilot_.importance);
      for (int i = 0; i < kReferenceSamples; ++i) {
        Rng rng(suite_seed(), RngDomain::Test, static_cast<std::uint64_t>(r), i);
        x.draw(*bdpt_, rng);
        means[r] += x.f_star() / kReferenceSamples;
      }
    });
    return estimate(means);
  }

  /// `log_ratio`: log f*/p of what `start` makes of a sample and a uniform number.
  template <class State, class LogRatio, class Start>
  Estimate by_chains(const MutationTable<State>& table, std::uint64_t steps,
                     const LogRatio& log_ratio, const Start& start) const {
    std::vector<double> b;
    for (std::uint64_t run = 0; run < kRuns; ++run) {
      const std::uint64_t seed = suite_seed() + run * 0x9E3779B97F4A7C15;
      const Bootstrap bootstrap(
          *bdpt_, seed, kBootstrap, pilot_.importance,
          [&](const PrimarySample& x, double u) { return bridge_(log_ratio(x, u)); });
      ChainEnsemble<State> ensemble(
          table, seed, kChains,
          [&](int group, std::uint64_t chain) {
            Rng rng(seed, RngDomain::Test, chain, 1);
            const double choice = rng.uniform();
            return start(bootstrap.start(group, rng.uniform()), choice);
          },
          bridge_);
      Film film(scene_.film(), -36);
      ensemble.run([&](std::size_t) { return steps; }, film);
      Normalization n = bootstrap.normalization();
      for (std::size_t i = 0; i < ensemble.size(); ++i)
        n.add(ensemble.group_of(i), ensemble.record(i).bridge);
      b.push_back(n.b());
    }
    return estimate(b);
  }

  void expect_equal(const char* title, const Estimate& chains) const {
    const Estimate bdpt = by_bdpt();
    const double level = sidak(kSuiteFalseAlarm, static_cast<int>(2 * kScenes.size()));
    EXPECT_GT(welch(bdpt, chains), level)
        << title << ": " << chains.mean << " ± " << chains.standard_error << ", BDPT " << bdpt.mean
        << " ± " << bdpt.standard_error;
    EXPECT_GE(power(bdpt, chains, kWanted * bdpt.mean, level), 0.99);
    std::printf("%s, %s: ratio %.4f ± %.4f\n", GetParam().c_str(), title, chains.mean / bdpt.mean,
                std::hypot(chains.standard_error, bdpt.standard_error) / bdpt.mean);
  }

  const Scene scene_;
  const std::unique_ptr<Estimator> bdpt_;
  const Pilot pilot_;
  const TechniqueDistribution techniques_;
  const Bridge bridge_;
};

TEST_P(BridgeLaw, PathsFindB) {
  // Large steps are chosen far more seldom from some paths than from others.
  const auto table = make_path_mutations({{"large_step", 4},
                                          {"bidirectional", 2},
                                          {"lens", 2},
                                          {"scattering", 20},
                                          {"multichain", 20}},
                                         techniques_, kVertices);
  const auto state = [&](const PrimarySample& x, double u) {
    return PathSample::choose(scene_, kVertices, x, u).value();
  };
  expect_equal("paths", by_chains<PathSample>(
                            table, 10000,
                            [&](const PrimarySample& x, double u) {
                              const PathSample y = state(x, u);
                              return y.log_f_star() - log_large_step_density(y, techniques_);
                            },
                            state));
}

TEST_P(BridgeLaw, PrimarySamplesFindB) {
  expect_equal("primary samples", by_chains<PrimarySample>(
                                      make_primary_sample_mutations(*bdpt_, 0.3), 400,
                                      [](const PrimarySample& x, double) { return x.log_f_star(); },
                                      [](const PrimarySample& x, double) { return x; }));
}

INSTANTIATE_TEST_SUITE_P(Scenes, BridgeLaw, ::testing::ValuesIn(kScenes), [](const auto& info) {
  std::string name = info.param;
  std::ranges::replace(name, '-', '_');
  return name;
});

}  // namespace
}  // namespace fogbow::testing
