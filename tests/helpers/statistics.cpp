// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/statistics.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <random>
#include <stdexcept>

namespace fogbow::testing {
namespace {

/// Beyond this many degrees of freedom Student's t is a normal law to within 1e-6 in any tail used
/// here.
constexpr double kManyDegreesOfFreedom = 1e6;

double welch_standard_error(const Estimate& a, const Estimate& b) {
  return std::hypot(a.standard_error, b.standard_error);
}

/// Welch and Satterthwaite; an exact value has no share in it.
double welch_degrees_of_freedom(const Estimate& a, const Estimate& b) {
  const double va = a.standard_error * a.standard_error, vb = b.standard_error * b.standard_error;
  const double ca = va > 0 ? va * va / a.degrees_of_freedom : 0;
  const double cb = vb > 0 ? vb * vb / b.degrees_of_freedom : 0;
  return (va + vb) * (va + vb) / (ca + cb);
}

/// p-value of a difference with its standard error; with none at all, equality is what is asked.
double p_value_difference(double difference, double standard_error, double degrees_of_freedom) {
  if (!std::isfinite(difference) || !std::isfinite(standard_error)) return 0;
  if (standard_error == 0) return difference == 0 ? 1 : 0;
  return p_value_student(difference / standard_error, degrees_of_freedom);
}

/// P(K > lambda) of Kolmogorov's law, by whichever theta series converges fast.
double kolmogorov_tail(double lambda) {
  constexpr double pi = 3.14159265358979323846;
  if (lambda <= 0) return 1;
  double sum = 0;
  if (lambda < 1) {
    for (int k = 1; k <= 20; ++k) {
      const double a = (2 * k - 1) * pi / lambda;
      sum += std::exp(-a * a / 8);
    }
    return 1 - std::sqrt(2 * pi) / lambda * sum;
  }
  for (int k = 20; k >= 1; --k) sum += (k % 2 ? 2 : -2) * std::exp(-2.0 * k * k * lambda * lambda);
  return sum;
}

}  // namespace

double sidak(double alpha, int comparisons) {
  return -std::expm1(std::log1p(-alpha) / comparisons);
}

double p_value_normal(double z) {
  if (std::isnan(z)) return 0;
  return std::erfc(std::fabs(z) / std::sqrt(2.0));
}

double p_value_student(double t, double degrees_of_freedom) {
  if (std::isnan(t) || !(degrees_of_freedom > 0)) return 0;
  if (degrees_of_freedom > kManyDegreesOfFreedom || std::isinf(t)) return p_value_normal(t);
  const boost::math::students_t law(degrees_of_freedom);
  return 2 * boost::math::cdf(boost::math::complement(law, std::fabs(t)));
}

double p_value_chi2(double x, double degrees_of_freedom) {
  if (std::isnan(x) || std::isinf(x)) return 0;
  const boost::math::chi_squared law(degrees_of_freedom);
  return boost::math::cdf(boost::math::complement(law, x));
}

double chi2_test(std::span<const std::uint64_t> observed, std::span<const double> expected) {
  if (observed.size() != expected.size()) throw std::invalid_argument("chi2_test: sizes differ");
  constexpr double kLeastExpected = 5;
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t i, std::size_t j) { return expected[i] < expected[j]; });

  double chi2 = 0, pooled_observed = 0, pooled_expected = 0;
  int cells = 0;
  const auto close_cell = [&] {
    const double d = pooled_observed - pooled_expected;
    chi2 += d == 0 ? 0 : d * d / pooled_expected;
    ++cells;
    pooled_observed = pooled_expected = 0;
  };
  for (const std::size_t i : order) {
    if (!(expected[i] >= 0)) return 0;
    pooled_observed += static_cast<double>(observed[i]);
    pooled_expected += expected[i];
    if (pooled_expected >= kLeastExpected) close_cell();
  }
  if (pooled_observed > 0 || pooled_expected > 0) close_cell();
  return cells < 2 ? (chi2 < kLeastExpected ? 1 : 0) : p_value_chi2(chi2, cells - 1);
}

