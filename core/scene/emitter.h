// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <optional>

#include "core/geometry/accel.h"
#include "core/geometry/shape.h"
#include "core/math/ray.h"
#include "core/math/vec.h"

namespace fogbow {

enum class EmitterKind {
  Area,         ///< on a shape; positions have density pdf_A
  Point,        ///< a Dirac position: density 1, D = 1
  Directional,  ///< a Dirac direction of travel: density 1; then a position on a disk across it
  Infinite,     ///< directions towards the light come first, with density in solid angle; then a
                ///< position on a disk across them
  Volume,       ///< in an emitting medium; positions have density pdf_V, D = 1
};

/// Where a light path starts.
struct EmitterPoint {
  SurfacePoint surface;     ///< only `position` counts for Point and Volume; for Directional and
                            ///< Infinite `n_g` is the direction in which light travels
  PrimitiveId id;           ///< of the surface, Area only
  double pdf_position = 0;  ///< dA (Area), 1 (Point, Directional), dσ (Infinite), dV (Volume); the
                            ///< choice of the emitter is not included
};

struct EmitterDirection {
  Vec3 w;       ///< world, away from the light (at infinity: the travelling direction)
  Vec3 origin;  ///< where the ray starts: the position, or at infinity a point outside the scene
  double pdf_direction = 0;  ///< dσ; at infinity dA across the ray
};

/// Whether light comes from beyond the scene.
inline bool at_infinity(EmitterKind kind) {
  return kind == EmitterKind::Infinite || kind == EmitterKind::Directional;
}
/// Whether position or direction is Dirac, so that no ray runs into the light.
inline bool is_dirac(EmitterKind kind) {
  return kind == EmitterKind::Point || kind == EmitterKind::Directional;
}

class Emitter {
 public:
  virtual ~Emitter() = default;
  virtual EmitterKind kind() const = 0;

  /// Called once when the scene is built; emitters at infinity need the sphere around the scene.
  virtual void bind(const Vec3& /*scene_center*/, double /*scene_radius*/) {}
  /// Called once when the scene is built, with the scene's number of the shape that an Area emitter
  /// lies on: `id.shape` of its points.
  virtual void bind_shape(std::uint32_t /*shape*/) {}
  /// Rough total power (any unit that all emitters of a scene share): weights of the choice between
  /// emitters.
  virtual RGB power() const = 0;

  /// Nothing where the sample misses the support (Volume's bounding box).
  virtual std::optional<EmitterPoint> sample_position(const Vec3& u) const = 0;
  virtual double pdf_position(const EmitterPoint& x) const = 0;
  virtual std::optional<Vec3> invert_position(const EmitterPoint& x,
                                              const Vec3& auxiliary) const = 0;

  virtual EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const = 0;
  /// `w` away from the light; at infinity the density of the origin on the disk.
  virtual double pdf_direction(const EmitterPoint& x, const Vec3& w) const = 0;
  virtual std::optional<Vec2> invert_direction(const EmitterPoint& x,
                                               const EmitterDirection& d) const = 0;

  /// Radiance (Area, Infinite), intensity (Point), irradiance across the light (Directional), or
  /// radiance per unit length (Volume), leaving x along w.
  virtual RGB L_e(const EmitterPoint& x, const Vec3& w) const = 0;
};

}  // namespace fogbow
