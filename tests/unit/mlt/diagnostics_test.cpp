// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/diagnostics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/util/rng.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

constexpr int kChains = 400, kSteps = 4000;

/// Chains over {0, 1}, fair in the long run, that stay where they are with probability `stay`.
/// The autocorrelation at lag n is (2 stay − 1)^n.
Convergence of_two_states(double stay) {
  std::vector<ChainMoments> moments(kChains);
  for (int i = 0; i < kChains; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, i, 17);
    bool x = rng.uniform() < 0.5;
    for (int n = 0; n < kSteps; ++n) {
      moments[i].sum += x;
      moments[i].squares += x;
      if (rng.uniform() >= stay) x = !x;
    }
  }
  return convergence(moments, std::vector<double>(kChains, kSteps));
}

/// The spread of a variance from kChains normal means.
constexpr double kRelativeError = 0.0708;  // √(2/(kChains − 1))
constexpr double kErrors = 4.9;            // two-sided 1e-6

TEST(Diagnostics, EffectiveSamplesFollowTheAutocorrelation) {
  for (const double stay : {0.5, 0.8, 0.95}) {
    const double rho = 2 * stay - 1;
    const double expected = kChains * kSteps * (1 - rho) / (1 + rho);
    EXPECT_NEAR(of_two_states(stay).effective_samples / expected, 1, kErrors * kRelativeError);
  }
}

TEST(Diagnostics, ScaleReductionIsOneForMixedChainsAndLargeForStuckOnes) {
  EXPECT_NEAR(of_two_states(0.5).r_hat, 1, 0.001);
  // Correlation length about the length of the run: R̂² − 1 = Var(mean of a chain) / the rest.
  const double rho = 1 - 2.0 / kSteps;
  double variance_of_mean = 0;  // in units of the stationary variance
  for (int lag = 0; lag < kSteps; ++lag)
    variance_of_mean +=
        (lag == 0 ? 1.0 : 2.0) * (1 - double(lag) / kSteps) * std::pow(rho, lag) / kSteps;
  const double r_hat = std::sqrt(1 / (1 - variance_of_mean));
  EXPECT_NEAR(of_two_states(1 - 1.0 / kSteps).r_hat / r_hat, 1, 0.15);
  EXPECT_GT(r_hat, 1.3);
  EXPECT_TRUE(std::isinf(of_two_states(1).r_hat));
}

/// Two chains of ten steps with means 0 and 2, each with a variance of 1: the means have a variance
/// of 2, hence R̂² = (1 + 2)/1, and both are worth 2 · 3/2 samples.
TEST(Diagnostics, FewChainsAreNoBetterThanTheyAre) {
  const std::vector<ChainMoments> moments{{0, 10}, {20, 50}};
  const Convergence c = convergence(moments, std::vector<double>(2, 10));
  EXPECT_DOUBLE_EQ(c.r_hat, std::sqrt(3));
  EXPECT_DOUBLE_EQ(c.effective_samples, 3);
}

TEST(Diagnostics, AConstantIsConverged) {
  const std::vector<ChainMoments> moments(4, ChainMoments{5, 2.5});
  const Convergence c = convergence(moments, std::vector<double>(4, 10));
  EXPECT_EQ(c.r_hat, 1);
  EXPECT_EQ(c.effective_samples, 40);
}

}  // namespace
}  // namespace fogbow
