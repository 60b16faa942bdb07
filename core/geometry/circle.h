// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <cstdint>

#include "core/math/vec.h"

/// The polygon that stands for a circle in the tessellations of disks and cylinders: one and the
/// same, so that disks cap cylinders.
namespace fogbow::detail {

inline constexpr std::uint32_t kCircleSegments = 64;

inline Vec2 on_circle(std::uint32_t corner) {
  const double phi = 2 * kPi * (corner % kCircleSegments) / kCircleSegments;
  return {std::cos(phi), std::sin(phi)};
}

/// Two directions across an axis, the same for the axis and its opposite, and, but for rounding,
/// for axes that differ by rounding: the vectors that decide lie along no axis that scenes have.
inline std::array<Vec3, 2> across_axis(const Vec3& axis) {
  const Vec3 up(0.5413, 0.7071, 0.4561), aside(-0.2718, 0.5772, -0.7701);
  const Vec3 n = dot(axis, up) < 0 ? -axis : axis;
  const Vec3 s = normalize(cross(n, aside));
  return {s, cross(n, s)};
}

}  // namespace fogbow::detail
