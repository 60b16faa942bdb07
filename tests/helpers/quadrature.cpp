// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/quadrature.h"

#include <algorithm>
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace fogbow::testing {

QuadratureRule gauss_legendre(int n, double a, double b) {
  QuadratureRule rule{std::vector<double>(n), std::vector<double>(n)};
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), derivative = 0;
    for (int iteration = 0; iteration < 100; ++iteration) {
      double p = 1, previous = 0;
      for (int l = 1; l <= n; ++l) {
        const double next = ((2 * l - 1) * x * p - (l - 1) * previous) / l;
        previous = p;
        p = next;
      }
      derivative = n * (x * p - previous) / (x * x - 1);
      const double step = p / derivative;
      x -= step;
      if (std::abs(step) < 1e-15) break;
    }
    rule.nodes[n - 1 - i] = a + (b - a) * (1 + x) / 2;
    rule.weights[n - 1 - i] = (b - a) / ((1 - x * x) * derivative * derivative);
  }
  return rule;
}

double integrate(const std::function<double(double)>& f, double a, double b, double tolerance) {
  double error = 0, magnitude = 0;
  const double value = boost::math::quadrature::gauss_kronrod<double, 31>::integrate(
      f, a, b, 15, tolerance, &error, &magnitude);
  const double rounding = 1000 * std::numeric_limits<double>::epsilon();
  if (!(error <= std::max(tolerance, rounding) * magnitude))
    throw std::runtime_error("quadrature did not converge");
  return value;
}

std::vector<double> find_roots(const std::function<double(double)>& f, double a, double b,
                               int steps) {
  std::vector<double> roots;
  double lo = a, f_lo = f(a);
  for (int i = 1; i <= steps; ++i) {
    const double hi = a + (b - a) * i / steps, f_hi = f(hi);
    if ((f_lo < 0) != (f_hi < 0)) {
      double l = lo, r = hi;
      for (int bisection = 0; bisection < 100 && l < r; ++bisection) {
        const double m = l + (r - l) / 2;
        ((f(m) < 0) == (f_lo < 0) ? l : r) = m;
      }
      roots.push_back(l + (r - l) / 2);
    }
    lo = hi;
    f_lo = f_hi;
  }
  return roots;
}

std::vector<double> ChebyshevInterpolant::nodes(int n, double a, double b) {
  std::vector<double> x;
  for (int i = 0; i < n; ++i)
    x.push_back(a + (b - a) * (1 - std::cos(std::numbers::pi * (i + 0.5) / n)) / 2);
  return x;
}

ChebyshevInterpolant::ChebyshevInterpolant(double a, double b, std::vector<double> values)
    : nodes_(nodes(static_cast<int>(values.size()), a, b)), values_(std::move(values)) {}

double ChebyshevInterpolant::operator()(double x) const {
  // barycentric formula with weights (−1)^i sin((i + ½)π/n)
  double numerator = 0, denominator = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (x == nodes_[i]) return values_[i];
    const double weight = (i % 2 ? -1 : 1) * std::sin(std::numbers::pi * (i + 0.5) / nodes_.size());
    numerator += weight * values_[i] / (x - nodes_[i]);
    denominator += weight / (x - nodes_[i]);
  }
  return numerator / denominator;
}

}  // namespace fogbow::testing
