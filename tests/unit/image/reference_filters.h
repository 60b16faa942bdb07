// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/image/filter.h"

namespace fogbow::testing {

/// A filter beside its definition up to a factor, written down a second time: hdrfilm's box, tent
/// and gaussian.
struct FilterCase {
  std::string name;
  std::shared_ptr<const ReconstructionFilter> filter;
  double radius;
  std::function<double(double)> shape;
};

inline std::vector<FilterCase> filter_cases() {
  const auto box = [](double r) { return [r](double x) { return std::abs(x) < r ? 1.0 : 0.0; }; };
  const auto tent = [](double r) {
    return [r](double x) { return std::max(0.0, r - std::abs(x)); };
  };
  const auto gaussian = [](double s) {
    return [s](double x) { return std::max(0.0, std::exp(-x * x / (2 * s * s)) - std::exp(-8.0)); };
  };
  return {{"box 0.5", make_box_filter(), 0.5, box(0.5)},
          {"box 1.3", make_box_filter(1.3), 1.3, box(1.3)},
          {"tent 1", make_tent_filter(), 1, tent(1)},
          {"tent 1.7", make_tent_filter(1.7), 1.7, tent(1.7)},
          {"gaussian 0.5", make_gaussian_filter(), 2, gaussian(0.5)},
          {"gaussian 0.3", make_gaussian_filter(0.3), 1.2, gaussian(0.3)}};
}

/// Midpoint rule.
inline double quadrature(const std::function<double(double)>& f, double a, double b, int steps) {
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(a + (b - a) * (i + 0.5) / steps);
  return sum * (b - a) / steps;
}

}  // namespace fogbow::testing
