// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/vec.h"
#include "core/util/rng.h"

namespace fogbow {

inline Vec2 uniform2(Rng& rng) {
  const double x = rng.uniform();
  return {x, rng.uniform()};
}

inline Vec3 uniform3(Rng& rng) {
  const double x = rng.uniform(), y = rng.uniform();
  return {x, y, rng.uniform()};
}

}  // namespace fogbow
