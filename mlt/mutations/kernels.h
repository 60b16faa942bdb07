// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/frame.h"
#include "core/math/vec.h"
#include "core/util/rng.h"

namespace fogbow {

/// Steps with density ∝ 1/r between two sizes (VeachGuibas1997, sec. 5.3): every order of magnitude
/// is tried as often as another. All perturbations by them are symmetric.
class StepSizes {
 public:
  StepSizes(double least, double most)
      : least_(least), most_(most), range_(std::log(most / least)) {}
  /// The same distribution in another unit.
  StepSizes scaled(double unit) const { return {least_ * unit, most_ * unit, range_}; }

  double sample(double u) const { return most_ * std::exp(-u * range_); }
  double pdf(double r) const { return r >= least_ && r <= most_ ? 1 / (r * range_) : 0.0; }
  /// P(step ≥ r).
  double at_least(double r) const {
    if (r <= least_) return 1;
    return r >= most_ ? 0 : std::log(most_ / r) / range_;
  }

 private:
  StepSizes(double least, double most, double range) : least_(least), most_(most), range_(range) {}

  double least_, most_, range_;
};

/// A step of this length in a uniform direction of the plane.
inline Vec2 planar_step(const StepSizes& sizes, Rng& rng) {
  const double r = sizes.sample(rng.uniform()), phi = 2 * kPi * rng.uniform();
  return {r * std::cos(phi), r * std::sin(phi)};
}

/// A direction at such an angle from w; its density in solid angle depends on the angle alone.
inline Vec3 perturb_direction(const Vec3& w, const StepSizes& angles, Rng& rng) {
  const double theta = angles.sample(rng.uniform()), phi = 2 * kPi * rng.uniform();
  const double sine = std::sin(theta);
  return Frame(w).to_world(Vec3(sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)));
}

}  // namespace fogbow
