// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "core/math/transform.h"
#include "core/scene/sensor.h"

namespace fogbow {

struct PerspectiveSettings {
  Transform to_world;            ///< camera looks along +z, +x is to the left of the picture
  double fov_x_degrees = 38.18;  ///< horizontal, of the whole picture
  int width = 768, height = 576;
  int crop_x = 0, crop_y = 0, crop_width = 0,
      crop_height = 0;                      ///< raster covers the crop alone; width 0: all
  double near_clip = 0.01, far_clip = 1e4;  ///< distances along the axis
  Vec2 principal_point_offset{0, 0};        ///< in fractions of the film
};

std::shared_ptr<const Sensor> make_perspective_sensor(const PerspectiveSettings& settings);
/// Parallel rays along +z of `to_world`, from a film that spans [−1, 1] along its x; the field of
/// view counts for nothing. Clips as Mitsuba 3.9.1 does: `near_clip` in lengths of its z axis from
/// the film, and from there on far_clip − near_clip in lengths of the world.
std::shared_ptr<const Sensor> make_orthographic_sensor(const PerspectiveSettings& settings);
std::shared_ptr<const Sensor> make_thinlens_sensor(const PerspectiveSettings& settings,
                                                   double aperture_radius, double focus_distance);

}  // namespace fogbow
