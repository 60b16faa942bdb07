// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <limits>
#include <numbers>

namespace fogbow {

using Vec2 = glm::dvec2;
using Vec3 = glm::dvec3;
using Vec4 = glm::dvec4;
using Mat3 = glm::dmat3;
using Mat4 = glm::dmat4;

/// Linear Rec. 709 radiance, reflectance or coefficient triple.
using RGB = glm::dvec3;

using glm::cross;
using glm::dot;
using glm::length;
using glm::normalize;

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kInvPi = std::numbers::inv_pi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Largest double below one: primary samples live in [0, 1).
inline constexpr double kOneMinusEpsilon = 0x1.fffffffffffffp-1;

inline double sqr(double x) { return x * x; }
inline double length_squared(const Vec3& v) { return dot(v, v); }
inline double max_component(const Vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline double mean(const RGB& c) { return (c.x + c.y + c.z) / 3; }
inline bool is_black(const RGB& c) { return c.x == 0 && c.y == 0 && c.z == 0; }
inline bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Relative luminance of linear Rec. 709 primaries (Mitsuba's weights).
inline double luminance(const RGB& c) { return 0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z; }

}  // namespace fogbow
