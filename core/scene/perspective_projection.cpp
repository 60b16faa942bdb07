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

/// Tangent of half the angle.
double half_width(double fov_x_degrees) {
  require(fov_x_degrees > 0 && fov_x_degrees < 180,
          "a camera's field of view must lie between 0 and 180 degrees");
  return std::tan(fov_x_degrees * kPi / 360);
}

}  // namespace

PerspectiveProjection::PerspectiveProjection(const PerspectiveSettings& s)
    : matrix_(s.to_world.matrix()), origin_(matrix_[3]), film_(s, half_width(s.fov_x_degrees)) {
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

  near_ = s.near_clip * scale_;
  far_ = s.far_clip * scale_;
}

}  // namespace fogbow
