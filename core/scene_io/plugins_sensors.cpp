// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/sensors.h"
#include "core/scene_io/field_of_view.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

/// All but the field of view.
PerspectiveSettings film_and_clips(Properties& p, const FilmSettings& film) {
  PerspectiveSettings s;
  s.to_world = p.transform("to_world");
  s.width = film.width;
  s.height = film.height;
  s.crop_x = film.crop_x;
  s.crop_y = film.crop_y;
  s.crop_width = film.crop_width;
  s.crop_height = film.crop_height;
  s.near_clip = p.positive_number("near_clip", s.near_clip);
  s.far_clip = p.positive_number("far_clip", s.far_clip);
  if (!(s.near_clip < s.far_clip))
    p.fail("near_clip", "\"near_clip\" must be smaller than \"far_clip\"");
  return s;
}

PerspectiveSettings perspective_settings(Properties& p, const FilmSettings& film) {
  PerspectiveSettings s = film_and_clips(p, film);
  s.fov_x_degrees = field_of_view(p, static_cast<double>(film.width) / film.height);
  return s;
}

std::shared_ptr<const Sensor> perspective(Properties& p, const FilmSettings& film) {
  PerspectiveSettings s = perspective_settings(p, film);
  p.positive_number("focus_distance", s.far_clip);  // that of all its projections in Mitsuba
  s.principal_point_offset.x = p.number("principal_point_offset_x", 0);
  s.principal_point_offset.y = p.number("principal_point_offset_y", 0);
  return make_perspective_sensor(s);
}

std::shared_ptr<const Sensor> thinlens(Properties& p, const FilmSettings& film) {
  const PerspectiveSettings s = perspective_settings(p, film);
  const double aperture = p.required_number("aperture_radius");
  const double focus = p.positive_number("focus_distance", s.far_clip);
  if (!(aperture >= 0)) p.fail("aperture_radius", "\"aperture_radius\" must not be negative");
  if (aperture > 0) return make_thinlens_sensor(s, aperture, focus);
  p.warn("aperture_radius", "a lens of radius 0 is a pinhole");
  return make_perspective_sensor(s);
}

std::shared_ptr<const Sensor> orthographic(Properties& p, const FilmSettings& film) {
  p.positive_number("focus_distance", 1);
  return make_orthographic_sensor(film_and_clips(p, film));
}

}  // namespace

const PluginTable<std::shared_ptr<const Sensor>(Properties&, const FilmSettings&)>&
sensor_plugins() {
  static const PluginTable<std::shared_ptr<const Sensor>(Properties&, const FilmSettings&)> table{
      {"perspective", perspective}, {"thinlens", thinlens}, {"orthographic", orthographic}};
  return table;
}

}  // namespace fogbow
