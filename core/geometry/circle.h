// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
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

}  // namespace fogbow::detail
