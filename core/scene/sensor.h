// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "core/math/vec.h"

namespace fogbow {

struct SensorRay {
  Vec3 w;            ///< world, away from the sensor
  double pdf_sigma;  ///< of the direction, given the position; parallel: dA across the ray
  Vec3 origin;       ///< the position; parallel: where on the film the ray starts
};

/// A camera. Raster positions are in [0,1)², u to the right, v down. The importance W_e integrates
/// to one over the whole film (∫ W_e D dσ dA = 1), so that ∫ f dμ is the mean radiance of the
/// picture.
class Sensor {
 public:
  virtual ~Sensor() = default;

  /// True for pinholes: position Dirac, D = 1, pdf_A = 1.
  virtual bool dirac_position() const = 0;
  /// True for orthographic cameras, the mirror image of directional lights: one direction in which
  /// they look, D = 1, pdf_A = 1. Then come positions on the film, with density across the rays.
  virtual bool parallel() const { return false; }
  /// Parallel: where on the film (or beside it, in its plane) `x` would be seen from.
  virtual Vec3 position_seeing(const Vec3& /*x*/) const { return sample_position(Vec2(0.5)); }
  virtual Vec3 sample_position(const Vec2& u) const = 0;
  virtual double pdf_A(const Vec3& position) const = 0;
  /// The u with sample_position(u) = position; `auxiliary` for pinholes and parallel rays, where
  /// any u will do.
  virtual Vec2 invert_position(const Vec3& position, const Vec2& auxiliary) const = 0;

  /// D at the sensor for a direction away from it: 1 for pinholes, |cos| to the optical axis for
  /// lenses.
  virtual double D(const Vec3& w) const = 0;
  virtual SensorRay sample_direction(const Vec3& position, const Vec2& raster) const = 0;
  virtual double pdf_sigma(const Vec3& position, const Vec3& w) const = 0;
  /// Where the film sees direction w from `position`; nothing off the film. The inverse of
  /// sample_direction.
  virtual std::optional<Vec2> raster(const Vec3& position, const Vec3& w) const = 0;
  /// Without the pixel filter; 0 off the film.
  virtual double W_e(const Vec3& position, const Vec3& w) const = 0;

  /// Nothing is seen nearer than near_distance(w) along w (nor attenuates there), nor beyond
  /// far_distance(w).
  virtual double near_distance(const Vec3& w) const = 0;
  virtual double far_distance(const Vec3& w) const = 0;
  /// World from camera, for metadata.
  virtual Mat4 to_world() const = 0;
};

}  // namespace fogbow
