// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/warp.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"
#include "core/scene/point_light.h"

namespace fogbow {
namespace {

class PointEmitter final : public PointLight {
 public:
  PointEmitter(const Vec3& position, const RGB& intensity)
      : PointLight(position), intensity_(require_radiance(intensity)) {
    if (!is_finite(position)) throw std::domain_error("a point emitter must be somewhere");
  }

  RGB power() const override { return 4 * kPi * intensity_; }

  EmitterDirection sample_direction(const EmitterPoint&, const Vec2& u) const override {
    return {warp::sample_sphere(u), position(), warp::pdf_sphere()};
  }
  double pdf_direction(const EmitterPoint&, const Vec3&) const override {
    return warp::pdf_sphere();
  }
  std::optional<Vec2> invert_direction(const EmitterPoint&,
                                       const EmitterDirection& d) const override {
    return warp::invert_sphere(d.w);
  }

  RGB L_e(const EmitterPoint&, const Vec3&) const override { return intensity_; }

 private:
  RGB intensity_;
};

}  // namespace

std::shared_ptr<Emitter> make_point_emitter(const Vec3& position, const RGB& intensity) {
  return std::make_shared<PointEmitter>(position, intensity);
}

}  // namespace fogbow
