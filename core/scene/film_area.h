// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "core/scene/sensors.h"

namespace fogbow {

/// The part of a plane that a film or its crop window covers, in coordinates of which the whole
/// film takes up [−e.x, e.x] × [−e.y, e.y], e.y being e.x times height over width: x to the left of
/// the picture, y upwards.
class FilmArea {
 public:
  /// Throws std::domain_error on an impossible size or crop window, or on clip distances that are
  /// none.
  FilmArea(const PerspectiveSettings& settings, double half_width);

  /// Of a raster position on the crop window.
  Vec2 point(const Vec2& raster) const { return lo_ + raster * size_; }
  /// Nothing off the film.
  std::optional<Vec2> raster(const Vec2& point) const;
  double area() const { return size_.x * size_.y; }

 private:
  Vec2 lo_, size_;  ///< of raster (0, 0), and from there to (1, 1): negative
};

}  // namespace fogbow
