// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"
#include "core/util/check.h"

namespace fogbow {
namespace {

/// Origins lie this many scene radii before the disk's plane through the scene's centre.
constexpr double kStandOff = 2;

class ConstantEmitter final : public Emitter {
 public:
  explicit ConstantEmitter(const RGB& radiance) : radiance_(require_radiance(radiance)) {}

  EmitterKind kind() const override { return EmitterKind::Infinite; }
  void bind(const Vec3& scene_center, double scene_radius) override {
    FOGBOW_CHECK(is_finite(scene_center) && scene_radius > 0 && std::isfinite(scene_radius));
    center_ = scene_center;
    radius_ = scene_radius;
  }
  /// Flux through the scene's disk from all directions.
  RGB power() const override { return 4 * kPi * kPi * sqr(radius_) * radiance_; }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    EmitterPoint x;
    x.surface.n_g = warp::sample_sphere(Vec2(u));
    x.surface.position = center_ - kStandOff * radius_ * x.surface.n_g;
    x.pdf_position = warp::pdf_sphere();
    return x;
  }
  double pdf_position(const EmitterPoint&) const override { return warp::pdf_sphere(); }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    return Vec3(warp::invert_sphere(x.surface.n_g), auxiliary.z);
  }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const override {
    const Frame frame(x.surface.n_g);
    const Vec2 p = radius_ * warp::sample_disk(u);
    return {frame.n, center_ + frame.to_world(Vec3(p, -kStandOff * radius_)), density()};
  }
  double pdf_direction(const EmitterPoint&, const Vec3&) const override { return density(); }
  /// Any point of the ray will do as its origin.
  std::optional<Vec2> invert_direction(const EmitterPoint& x,
                                       const EmitterDirection& d) const override {
    const Vec2 p = Vec2(Frame(x.surface.n_g).to_local(d.origin - center_)) / radius_;
    if (!(dot(p, p) <= 1)) return std::nullopt;
    return warp::invert_disk(p);
  }

  RGB L_e(const EmitterPoint&, const Vec3&) const override { return radiance_; }

 private:
  double density() const { return kInvPi / sqr(radius_); }

  RGB radiance_;
  Vec3 center_{0};
  double radius_ = 0;
};

}  // namespace

std::shared_ptr<Emitter> make_constant_emitter(const RGB& radiance) {
  return std::make_shared<ConstantEmitter>(radiance);
}

}  // namespace fogbow
