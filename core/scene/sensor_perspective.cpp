// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/perspective_projection.h"

namespace fogbow {
namespace {

/// A pinhole: all directions start at one point, W_e = pdf_sigma.
class PerspectiveSensor final : public Sensor {
 public:
  explicit PerspectiveSensor(const PerspectiveSettings& settings) : projection_(settings) {}

  bool dirac_position() const override { return true; }
  Vec3 sample_position(const Vec2&) const override { return projection_.origin(); }
  double pdf_A(const Vec3&) const override { return 1; }
  Vec2 invert_position(const Vec3&, const Vec2& auxiliary) const override { return auxiliary; }

  double D(const Vec3&) const override { return 1; }
  SensorRay sample_direction(const Vec3&, const Vec2& raster) const override {
    const Vec3 w = normalize(Vec3(projection_.tangent(raster), 1));
    return {projection_.to_world(w), projection_.pdf_sigma(w.z), projection_.origin()};
  }
  double pdf_sigma(const Vec3& position, const Vec3& w) const override {
    return raster(position, w) ? projection_.pdf_sigma(projection_.cos_axis(w)) : 0.0;
  }
  std::optional<Vec2> raster(const Vec3&, const Vec3& w) const override {
    const Vec3 c = projection_.to_camera(w);
    if (!(c.z > 0)) return std::nullopt;
    return projection_.raster(Vec2(c) / c.z);
  }
  double W_e(const Vec3& position, const Vec3& w) const override { return pdf_sigma(position, w); }

  double near_distance(const Vec3& w) const override {
    return projection_.near_distance(projection_.cos_axis(w));
  }
  double far_distance(const Vec3& w) const override {
    return projection_.far_distance(projection_.cos_axis(w));
  }
  Mat4 to_world() const override { return projection_.matrix(); }

 private:
  PerspectiveProjection projection_;
};

}  // namespace

std::shared_ptr<const Sensor> make_perspective_sensor(const PerspectiveSettings& settings) {
  return std::make_shared<PerspectiveSensor>(settings);
}

}  // namespace fogbow
