// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/phase_function.h"

namespace fogbow {

/// What depends on the scattering angle alone: the polar angle of propagation before and after.
/// Directions point away from the vertex, so light goes on straight where to = −from: 1 − cosθ =
/// |from + to|²/2.
class AxialPhase : public PhaseFunction {
 public:
  RGB f_p(const Vec3& from, const Vec3& to) const final { return evaluate(from, to).f_p; }
  double pdf_sigma(const Vec3& from, const Vec3& to) const final {
    return density(between(from, to));
  }
  PhaseValue evaluate(const Vec3& from, const Vec3& to) const final {
    const warp::PolarAngle angle = between(from, to);
    const double d = density(angle);
    return {value(angle, d), d};
  }
  Vec3 sample(const Vec3& from, const Vec3& u) const final {
    return Frame(-from).to_world(warp::polar_direction(sample_angle(u.y), u.z));
  }
  std::optional<Vec3> invert(const Vec3& from, const Vec3& to, const Vec3& auxiliary) const final {
    const warp::PolarAngle angle = between(from, to);
    if (!(density(angle) > 0)) return std::nullopt;
    const Frame frame(-from);
    return Vec3(auxiliary.x, invert_angle(angle),
                warp::invert_azimuth(dot(to, frame.s), dot(to, frame.t)));
  }

 protected:
  /// `density` is that of the angle.
  virtual RGB value(const warp::PolarAngle&, double density) const { return RGB(density); }
  /// In solid angle.
  virtual double density(const warp::PolarAngle& angle) const = 0;
  virtual warp::PolarAngle sample_angle(double u) const = 0;
  /// The u with sample_angle(u) = angle, where the density is positive.
  virtual double invert_angle(const warp::PolarAngle& angle) const = 0;

 private:
  static warp::PolarAngle between(const Vec3& from, const Vec3& to) {
    return {0.5 * length_squared(from + to), 0.5 * length_squared(from - to)};
  }
};

}  // namespace fogbow
