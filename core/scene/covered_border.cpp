// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/covered_border.h"

#include <algorithm>

#include "core/scene/contact.h"

namespace fogbow {

namespace {

// In parts of the scene's size.
/// How far a border may end before the wall: files round coordinates.
constexpr double kGap = 1e-5;
/// How far it may reach behind the wall.
constexpr double kBehind = 0.05;
/// How far from the boundary the wall has to stand yet.
constexpr double kAside = 1e-4;
constexpr std::array kPlaces{1.0 / 6, 0.5, 5.0 / 6};

/// Whether a wall stands between p and q.
bool is_walled(const Vec3& p, const Vec3& q, const std::vector<Surface>& surfaces,
               const Accel& accel) {
  Ray ray{p, normalize(q - p), 0, length(q - p)};
  PrimitiveId from = kNoPrimitive;
  while (const auto hit = accel.intersect(ray, from)) {
    if (is_opaque(surfaces[hit->id.shape])) return true;
    ray.t_min = hit->t;
    from = hit->id;
  }
  return false;
}

}  // namespace

bool is_covered(const BorderEdge& border, const std::vector<Surface>& surfaces,
                const Accel& accel) {
  const double size = accel.bounds().radius();
  const Vec3 along = normalize(border.b - border.a);
  // Behind the corner of a room only a slanting way leads back through its walls.
  const std::array ways{border.inward, normalize(border.inward + along),
                        normalize(border.inward - along)};
  return std::ranges::all_of(kPlaces, [&](double place) {
    const Vec3 p = border.a + place * (border.b - border.a);
    return std::ranges::any_of(ways, [&](const Vec3& way) {
      return std::ranges::all_of(std::array{-1, 1}, [&](int side) {
        const Vec3 o = p + side * kAside * size * border.normal;
        return is_walled(o - kGap * size * way, o + kBehind * size * way, surfaces, accel);
      });
    });
  });
}

}  // namespace fogbow
