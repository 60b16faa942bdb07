// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>

#include "core/geometry/accel.h"

/// Ray queries decided in double precision, whatever it is that proposes candidates.
namespace fogbow::detail {

/// Primitives whose neighbours are to be tried, and where that was done. More than these occur only
/// where geometry is finer than single precision.
struct Doubtful {
  std::size_t count = 0, places = 0;
  std::array<PrimitiveId, 64> primitives;
  std::array<Vec3, 64> centers;

  void add(PrimitiveId id) {
    const auto end = primitives.begin() + count;
    if (count < primitives.size() && std::find(primitives.begin(), end, id) == end)
      primitives[count++] = id;
  }
  /// False if another place within `radius` was added before.
  bool add_place(const Vec3& center, double radius) {
    for (std::size_t i = 0; i < places; ++i)
      if (length(centers[i] - center) < radius) return false;
    if (places == centers.size()) return false;
    centers[places++] = center;
    return true;
  }
};

struct Decision {
  const Shape* const* shapes;
  const Ray* ray;
  PrimitiveId from, to;
  bool from_missed, to_missed;   ///< this planar end was not found well within its edges
  std::uint32_t doubts = 0;      ///< how many candidates were rejected at their edges;
  Doubtful* doubtful = nullptr;  ///< where they are to be listed
  Hit best{kInfinity, kNoPrimitive, Vec2(0)};  ///< nearest of those accepted

  bool uncertain() const { return doubts > 0 || from_missed || to_missed; }

  std::optional<PrimitiveHit> decide(PrimitiveId id) {
    const Shape& shape = *shapes[id.shape];
    if (id == to && id != from) {
      // The end point is a root that only the ray leaving it can exclude exactly.
      const Ray back{(*ray)(ray->t_max), -ray->d, 0, ray->t_max - ray->t_min};
      return shape.intersect(id.primitive, back, true);
    }
    auto hit = shape.intersect(id.primitive, *ray, id == from);
    if (!hit && shape.polygonal()) {
      const Ray line{ray->o, ray->d, -kInfinity, kInfinity};
      if (!shape.intersect(id.primitive, line, false)) {
        ++doubts;
        if (doubtful) doubtful->add(id);
      }
    }
    return hit;
  }

  /// decide(), and keep the nearest.
  bool accept(PrimitiveId id) {
    const auto hit = decide(id);
    if (hit && hit->t < best.t) best = {hit->t, id, hit->local};
    return hit.has_value();
  }
};

struct Ball {
  Vec3 center;
  double radius;
};

/// Where a ray passes within `reach` of the edge from a to a + edge.
inline std::optional<Ball> passage(const Ray& ray, const Vec3& a, const Vec3& edge, double reach) {
  const Vec3 across = edge - dot(edge, ray.d) * ray.d;
  const Vec3 r = a - ray.o, aside = r - dot(r, ray.d) * ray.d;
  if (length(across) < 2 * reach) {  // perhaps along all of it
    if (!(length(aside) < 3 * reach)) return std::nullopt;
    return Ball{a + 0.5 * edge, 0.5 * length(edge) + reach};
  }
  const double s = std::clamp(-dot(aside, across) / length_squared(across), 0.0, 1.0);
  if (!(length(aside + s * across) < reach)) return std::nullopt;
  return Ball{a + s * edge, 1.5 * reach};
}

}  // namespace fogbow::detail
