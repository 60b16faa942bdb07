// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <numbers>

#include "core/math/vec.h"

namespace fogbow {

/// Spread over the unit square: a shifted grid and van der Corput's sequence. The golden ratio
/// keeps points off edges between faces of commensurable areas, where rays to them would meet
/// either face.
inline Vec2 spread_point(int i, int n) {
  constexpr double kShift = 2 - std::numbers::phi;
  double y = 0, place = 0.5;
  for (int rest = i; rest > 0; rest /= 2, place /= 2) y += place * (rest % 2);
  return {(i + kShift) / n, y + kShift / n};
}

inline Vec3 spread_direction(int i, int n) {
  const Vec2 u = spread_point(i, n);
  const double z = 1 - 2 * u.x, r = std::sqrt(1 - z * z);
  return {r * std::cos(2 * kPi * u.y), r * std::sin(2 * kPi * u.y), z};
}

}  // namespace fogbow
