// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fogbow::testing {

/// The false-alarm rate of a whole suite of comparisons.
inline constexpr double kSuiteFalseAlarm = 1e-5;

/// 1 − (1 − alpha)^(1/n): the level of each of n comparisons (Šidák 1967).
double sidak(double alpha, int comparisons);

/// Two-sided p-value of a standard normal, and of Student's t.
double p_value_normal(double z);
double p_value_student(double t, double degrees_of_freedom);
/// P(χ²_dof ≥ x).
double p_value_chi2(double x, double degrees_of_freedom);

/// Pearson's χ² of counts against expected counts; cells expected below 5 are pooled. Returns the
/// p-value.
double chi2_test(std::span<const std::uint64_t> observed, std::span<const double> expected);
/// Kolmogorov–Smirnov p-value of samples against the uniform law on [0, 1].
double uniform_ks_test(std::vector<double> samples);
/// Of two samples against each other.
double two_sample_ks_test(std::vector<double> a, std::vector<double> b);

/// Mean and standard error of independent replicates.
struct Estimate {
  double mean = 0, standard_error = 0;
  double degrees_of_freedom = 0;
};
Estimate estimate(std::span<const double> replicates);

/// Welch's t-test of two estimates; p-value.
double welch(const Estimate& a, const Estimate& b);
/// Of an estimate against a known value; p-value.
double compare(const Estimate& a, double value);
/// Probability that a two-sided test at `level` detects a true difference of `bias`, given both
/// standard errors and Welch's degrees of freedom.
double power(const Estimate& a, const Estimate& b, double bias, double level);

/// How many times as many samples as `e` has are needed for a difference of `bias` to be detected
/// with probability `wanted`, the other side of the comparison being as uncertain.
double samples_needed(const Estimate& e, double bias, double level, double wanted);

/// The seed of a suite: fixed, or from FOGBOW_FRESH_SEED in the environment (a number; anything
/// else draws one). Printed when first asked for.
std::uint64_t suite_seed();

}  // namespace fogbow::testing
