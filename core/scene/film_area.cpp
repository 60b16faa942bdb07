// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/film_area.h"

#include <stdexcept>

namespace fogbow {
namespace {

void require(bool condition, const char* message) {
  if (!condition) throw std::domain_error(message);
}

bool inside(int offset, int size, int whole) {
  return size > 0 && offset >= 0 && offset <= whole - size;
}

}  // namespace

FilmArea::FilmArea(const PerspectiveSettings& s, double half_width) {
  require(s.width > 0 && s.height > 0, "a camera's film must have pixels");
  const bool cropped = s.crop_width != 0 || s.crop_height != 0;
  const Vec2 whole(s.width, s.height);
  const Vec2 crop_size = cropped ? Vec2(s.crop_width, s.crop_height) : whole;
  const Vec2 crop_offset = cropped ? Vec2(s.crop_x, s.crop_y) : Vec2(0);
  require(!cropped || (inside(s.crop_x, s.crop_width, s.width) &&
                       inside(s.crop_y, s.crop_height, s.height)),
          "a camera's crop window must lie on its film");
  require(s.near_clip > 0 && s.far_clip > s.near_clip,
          "a camera's clip distances must satisfy 0 < near < far");

  // Fraction U of the whole film: x = (1 − 2U) half_width, and the same measure downwards.
  const Vec2 extent(half_width, half_width * s.height / s.width);
  lo_ = (1.0 - 2.0 * (crop_offset / whole + s.principal_point_offset)) * extent;
  size_ = -2.0 * (crop_size / whole) * extent;
}

std::optional<Vec2> FilmArea::raster(const Vec2& point) const {
  const Vec2 r = (point - lo_) / size_;
  if (!(r.x >= 0 && r.x < 1 && r.y >= 0 && r.y < 1)) return std::nullopt;
  return r;
}

}  // namespace fogbow
