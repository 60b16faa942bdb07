// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <stdexcept>

#include "core/scene/bsdf.h"

namespace fogbow {

/// What only reflects, hence may stand inside `twosided`; nothing refracts, and f_s is symmetric.
class ReflectingBsdf : public Bsdf {};

/// The mirror image of w.
inline Vec3 reflect_z(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// Throws std::domain_error unless 0 ≤ c ≤ 1 in every channel.
inline RGB checked_reflectance(const RGB& c) {
  for (int i = 0; i < 3; ++i)
    if (!(c[i] >= 0 && c[i] <= 1))
      throw std::domain_error("a reflectance or transmittance must lie in [0, 1]");
  return c;
}

}  // namespace fogbow
