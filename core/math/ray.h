// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>

#include "core/math/vec.h"

namespace fogbow {

/// Points o + t d with t in (t_min, t_max); d is a unit vector.
struct Ray {
  Vec3 o, d;
  double t_min = 0;
  double t_max = kInfinity;

  Vec3 operator()(double t) const { return o + t * d; }
};

/// Axis-aligned box; empty when lo > hi.
struct Bounds {
  Vec3 lo{kInfinity}, hi{-kInfinity};

  void extend(const Vec3& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  void extend(const Bounds& b) {
    lo = glm::min(lo, b.lo);
    hi = glm::max(hi, b.hi);
  }
  bool overlaps(const Bounds& b) const {
    for (int i = 0; i < 3; ++i)
      if (lo[i] > b.hi[i] || b.lo[i] > hi[i]) return false;
    return true;
  }
  std::array<Vec3, 8> corners() const {
    std::array<Vec3, 8> all;
    for (int i = 0; i < 8; ++i)
      all[i] = {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z};
    return all;
  }
  bool empty() const { return lo.x > hi.x || lo.y > hi.y || lo.z > hi.z; }
  Vec3 center() const { return 0.5 * (lo + hi); }
  Vec3 diagonal() const { return hi - lo; }
  double radius() const { return empty() ? 0.0 : 0.5 * length(diagonal()); }
  double volume() const { return empty() ? 0.0 : (hi.x - lo.x) * (hi.y - lo.y) * (hi.z - lo.z); }
};

/// Cuts [t0, t1] down to the part of the ray within a box; false where there is none.
inline bool clip(const Bounds& box, const Ray& ray, double& t0, double& t1) {
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.o[axis], d = ray.d[axis];
    if (d == 0) {
      if (!(o >= box.lo[axis] && o <= box.hi[axis])) return false;
      continue;
    }
    const double a = (box.lo[axis] - o) / d, b = (box.hi[axis] - o) / d;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  return t0 < t1;
}

}  // namespace fogbow
