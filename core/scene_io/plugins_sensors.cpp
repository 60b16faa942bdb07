// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/scene/sensors.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/parse_values.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

double degrees(double radians) { return radians * 180 / kPi; }
double radians(double degrees) { return degrees * kPi / 180; }

/// Horizontal field of view of one along another axis; `aspect` is width over height.
double horizontal_fov(Properties& p, double fov, const std::string& axis, double aspect) {
  const double tangent = std::tan(radians(fov) / 2);
  if (axis == "x" || (axis == "larger" && aspect >= 1) || (axis == "smaller" && aspect <= 1))
    return fov;
  if (axis == "y" || axis == "larger" || axis == "smaller")
    return degrees(2 * std::atan(tangent * aspect));
  if (axis == "diagonal") return degrees(2 * std::atan(tangent * aspect / std::hypot(aspect, 1)));
  p.fail("fov_axis",
         "expected \"x\", \"y\", \"diagonal\", \"smaller\" or \"larger\", found " + quote(axis));
}

/// Of a 36 × 24 mm film, along the diagonal: what `focal_length` means.
double fov_of_focal_length(Properties& p) {
  std::string text = p.string("focal_length", "50mm");
  if (text.ends_with("mm")) text.resize(text.size() - 2);
  const double f = parse_number(text, p.where("focal_length"));
  if (!(f > 0)) p.fail("focal_length", "\"focal_length\" must be greater than zero");
  return degrees(2 * std::atan(std::hypot(36, 24) / (2 * f)));
}

double fov(Properties& p, double aspect) {
  if (!p.has("fov")) return horizontal_fov(p, fov_of_focal_length(p), "diagonal", aspect);
  if (p.has("focal_length")) p.fail("focal_length", "give either \"fov\" or \"focal_length\"");
  const double angle = p.number("fov", 0);
  if (!(angle > 0 && angle < 180)) p.fail("fov", "\"fov\" must lie between 0 and 180 degrees");
  return horizontal_fov(p, angle, p.string("fov_axis", "x"), aspect);
}

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
  s.fov_x_degrees = fov(p, static_cast<double>(film.width) / film.height);
  return s;
}

std::shared_ptr<const Sensor> perspective(Properties& p, const FilmSettings& film) {
  PerspectiveSettings s = perspective_settings(p, film);
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
