// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <stdexcept>

#include "core/math/vec.h"
#include "core/scene/texture.h"

namespace fogbow {

/// Radiance or intensity as given; throws std::domain_error if it is negative or not finite.
inline RGB require_radiance(const RGB& radiance) {
  if (!is_finite(radiance) || radiance.x < 0 || radiance.y < 0 || radiance.z < 0)
    throw std::domain_error("what an emitter radiates must be finite and not negative");
  return radiance;
}
inline const Textured<RGB>& require_radiance(const Textured<RGB>& radiance) {
  const Texture::Range range = radiance.range();
  require_radiance(RGB(range.least));
  require_radiance(RGB(range.greatest));
  return radiance;
}

}  // namespace fogbow