double uniform_ks_test(std::vector<double> samples) {
  if (samples.empty()) throw std::invalid_argument("uniform_ks_test: no samples");
  for (const double x : samples)
    if (!(x >= 0 && x <= 1)) return 0;
  std::sort(samples.begin(), samples.end());
  const double n = static_cast<double>(samples.size());
  double distance = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double rank = static_cast<double>(i);
    distance = std::max({distance, (rank + 1) / n - samples[i], samples[i] - rank / n});
  }
  // Finite-sample correction of Stephens 1970.
  return kolmogorov_tail((std::sqrt(n) + 0.12 + 0.11 / std::sqrt(n)) * distance);
}

double two_sample_ks_test(std::vector<double> a, std::vector<double> b) {
  if (a.empty() || b.empty()) throw std::invalid_argument("two_sample_ks_test: no samples");
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const double n = static_cast<double>(a.size()), m = static_cast<double>(b.size());
  double distance = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double x = std::min(a[i], b[j]);  // ties move both
    while (i < a.size() && a[i] == x) ++i;
    while (j < b.size() && b[j] == x) ++j;
    distance =
        std::max(distance, std::fabs(static_cast<double>(i) / n - static_cast<double>(j) / m));
  }
  const double root = std::sqrt(n * m / (n + m));
  return kolmogorov_tail((root + 0.12 + 0.11 / root) * distance);
}

Estimate estimate(std::span<const double> replicates) {
  if (replicates.size() < 2) throw std::invalid_argument("estimate: needs two replicates");
  const double n = static_cast<double>(replicates.size());
  const double mean = std::accumulate(replicates.begin(), replicates.end(), 0.0) / n;
  double squares = 0;
  for (const double x : replicates) squares += (x - mean) * (x - mean);
  return {mean, std::sqrt(squares / (n - 1) / n), n - 1};
}

double welch(const Estimate& a, const Estimate& b) {
  return p_value_difference(a.mean - b.mean, welch_standard_error(a, b),
                            welch_degrees_of_freedom(a, b));
}

double compare(const Estimate& a, double value) {
  return p_value_difference(a.mean - value, a.standard_error, a.degrees_of_freedom);
}

double power(const Estimate& a, const Estimate& b, double bias, double level) {
  const double standard_error = welch_standard_error(a, b);
  if (standard_error == 0) return bias != 0 ? 1 : level;
  const double dof = welch_degrees_of_freedom(a, b);
  const double shift = std::fabs(bias) / standard_error;
  const boost::math::normal normal;
  if (dof > kManyDegreesOfFreedom) {
    const double critical = boost::math::quantile(boost::math::complement(normal, level / 2));
    return boost::math::cdf(normal, shift - critical) + boost::math::cdf(normal, -shift - critical);
  }
  const double critical =
      boost::math::quantile(boost::math::complement(boost::math::students_t(dof), level / 2));
  constexpr double kLargeShift =
      1e3;  // here only the spread of the estimated error is left, to 0.1%
  if (shift > kLargeShift)
    return boost::math::cdf(boost::math::chi_squared(dof),
                            dof * std::min((shift / critical) * (shift / critical), 1e30));
  const boost::math::non_central_t law(dof, shift);
  return boost::math::cdf(boost::math::complement(law, critical)) +
         boost::math::cdf(law, -critical);
}

double samples_needed(const Estimate& e, double bias, double level, double wanted) {
  constexpr double kStep = 1.25, kMost = 1e9;
  if (!(bias > 0)) return 0;
  double factor = 1;
  Estimate more = e;
  while (power(more, more, bias, level) < wanted && factor < kMost) {
    factor *= kStep;
    more.standard_error = e.standard_error / std::sqrt(factor);
  }
  return factor;
}

std::uint64_t suite_seed() {
  static const std::uint64_t seed = [] {
    std::uint64_t value = 20130807;
    if (const char* fresh = std::getenv("FOGBOW_FRESH_SEED"); fresh != nullptr && *fresh != '\0') {
      char* end = nullptr;
      value = std::strtoull(fresh, &end, 0);
      std::random_device device;
      if (*end != '\0') value = std::uint64_t{device()} << 32 | std::uint64_t{device()};
    }
    std::printf("suite seed %llu\n", static_cast<unsigned long long>(value));
    return value;
  }();
  return seed;
}

}  // namespace fogbow::testing
