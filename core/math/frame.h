// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/vec.h"

namespace fogbow {

/// Right-handed orthonormal frame; `n` is the local z axis.
struct Frame {
  Vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

  Frame() = default;
  Frame(const Vec3& s_, const Vec3& t_, const Vec3& n_) : s(s_), t(t_), n(n_) {}

  /// Frame around a unit normal, without branches or singularity (Duff et al. 2017).
  explicit Frame(const Vec3& normal) : n(normal) {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z);
    const double b = n.x * n.y * a;
    s = Vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
    t = Vec3(b, sign + n.y * n.y * a, -n.y);
  }

  /// Change of s and t when the normal changes by dn.
  Frame derivative(const Vec3& dn) const {
    const double sign = std::copysign(1.0, n.z);
    const double a = -1.0 / (sign + n.z), da = a * a * dn.z;
    const double db = (dn.x * n.y + n.x * dn.y) * a + n.x * n.y * da;
    return {Vec3(sign * (2 * n.x * dn.x * a + n.x * n.x * da), sign * db, -sign * dn.x),
            Vec3(db, 2 * n.y * dn.y * a + n.y * n.y * da, -dn.y), dn};
  }

  Vec3 to_local(const Vec3& w) const { return {dot(w, s), dot(w, t), dot(w, n)}; }
  Vec3 to_world(const Vec3& w) const { return w.x * s + w.y * t + w.z * n; }
};

}  // namespace fogbow
