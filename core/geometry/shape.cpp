// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/shape.h"

namespace fogbow {

bool Shape::avoids(std::uint32_t primitive, const Bounds& box) const {
  if (!primitive_bounds(primitive).overlaps(box)) return true;
  if (!polygonal()) return false;
  const SurfacePoint x = surface_point(primitive, Vec2(0.25));
  int in_front = 0;
  for (const Vec3& corner : box.corners()) in_front += dot(corner - x.position, x.n_g) > 0;
  return in_front == 0 || in_front == 8;
}

}  // namespace fogbow
