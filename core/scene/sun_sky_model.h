// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "core/math/vec.h"

namespace fogbow {

// The clear sky [Hosek2012] and its sun [Hosek2013] in linear sRGB, in W/(m² sr nm) and with the
// scale of Mitsuba 3.9.1. Angles in radians; turbidity from 1 to 10. Colors beyond the gamut, those
// of a setting sun, have negative channels.

class SkyModel {
 public:
  /// `albedo` of the ground, each in [0, 1]; the sun must not be below the horizon.
  SkyModel(double turbidity, const RGB& albedo, double sun_elevation);

  /// Towards a direction above the horizon, `gamma` from the sun.
  RGB radiance(double cos_zenith, double gamma) const;

 private:
  std::array<std::array<double, 9>, 3> shape_;
  RGB radiance_;
};

class SunModel {
 public:
  explicit SunModel(double turbidity);

  /// Of a point of the disk: `elevation` of where it is seen, `cosine` of the angle under which the
  /// sun's surface is seen there (1 in the middle, 0 on the edge); nothing below the horizon.
  RGB radiance(double elevation, double cosine) const;

  /// Angular radius of the real sun.
  static constexpr double kRadius = 0.5 * 0.5358 * kPi / 180;

 private:
  static constexpr int kSegments = 45;
  /// [segment][channel][power of elevation][power of cosine]
  std::array<std::array<std::array<std::array<double, 6>, 4>, 3>, kSegments> coefficients_;
};

struct SunTime {
  int year = 2010, month = 7, day = 10;
  double hour = 15, minute = 0, second = 0;
  double latitude = 35.6894, longitude = 139.6917;  ///< degrees, north and east
  double timezone = 9;                              ///< hours east of Greenwich
};

/// Towards the sun [BlancoMuriel2001], with Mitsuba 3's axes: x to the south, y to the west, z up.
Vec3 sun_direction(const SunTime& time);

}  // namespace fogbow
