// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/helpers/statistics.h"

namespace fogbow::testing {
namespace {

// Values of tables in any handbook of statistics.
TEST(Statistics, PValues) {
  EXPECT_NEAR(p_value_normal(1.959963985), 0.05, 1e-9);
  EXPECT_NEAR(p_value_student(2.306004135, 8), 0.05, 1e-8);
  EXPECT_NEAR(p_value_student(-2.306004135, 8), 0.05, 1e-8);
  EXPECT_NEAR(p_value_chi2(18.30703805, 10), 0.05, 1e-8);
  EXPECT_EQ(p_value_normal(std::nan("")), 0);
  EXPECT_NEAR(sidak(0.05, 10), 0.0051161969, 1e-9);
  EXPECT_NEAR(sidak(1e-5, 1000), 1e-8, 1e-12);
}

TEST(Statistics, ChiSquared) {
  const std::vector<std::uint64_t> observed{16, 18, 16, 14, 12, 12};
  const std::vector<double> expected{16, 16, 16, 16, 8, 16};  // χ² = 0.25 + 0.25 + 2 + 1
  EXPECT_NEAR(chi2_test(observed, expected), p_value_chi2(3.5, 5), 1e-12);
  // Thin cells are pooled: 2 + 3 expected make one.
  EXPECT_NEAR(chi2_test(std::vector<std::uint64_t>{3, 4, 20}, std::vector<double>{2, 3, 22}),
              p_value_chi2(4.0 / 5 + 4.0 / 22, 1), 1e-12);
  EXPECT_EQ(chi2_test(std::vector<std::uint64_t>{1}, std::vector<double>{0}), 0);
}

/// p-values of true hypotheses are uniform: each test is put to itself.
TEST(Statistics, PValuesOfTrueHypothesesAreUniform) {
  std::mt19937_64 engine(suite_seed());
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  std::vector<double> ks, two, t, cells;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> u(400), a(6), b(9);
    for (double& x : u) x = uniform(engine);
    for (double& x : a) x = 3 + normal(engine);
    for (double& x : b) x = 3 + 2 * normal(engine);
    std::vector<std::uint64_t> counts(20, 0);
    for (const double x : u) ++counts[static_cast<std::size_t>(x * 20)];
    ks.push_back(uniform_ks_test(u));
    two.push_back(two_sample_ks_test({u.begin(), u.begin() + u.size() / 3},
                                     {u.begin() + u.size() / 3, u.end()}));
    t.push_back(compare(estimate(a), 3));
    cells.push_back(chi2_test(counts, std::vector<double>(20, 20.0)));
  }
  for (const auto& p : {ks, two, t, cells}) {
    EXPECT_GT(uniform_ks_test(p), sidak(kSuiteFalseAlarm, 4) * 0.1);
  }
}

TEST(Statistics, KolmogorovSmirnov) {
  std::vector<double> exact(1000), shifted(1000);
  for (int i = 0; i < 1000; ++i) {
    exact[i] = (i + 0.5) / 1000;
    shifted[i] = exact[i] * 0.9;
  }
  EXPECT_GT(uniform_ks_test(exact), 0.999);
  EXPECT_LT(uniform_ks_test(shifted), 1e-7);
  // D = 0.1, n = 1000: 2 exp(−2 λ²) with λ = (√n + 0.12 + 0.11/√n) D.
  const double lambda = (std::sqrt(1000.0) + 0.12 + 0.11 / std::sqrt(1000.0)) * 0.1005;
  EXPECT_NEAR(std::log(uniform_ks_test(shifted)), std::log(2 * std::exp(-2 * lambda * lambda)),
              0.05);
  exact[0] = 1.5;
  EXPECT_EQ(uniform_ks_test(exact), 0) << "outside of the unit interval";
}

TEST(Statistics, KolmogorovSmirnovOfTwoSamples) {
  // D = 3/4 − 1/6 at x = 2, of 4 and 6 values.
  const double root = std::sqrt(2.4), lambda = (root + 0.12 + 0.11 / root) * 7 / 12;
  double tail = 0;
  for (int k = 1; k < 50; ++k)
    tail += 2 * (k % 2 ? 1 : -1) * std::exp(-2.0 * k * k * lambda * lambda);
  EXPECT_NEAR(two_sample_ks_test({2, 1, 2, 5}, {5, 2, 3, 6, 4, 7}), tail, 1e-12);
  const std::vector<double> same(100, 0.5);
  EXPECT_GT(two_sample_ks_test(same, same), 0.999) << "ties are no difference";
  EXPECT_LT(two_sample_ks_test(same, std::vector<double>(100, 0.6)), 1e-20);
}

TEST(Statistics, WelchAndPower) {
  const std::vector<double> a{27.5, 21.0, 19.0, 23.6, 17.0, 17.9, 16.9, 20.1,
                              21.9, 22.6, 23.1, 19.6, 19.0, 21.7, 21.4};
  const std::vector<double> b{27.1, 22.0, 20.8, 23.4, 23.4, 23.5, 25.8, 22.0,
                              24.8, 20.2, 21.9, 22.1, 22.9, 30.5, 24.0};
  // Welch's t on this textbook pair: t = −2.8, ν = 27.9, p = 0.009.
  EXPECT_NEAR(welch(estimate(a), estimate(b)), 0.009, 0.001);
  EXPECT_EQ(welch({1, 0, 5}, {1, 0, 5}), 1);
  EXPECT_EQ(welch({1, 0, 5}, {2, 0, 5}), 0);

  // Normal limit: at level 5%, a bias of z₀.₉₇₅ + z₀.₉₀ standard errors is seen with 90%.
  const Estimate many{0, 1 / std::sqrt(2.0), 1e9};
  EXPECT_NEAR(power(many, many, 1.959963985 + 1.281551566, 0.05), 0.9, 1e-6);
  EXPECT_NEAR(power(many, many, 0, 0.05), 0.05, 1e-9);
  // Few groups see less; without bias the power is the level.
  const Estimate few{0, 1 / std::sqrt(2.0), 4};
  EXPECT_NEAR(power(few, few, 0, 0.01), 0.01, 1e-6);
  EXPECT_LT(power(few, few, 4, 0.01), power(many, many, 4, 0.01));
  EXPECT_NEAR(power(few, few, 1e9, 1e-6), 1, 1e-9);
}

/// The stated power is the rate at which the test fires.
TEST(Statistics, PowerIsTheRateOfDetection) {
  std::mt19937_64 engine(suite_seed());
  std::normal_distribution<double> normal;
  constexpr int kTrials = 20000;
  constexpr double kLevel = 0.01, kBias = 2.5;
  int detected = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> a(8), b(8);
    for (double& x : a) x = normal(engine) + kBias;
    for (double& x : b) x = normal(engine);
    detected += welch(estimate(a), estimate(b)) < kLevel;
  }
  const Estimate known{0, 1 / std::sqrt(8.0), 7};
  const double stated = power(known, known, kBias, kLevel);
  const double error = std::sqrt(stated * (1 - stated) / kTrials);
  // Welch's degrees of freedom vary from draw to draw, which the formula leaves out.
  EXPECT_NEAR(detected / static_cast<double>(kTrials), stated, 5 * error + 0.01);
}

}  // namespace
}  // namespace fogbow::testing
