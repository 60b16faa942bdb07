// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/shape.h"

namespace fogbow {

std::array<Vec3, 2> Shape::uv_tangents(const SurfacePoint& x) const {
  const SurfaceDerivatives d = derivatives(x);
  const auto [a, b] = uv_derivatives(x);
  const double det = a.x * b.y - a.y * b.x;
  if (!(std::abs(det) > 0) || !std::isfinite(det)) return {d.dp_du, d.dp_dv};
  return {(b.y * d.dp_du - a.y * d.dp_dv) / det, (a.x * d.dp_dv - b.x * d.dp_du) / det};
}

Vec2 u_axis(const SurfacePoint& x) {
  if (!x.shape) return {1, 0};
  const Vec3 u = x.shading.to_local(x.shape->uv_tangents(x)[0]);
  const double length_u = std::hypot(u.x, u.y);
  if (!(length_u > 0) || !std::isfinite(length_u)) return {1, 0};
  return Vec2(u.x, u.y) / length_u;
}

bool Shape::avoids(std::uint32_t primitive, const Bounds& box) const {
  if (!primitive_bounds(primitive).overlaps(box)) return true;
  if (!polygonal()) return false;
  const SurfacePoint x = surface_point(primitive, Vec2(0.25));
  int in_front = 0;
  for (const Vec3& corner : box.corners()) in_front += dot(corner - x.position, x.n_g) > 0;
  return in_front == 0 || in_front == 8;
}

const MeshAttribute* Shape::find_attribute(const std::string& name) const {
  for (const MeshAttribute& a : attributes())
    if (a.name == name) return &a;
  return nullptr;
}

}  // namespace fogbow
