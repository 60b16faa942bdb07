// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/film_area.h"

namespace fogbow {
namespace {

/// Rays of one direction, evenly from all over the film.
class OrthographicSensor final : public Sensor {
 public:
  explicit OrthographicSensor(const PerspectiveSettings& s)
      : film_(s, 1), matrix_(s.to_world.matrix()), origin_(matrix_[3]), z_(matrix_[2]) {
    const double scale = length(z_);
    to_film_ = glm::inverse(Mat3(matrix_));
    z_ /= scale;
    pdf_ = scale / (std::fabs(glm::determinant(Mat3(matrix_))) * film_.area());
    near_ = s.near_clip * scale;
    far_ = near_ + (s.far_clip - s.near_clip);
  }

  bool dirac_position() const override { return false; }
  bool parallel() const override { return true; }
  Vec3 sample_position(const Vec2&) const override { return origin_; }
  double pdf_A(const Vec3&) const override { return 1; }
  Vec2 invert_position(const Vec3&, const Vec2& auxiliary) const override { return auxiliary; }
  Vec3 position_seeing(const Vec3& x) const override { return on_film(film_point(x)); }

  double D(const Vec3&) const override { return 1; }
  SensorRay sample_direction(const Vec3&, const Vec2& raster) const override {
    return {z_, pdf_, on_film(film_.point(raster))};
  }
  double pdf_sigma(const Vec3& position, const Vec3& w) const override {
    return raster(position, w) ? pdf_ : 0.0;
  }
  /// Any point of the ray will do as its position.
  std::optional<Vec2> raster(const Vec3& position, const Vec3& w) const override {
    if (!(dot(w, z_) > 0)) return std::nullopt;
    return film_.raster(film_point(position));
  }
  double W_e(const Vec3& position, const Vec3& w) const override { return pdf_sigma(position, w); }

  double near_distance(const Vec3&) const override { return near_; }
  double far_distance(const Vec3&) const override { return far_; }
  Mat4 to_world() const override { return matrix_; }

 private:
  Vec2 film_point(const Vec3& x) const { return Vec2(to_film_ * (x - origin_)); }
  Vec3 on_film(const Vec2& p) const {
    return origin_ + p.x * Vec3(matrix_[0]) + p.y * Vec3(matrix_[1]);
  }

  FilmArea film_;
  Mat4 matrix_;
  Mat3 to_film_;
  Vec3 origin_, z_;  ///< z_: where it looks
  double pdf_;       ///< across the rays
  double near_, far_;
};

}  // namespace

std::shared_ptr<const Sensor> make_orthographic_sensor(const PerspectiveSettings& settings) {
  return std::make_shared<OrthographicSensor>(settings);
}

}  // namespace fogbow
