// SPDX-License-Identifier: GPL-3.0-or-later
// b from both ends of a bridge, where everything is known: f* = 1/x^a on [ε, 1].
#include "mlt/normalization.h"

#include <gtest/gtest.h>

#include "core/util/rng.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

constexpr double kPower = 0.95, kStart = 1e-7;
constexpr int kRuns = 400, kSamples = 4000;

double f_star(double x) { return std::pow(x, -kPower); }
double primitive(double x) { return std::pow(x, 1 - kPower) / (1 - kPower); }
const double kB = primitive(1) - primitive(kStart);

/// Distributed like f*/b.
double state(Rng& rng) {
  const double u = rng.uniform();
  return std::pow((1 - kPower) * (primitive(kStart) + u * kB), 1 / (1 - kPower));
}

/// Samples are uniform on the interval. States of small x stand for more: the chain looks at them
/// less often.
BridgeSums run(const Bridge& bridge, std::uint64_t stream, bool with_states) {
  Rng rng(testing::suite_seed(), RngDomain::Test, stream, 40);
  BridgeSums sums;
  for (int i = 0; i < kSamples; ++i) {
    const double y = kStart + (1 - kStart) * rng.uniform(), ratio = f_star(y) * (1 - kStart);
    sums.add_sample(ratio, bridge(std::log(ratio)));
    const double x = state(rng), looked_at = x < 0.01 ? 0.2 : 0.8;
    if (with_states && rng.uniform() < looked_at)
      sums.add_state(bridge(std::log(f_star(x) * (1 - kStart))), 1 / looked_at);
  }
  return sums;
}

TEST(Bridge, FindsTheIntegralWithAFractionOfTheError) {
  std::vector<double> bridged, plain;
  for (int i = 0; i < kRuns; ++i) {
    bridged.push_back(run(Bridge(3 * kB), i, true).b());
    plain.push_back(run(Bridge(3 * kB), i, false).b());
  }
  const testing::Estimate a = testing::estimate(bridged), b = testing::estimate(plain);
  EXPECT_GT(testing::compare(a, kB), 1e-4) << a.mean << " ± " << a.standard_error << " for " << kB;
  EXPECT_GT(testing::compare(b, kB), 1e-4) << b.mean << " ± " << b.standard_error << " for " << kB;
  EXPECT_LT(a.standard_error, 0.5 * b.standard_error);
}

TEST(Bridge, WithoutABridgeIsTheMeanOfTheSamples) {
  const BridgeSums sums = run(Bridge(), 0, true);
  EXPECT_DOUBLE_EQ(sums.b(), sums.f_star / kSamples);
  EXPECT_EQ(Bridge()(700), 1);
  EXPECT_EQ(Bridge(0)(700), 1);
}

TEST(Normalization, PoolsGroupsAndTellsTheirSpread) {
  Normalization n;
  BridgeSums all;
  std::array<double, Film::kGroups> groups;
  for (int g = 0; g < Film::kGroups; ++g) {
    const BridgeSums sums = run(Bridge(kB), 1000 + g, true);
    n.add(g, sums);
    all.add(sums);
    groups[g] = sums.b();
    EXPECT_EQ(n.b(g), sums.b());
  }
  EXPECT_EQ(n.b(), all.b());
  EXPECT_EQ(n.samples(), std::uint64_t{Film::kGroups} * kSamples);
  const double of_samples =
      std::sqrt(all.sampled_squares / sqr(all.sampled) - 1 / static_cast<double>(all.samples));
  EXPECT_NEAR(n.standard_error(),
              std::max(replicate_mean(groups).standard_error, of_samples * all.b()), 1e-12 * kB);
}

/// Groups alone miss by more than three of their standard errors in 3% of all runs.
TEST(Normalization, IsAsSureAsItSays) {
  constexpr double kMild = 0.45, kTruth = 1 / (1 - kMild);
  constexpr int kTries = 2000, kOfGroup = 500;
  int beyond = 0;
  for (int i = 0; i < kTries; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, i, 41);
    Normalization n;
    for (int g = 0; g < Film::kGroups; ++g) {
      BridgeSums sums;
      for (int s = 0; s < kOfGroup; ++s) sums.add_sample(std::pow(1 - rng.uniform(), -kMild), 1);
      n.add(g, sums);
    }
    beyond += std::abs(n.b() - kTruth) > 3 * n.standard_error();
  }
  EXPECT_LT(beyond, 0.015 * kTries);
}

/// Each group has 0 and 2 as often as another, so that their means are one.
TEST(Normalization, DoesNotTakeAgreementForCertainty) {
  Normalization n;
  for (int g = 0; g < Film::kGroups; ++g) {
    BridgeSums sums;
    for (int s = 0; s < 50; ++s) sums.add_sample(2.0 * (s % 2), 1);
    n.add(g, sums);
  }
  EXPECT_EQ(n.b(), 1);
  EXPECT_DOUBLE_EQ(n.standard_error(), 1 / std::sqrt(50.0 * Film::kGroups));
}

/// A group whose states never are where samples come, by a chance that its own error does not tell.
TEST(Normalization, LeavesABridgeThatHoldsNothing) {
  Normalization n;
  BridgeSums all;
  for (int g = 0; g < Film::kGroups; ++g) {
    BridgeSums sums = run(Bridge(kB), 1000 + g, true);
    if (g == 3) sums.visited *= 1e-9;
    n.add(g, sums);
    all.add(sums);
  }
  EXPECT_EQ(n.b(), all.f_star / static_cast<double>(all.samples));
  EXPECT_LT(n.standard_error(), 0.5 * n.b());
}

TEST(Normalization, KnowsAsMuchAsEqualSamplesWould) {
  Normalization n;
  EXPECT_EQ(n.effective_samples(), 0);
  BridgeSums sums;
  for (int i = 0; i < 60; ++i) sums.add_sample(i < 20 ? 3.0 : 0.0, 1);
  n.add(0, sums);
  EXPECT_DOUBLE_EQ(n.effective_samples(), 20);
  sums.add_sample(3e6, 1);
  n.add(1, sums);
  EXPECT_NEAR(n.effective_samples(), 1, 1e-3);
}

/// 1, 2, …, 8 have the mean 4.5 and the variance 6; their mean has an eighth of it.
TEST(Normalization, StandardErrorIsThatOfTheMean) {
  std::array<double, Film::kGroups> replicates;
  for (int g = 0; g < Film::kGroups; ++g) replicates[g] = g + 1;
  static_assert(Film::kGroups == 8);
  const ReplicateMean m = replicate_mean(replicates);
  EXPECT_DOUBLE_EQ(m.mean, 4.5);
  EXPECT_DOUBLE_EQ(m.standard_error, std::sqrt(6.0 / 8));
}

/// Of 100 samples a group, half 0 and half 2 have a variance of 1 and their mean of 1/100; in two
/// groups half are 0.2 and 2.2. The mean of all is 1.05: six groups are off by −0.05, two by 0.15,
/// in units of a standard error of 0.1.
TEST(Normalization, TellsHowGroupsDisagree) {
  Normalization n;
  for (int g = 0; g < Film::kGroups; ++g) {
    BridgeSums sums;
    for (int i = 0; i < 100; ++i) sums.add_sample((i % 2 ? 2 : 0) + (g < 2 ? 0.2 : 0), 1);
    n.add(g, sums);
  }
  EXPECT_NEAR(n.disagreement(), 6 * sqr(0.5) + 2 * sqr(1.5), 1e-9);
}

}  // namespace
}  // namespace fogbow
