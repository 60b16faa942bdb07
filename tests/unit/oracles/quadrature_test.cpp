// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/quadrature.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace fogbow::testing {
namespace {

TEST(Quadrature, GaussIsExactForPolynomials) {
  for (const int n : {1, 2, 7, 40}) {
    const QuadratureRule rule = gauss_legendre(n, -1, 3);
    for (int degree = 0; degree <= std::min(2 * n - 1, 20); ++degree) {
      double sum = 0;
      for (int i = 0; i < n; ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
      const double exact = (std::pow(3.0, degree + 1) - std::pow(-1.0, degree + 1)) / (degree + 1);
      EXPECT_NEAR(sum, exact, 1e-13 * std::pow(3.0, degree + 1)) << n << ' ' << degree;
    }
  }
  const QuadratureRule two = gauss_legendre(2, -1, 1);
  EXPECT_NEAR(two.nodes[1], 1 / std::sqrt(3.0), 1e-15);
  EXPECT_GT(std::abs(two.weights[0] * std::pow(two.nodes[0], 4) * 2 - 0.4), 0.1);  // degree 2n: not
}

TEST(Quadrature, AdaptiveReachesItsToleranceOrThrows) {
  EXPECT_NEAR(
      integrate([](double x) { return std::exp(-x); }, 0, std::numeric_limits<double>::infinity()),
      1.0, 1e-11);
  EXPECT_NEAR(integrate([](double x) { return 1 / (1e-6 + x * x); }, -1, 1), 2e3 * std::atan(1e3),
              1e-7);
  EXPECT_THROW(integrate([](double x) { return 1 / (x * x); }, 0, 1), std::exception);
}

TEST(Quadrature, RootsOfACosine) {
  const std::vector<double> roots = find_roots([](double x) { return std::cos(x); }, 0, 10, 50);
  ASSERT_EQ(roots.size(), 3u);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(roots[k], (k + 0.5) * std::acos(-1.0), 1e-14);
}

TEST(Quadrature, ChebyshevInterpolatesSmoothFunctions) {
  std::vector<double> values;
  for (const double x : ChebyshevInterpolant::nodes(16, 0.5, 1)) values.push_back(std::exp(-2 / x));
  const ChebyshevInterpolant f(0.5, 1, values);
  for (const double x : {0.5, 0.61, 0.87, 1.0}) EXPECT_NEAR(f(x), std::exp(-2 / x), 1e-12);
}

}  // namespace
}  // namespace fogbow::testing
