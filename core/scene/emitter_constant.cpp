// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/warp.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"
#include "core/scene/parallel_light.h"

namespace fogbow {
namespace {

class ConstantEmitter final : public ParallelLight {
 public:
  explicit ConstantEmitter(const RGB& radiance) : radiance_(require_radiance(radiance)) {}

  EmitterKind kind() const override { return EmitterKind::Infinite; }
  /// Flux through the scene's disk from all directions.
  RGB power() const override { return 4 * kPi * area() * radiance_; }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    return point(warp::sample_sphere(Vec2(u)), warp::pdf_sphere());
  }
  double pdf_position(const EmitterPoint&) const override { return warp::pdf_sphere(); }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    return Vec3(warp::invert_sphere(x.surface.n_g), auxiliary.z);
  }

  RGB L_e(const EmitterPoint&, const Vec3&) const override { return radiance_; }

 private:
  RGB radiance_;
};

}  // namespace

std::shared_ptr<Emitter> make_constant_emitter(const RGB& radiance) {
  return std::make_shared<ConstantEmitter>(radiance);
}

}  // namespace fogbow
