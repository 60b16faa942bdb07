// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <stdexcept>

#include "core/scene/bsdf.h"
#include "core/scene/texture.h"

namespace fogbow {

/// What only reflects, hence may stand inside `twosided`; nothing refracts, and f_s is symmetric.
class ReflectingBsdf : public Bsdf {};

/// The mirror image of w.
inline Vec3 reflect_z(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// Throws std::domain_error unless 0 ≤ c ≤ 1 in every channel, everywhere.
inline const Textured<RGB>& checked_reflectance(const Textured<RGB>& c) {
  if (const auto range = c.range(); !(range.least >= 0 && range.greatest <= 1))
    throw std::domain_error("a reflectance or transmittance must lie in [0, 1]");
  return c;
}

}  // namespace fogbow
