// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/sun_sky_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace fogbow {
namespace {

#include "core/scene/data/hosek_wilkie_sky.inc"
#include "core/scene/data/hosek_wilkie_sun.inc"

constexpr int kControlPoints = 6, kParameters = 9;
/// ∫ ȳ dλ of the 1931 observer, in nm: from luminous to radiometric units, as Mitsuba counts.
constexpr double kLuminous = 106.7502593994140625;
/// Of the sun's table against the sky's.
constexpr double kSunScale = 467.069280386;

/// The integer below a turbidity at which tables have a row, and the part of the next one.
struct Turbidity {
  int row;
  double part;

  explicit Turbidity(double turbidity) {
    if (!(turbidity >= 1 && turbidity <= 10))
      throw std::domain_error("the turbidity must lie between 1 and 10");
    row = std::min(static_cast<int>(turbidity) - 1, 8);
    part = turbidity - 1 - row;
  }
  double mix(double here, double next) const { return (1 - part) * here + part * next; }
};

/// What a table of `width` numbers for each turbidity, albedo and control point says of number i: a
/// quintic Bézier curve over the cube root of the elevation [Hosek2012, sec. 5].
double look_up(const float* table, int width, int i, const Turbidity& turbidity, double albedo,
               double x) {
  static constexpr std::array<double, kControlPoints> kBinomial{1, 5, 10, 10, 5, 1};
  const auto at = [&](int row, int ground, int point) {
    return static_cast<double>(table[((2 * row + ground) * kControlPoints + point) * width + i]);
  };
  double sum = 0;
  for (int p = 0; p < kControlPoints; ++p) {
    const double weight =
        kBinomial[static_cast<std::size_t>(p)] * std::pow(x, p) * std::pow(1 - x, 5 - p);
    const auto mixed = [&](int row) {
      return (1 - albedo) * at(row, 0, p) + albedo * at(row, 1, p);
    };
    sum += weight * turbidity.mix(mixed(turbidity.row), mixed(turbidity.row + 1));
  }
  return sum;
}

double cube_root_of_height(double elevation) { return std::cbrt(elevation / (kPi / 2)); }

double radians(double degrees) { return degrees * kPi / 180; }

/// Days since noon of January 1, 2000, universal time [Fliegel1968].
double days_since_2000(const SunTime& t, double universal_hour) {
  const int a = (t.month - 14) / 12;
  const int noon = 1461 * (t.year + 4800 + a) / 4 + 367 * (t.month - 2 - 12 * a) / 12 -
                   3 * ((t.year + 4900 + a) / 100) / 4 + t.day - 32075;
  return noon - 2451545 - 0.5 + universal_hour / 24;
}

}  // namespace

SkyModel::SkyModel(double turbidity, const RGB& albedo, double sun_elevation) {
  const Turbidity t(turbidity);
  if (!(sun_elevation >= 0)) throw std::domain_error("the sun must not be below the horizon");
  const double x = cube_root_of_height(sun_elevation);
  for (int c = 0; c < 3; ++c) {
    if (!(albedo[c] >= 0 && albedo[c] <= 1))
      throw std::domain_error("the ground's albedo must lie between 0 and 1");
    for (int i = 0; i < kParameters; ++i)
      shape_[static_cast<std::size_t>(c)][static_cast<std::size_t>(i)] =
          look_up(kSkyShape, 3 * kParameters, kParameters * c + i, t, albedo[c], x);
    radiance_[c] = look_up(kSkyRadiance, 3, c, t, albedo[c], x) / kLuminous;
  }
}

/// [Hosek2012, eq. 8]
RGB SkyModel::radiance(double cos_zenith, double gamma) const {
  const double cos_gamma = std::cos(gamma);
  RGB result;
  for (int c = 0; c < 3; ++c) {
    const auto& [A, B, C, D, E, F, G, I, H] = shape_[static_cast<std::size_t>(c)];
    const double chi = (1 + sqr(cos_gamma)) / std::pow(1 + sqr(H) - 2 * H * cos_gamma, 1.5);
    result[c] = radiance_[c] * (1 + A * std::exp(B / (cos_zenith + 0.01))) *
                (C + D * std::exp(E * gamma) + F * sqr(cos_gamma) + G * chi +
                 I * std::sqrt(std::max(cos_zenith, 0.0)));
  }
  return result;
}

SunModel::SunModel(double turbidity) {
  const Turbidity t(turbidity);
  const int size = static_cast<int>(sizeof(kSun) / sizeof(float)) / 10;
  int i = t.row * size;
  for (auto& segment : coefficients_)
    for (auto& channel : segment)
      for (auto& power : channel)
        for (double& c : power) {
          c = kSunScale / kLuminous * t.mix(kSun[i], kSun[i + size]);
          ++i;
        }
}

/// Piecewise cubic in the elevation, and of fifth degree in the cosine [Hosek2013].
RGB SunModel::radiance(double elevation, double cosine) const {
  if (!(elevation >= 0)) return RGB(0);
  const int segment =
      std::min(static_cast<int>(cube_root_of_height(elevation) * kSegments), kSegments - 1);
  const double begin = kPi / 2 * std::pow(static_cast<double>(segment) / kSegments, 3);
  const double x = elevation - begin;
  RGB result(0);
  for (int c = 0; c < 3; ++c) {
    const auto& channel =
        coefficients_[static_cast<std::size_t>(segment)][static_cast<std::size_t>(c)];
    for (std::size_t k = channel.size(); k-- > 0;) {
      double limb = 0;
      for (std::size_t l = channel[k].size(); l-- > 0;) limb = limb * cosine + channel[k][l];
      result[c] = result[c] * x + limb;
    }
  }
  return result;
}

Vec3 sun_direction(const SunTime& t) {
  const double hour = t.hour - t.timezone + (t.minute + t.second / 60) / 60;
  const double n = days_since_2000(t, hour);
  // Ecliptic coordinates [BlancoMuriel2001, eq. 3 to 7].
  const double Omega = 2.1429 - 0.0010394594 * n;
  const double mean_longitude = 4.8950630 + 0.017202791698 * n;
  const double g = 6.2400600 + 0.0172019699 * n;
  const double l = mean_longitude + 0.03341607 * std::sin(g) + 0.00034894 * std::sin(2 * g) -
                   0.0001134 - 0.0000203 * std::sin(Omega);
  const double ep = 0.4090928 - 6.2140e-9 * n + 0.0000396 * std::cos(Omega);
  // Celestial ones.
  const double ascension = std::atan2(std::cos(ep) * std::sin(l), std::cos(l));
  const double declination = std::asin(std::sin(ep) * std::sin(l));
  // Those of the place.
  const double sidereal = 6.6974243242 + 0.0657098283 * n + hour;
  const double omega = radians(sidereal * 15 + t.longitude) - ascension;
  const double latitude = radians(t.latitude);
  double zenith = std::acos(std::cos(latitude) * std::cos(omega) * std::cos(declination) +
                            std::sin(declination) * std::sin(latitude));
  const double azimuth = std::atan2(-std::sin(omega), std::tan(declination) * std::cos(latitude) -
                                                          std::sin(latitude) * std::cos(omega));
  constexpr double kEarthRadius = 6371.01, kAstronomicalUnit = 149597890;  // km
  zenith += kEarthRadius / kAstronomicalUnit * std::sin(zenith);
  // Azimuths are counted from the north to the east.
  return {-std::cos(azimuth) * std::sin(zenith), -std::sin(azimuth) * std::sin(zenith),
          std::cos(zenith)};
}

}  // namespace fogbow
