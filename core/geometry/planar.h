// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <optional>

#include "core/geometry/shape.h"

/// What the flat primitives (triangles, parallelograms) and the sphere share in deciding hits.
namespace fogbow::detail {

/// Roundings that may stand between a computed point and the primitive it lies on, times the unit
/// roundoff: three for its evaluation, as many for the intersection, with a factor to spare.
inline constexpr double kRounding = 32 * 0x1p-53;

inline double max_abs(const Vec3& v) { return max_component(glm::abs(v)); }

enum class Outline { Triangle, Parallelogram };

/// How far barycentrics lie outside, ≤ 0 inside. NaN stays NaN.
template <Outline outline>
double excess(const Vec2& b) {
  const double below = -std::min(b.x, b.y);
  if constexpr (outline == Outline::Triangle) return std::max(below, b.x + b.y - 1);
  return std::max(below, std::max(b.x, b.y) - 1);
}

/// Hit of the primitive p + u e1 + v e2 (Möller and Trumbore 1997). What rounding cannot tell from
/// an end of the ray is not a hit, so neither neighbours in one plane nor touching primitives
/// shadow themselves; what rounding cannot tell from the inside is inside, so edges do not leak.
template <Outline outline>
std::optional<PrimitiveHit> intersect_planar(const Vec3& p, const Vec3& e1, const Vec3& e2,
                                             const Ray& ray) {
  const Vec3 across = cross(ray.d, e2);
  const double det = dot(e1, across);
  const Vec3 s = ray.o - p;
  const Vec3 q = cross(s, e1);
  const Vec2 local = Vec2(dot(s, across), dot(ray.d, q)) / det;
  const double t = dot(e2, q) / det;
  if (!std::isfinite(t) || !std::isfinite(local.x) || !std::isfinite(local.y)) return std::nullopt;

  const double scale = max_abs(ray.o) + 2 * max_abs(s) + std::fabs(t);
  const double unit = kRounding * scale / std::fabs(det);
  const double outside = excess<outline>(local);
  if (outside > 0 && outside > unit * (length(e1) + length(e2))) return std::nullopt;

  // The bound with |e1||e2| for |e1 × e2| nearly always decides, and costs no cross product.
  const double to_end = std::min(t - ray.t_min, ray.t_max - t);
  const double edges = std::sqrt(length_squared(e1) * length_squared(e2));
  if (to_end > unit * edges) return PrimitiveHit{t, local};
  const double error =
      unit * length(cross(e1, e2)) + kRounding * max_abs(s) * edges / std::fabs(det);
  if (!(to_end > error)) return std::nullopt;
  return PrimitiveHit{t, local};
}

}  // namespace fogbow::detail
