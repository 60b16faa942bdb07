// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/field_of_view.h"

#include <cmath>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/parse_values.h"

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

}  // namespace

double field_of_view(Properties& p, double aspect) {
  if (!p.has("fov")) return horizontal_fov(p, fov_of_focal_length(p), "diagonal", aspect);
  if (p.has("focal_length")) p.fail("focal_length", "give either \"fov\" or \"focal_length\"");
  const double angle = p.number("fov", 0);
  if (!(angle > 0 && angle < 180)) p.fail("fov", "\"fov\" must lie between 0 and 180 degrees");
  return horizontal_fov(p, angle, p.string("fov_axis", "x"), aspect);
}

}  // namespace fogbow
