// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "core/scene/film_area.h"

namespace fogbow {

/// The geometry that pinhole and thin lens share. Camera space is a rotated (or mirrored) world, in
/// world units of length: +z is the optical axis, and a tangent is a point of the plane z = 1.
class PerspectiveProjection {
 public:
  /// Throws std::domain_error on an impossible field of view, size, crop window, clip distance, or
  /// a matrix that shears or stretches.
  explicit PerspectiveProjection(const PerspectiveSettings& settings);

  Vec3 origin() const { return origin_; }
  /// Factor of lengths in `to_world`, applied to all lengths of the settings.
  double scale() const { return scale_; }
  Vec3 to_camera(const Vec3& w) const { return {dot(w, x_), dot(w, y_), dot(w, z_)}; }
  Vec3 to_world(const Vec3& w) const { return w.x * x_ + w.y * y_ + w.z * z_; }
  double cos_axis(const Vec3& w) const { return dot(w, z_); }
  const Mat4& matrix() const { return matrix_; }

  /// Of a raster position on the crop window.
  Vec2 tangent(const Vec2& raster) const { return film_.point(raster); }
  /// Nothing off the film.
  std::optional<Vec2> raster(const Vec2& tangent) const { return film_.raster(tangent); }
  /// Density in solid angle, around any point, of the direction to a point of a plane across the
  /// axis that is uniform on the film's image there.
  double pdf_sigma(double cos_axis) const {
    return 1 / (film_.area() * cos_axis * cos_axis * cos_axis);
  }

  double near_distance(double cos_axis) const { return near_ / cos_axis; }
  double far_distance(double cos_axis) const { return far_ / cos_axis; }

 private:
  Mat4 matrix_;
  Vec3 origin_, x_, y_, z_;
  double scale_;
  FilmArea film_;  ///< in tangents
  double near_, far_;
};

}  // namespace fogbow
