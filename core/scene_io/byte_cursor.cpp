// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/byte_cursor.h"

#include <cmath>

#include "core/math/vec.h"

namespace fogbow {

float from_half(std::uint32_t half) {
  const int exponent = half >> 10 & 31;
  const double fraction = half & 1023;
  double value =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  if (exponent == 31) value = fraction == 0 ? kInfinity : std::nan("");
  return static_cast<float>(half & 0x8000 ? -value : value);
}

}  // namespace fogbow
