// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "core/math/warp.h"
#include "core/scene/perspective_projection.h"

namespace fogbow {
namespace {

/// An ideal lens: rays from anywhere on a disk that see the same raster position meet on the plane
/// in focus.
class ThinLensSensor final : public Sensor {
 public:
  ThinLensSensor(const PerspectiveSettings& settings, double aperture_radius, double focus_distance)
      : projection_(settings),
        radius_(aperture_radius * projection_.scale()),
        focus_(focus_distance * projection_.scale()),
        rim_(1 + 16 * std::numeric_limits<double>::epsilon() *
                     (1 + length(projection_.origin()) / radius_)) {
    if (!(radius_ > 0) || !std::isfinite(radius_))
      throw std::domain_error("a lens's aperture radius must be positive");
    if (!(focus_ > 0) || !std::isfinite(focus_))
      throw std::domain_error("a lens's focus distance must be positive");
  }

  bool dirac_position() const override { return false; }
  Vec3 sample_position(const Vec2& u) const override {
    return projection_.origin() + projection_.to_world(Vec3(radius_ * warp::sample_disk(u), 0));
  }
  double pdf_A(const Vec3& position) const override {
    const Vec2 p = on_lens(position) / radius_;
    return dot(p, p) <= sqr(rim_) ? kInvPi / sqr(radius_) : 0.0;
  }
  Vec2 invert_position(const Vec3& position, const Vec2&) const override {
    return warp::invert_disk(on_lens(position) / radius_);
  }

  double D(const Vec3& w) const override { return std::fabs(projection_.cos_axis(w)); }
  SensorRay sample_direction(const Vec3& position, const Vec2& raster) const override {
    const Vec2 tangent = projection_.tangent(raster) - on_lens(position) / focus_;
    const Vec3 w = normalize(Vec3(tangent, 1));
    return {projection_.to_world(w), projection_.pdf_sigma(w.z), position};
  }
  double pdf_sigma(const Vec3& position, const Vec3& w) const override {
    return raster(position, w) ? projection_.pdf_sigma(projection_.cos_axis(w)) : 0.0;
  }
  std::optional<Vec2> raster(const Vec3& position, const Vec3& w) const override {
    const Vec3 c = projection_.to_camera(w);
    if (!(c.z > 0)) return std::nullopt;
    return projection_.raster(on_lens(position) / focus_ + Vec2(c) / c.z);
  }
  /// Constant on lens and film but for cosines: pdf_A pdf_sigma / D.
  double W_e(const Vec3& position, const Vec3& w) const override {
    const double density = pdf_A(position) * pdf_sigma(position, w);
    return density > 0 ? density / D(w) : 0.0;
  }

  double near_distance(const Vec3& w) const override {
    return projection_.near_distance(projection_.cos_axis(w));
  }
  double far_distance(const Vec3& w) const override {
    return projection_.far_distance(projection_.cos_axis(w));
  }
  Mat4 to_world() const override { return projection_.matrix(); }

 private:
  Vec2 on_lens(const Vec3& position) const {
    return Vec2(projection_.to_camera(position - projection_.origin()));
  }

  PerspectiveProjection projection_;
  double radius_, focus_;
  double rim_;  ///< of the unit disk, as far as positions in the world are rounded
};

}  // namespace

std::shared_ptr<const Sensor> make_thinlens_sensor(const PerspectiveSettings& settings,
                                                   double aperture_radius, double focus_distance) {
  return std::make_shared<ThinLensSensor>(settings, aperture_radius, focus_distance);
}

}  // namespace fogbow
