// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/perspective_projection.h"

#include <stdexcept>

namespace fogbow {
namespace {

/// What files with few digits may be off by.
constexpr double kSimilarityTolerance = 1e-3;

void require(bool condition, const char* message) {
  if (!condition) throw std::domain_error(message);
}

bool inside(int offset, int size, int whole) {
  return size > 0 && offset >= 0 && offset <= whole - size;
}

}  // namespace

PerspectiveProjection::PerspectiveProjection(const PerspectiveSettings& s)
    : matrix_(s.to_world.matrix()), origin_(matrix_[3]) {
  const Vec3 a(matrix_[0]), b(matrix_[1]), c(matrix_[2]);
  scale_ = length(c);
  const double bound = kSimilarityTolerance * sqr(scale_);
  require(
      scale_ > 0 && std::fabs(length_squared(a) - sqr(scale_)) < bound &&
          std::fabs(length_squared(b) - sqr(scale_)) < bound && std::fabs(dot(a, b)) < bound &&
          std::fabs(dot(b, c)) < bound && std::fabs(dot(c, a)) < bound,
      "a camera's to_world may rotate, mirror, move and scale evenly, but not stretch or shear");
  // Exactly orthonormal, so that directions and raster positions are each other's inverse.
  z_ = c / scale_;
  y_ = normalize(b - dot(b, z_) * z_);
  x_ = cross(y_, z_);
  if (dot(x_, a) < 0) x_ = -x_;

  require(s.fov_x_degrees > 0 && s.fov_x_degrees < 180,
          "a camera's field of view must lie between 0 and 180 degrees");
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
  near_ = s.near_clip * scale_;
  far_ = s.far_clip * scale_;

  // Fraction U of the whole film: tangent.x = (1 − 2U) tan(fov/2), and the same measure downwards.
  const double half = std::tan(s.fov_x_degrees * kPi / 360);
  const Vec2 extent(half, half * s.height / s.width);
  tangent_lo_ = (1.0 - 2.0 * (crop_offset / whole + s.principal_point_offset)) * extent;
  tangent_size_ = -2.0 * (crop_size / whole) * extent;
  inverse_area_ = 1 / (tangent_size_.x * tangent_size_.y);
}

std::optional<Vec2> PerspectiveProjection::raster(const Vec2& tangent) const {
  const Vec2 r = (tangent - tangent_lo_) / tangent_size_;
  if (!(r.x >= 0 && r.x < 1 && r.y >= 0 && r.y < 1)) return std::nullopt;
  return r;
}

}  // namespace fogbow
