// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

namespace fogbow::testing {

struct QuadratureRule {
  std::vector<double> nodes, weights;
};

/// n-point Gauss–Legendre rule on [a, b], exact for polynomials of degree 2n − 1.
QuadratureRule gauss_legendre(int n, double a, double b);

/// Adaptive Gauss–Kronrod; throws std::runtime_error where the error estimate stays above
/// `tolerance` relative to ∫|f|. b may be infinite.
double integrate(const std::function<double(double)>& f, double a, double b,
                 double tolerance = 1e-11);

/// All roots of f in [a, b] that a scan of `steps` equal cells separates, to rounding.
std::vector<double> find_roots(const std::function<double(double)>& f, double a, double b,
                               int steps);

/// Polynomial through n Chebyshev points of [a, b]; for a smooth function n = 16 is close to
/// rounding.
class ChebyshevInterpolant {
 public:
  static std::vector<double> nodes(int n, double a, double b);
  /// `values` at nodes(values.size(), a, b).
  ChebyshevInterpolant(double a, double b, std::vector<double> values);
  double operator()(double x) const;

 private:
  std::vector<double> nodes_, values_;
};

}  // namespace fogbow::testing
