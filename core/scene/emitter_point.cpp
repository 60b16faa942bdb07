// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/warp.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"

namespace fogbow {
namespace {

class PointEmitter final : public Emitter {
 public:
  PointEmitter(const Vec3& position, const RGB& intensity)
      : position_(position), intensity_(require_radiance(intensity)) {
    if (!is_finite(position)) throw std::domain_error("a point emitter must be somewhere");
  }

  EmitterKind kind() const override { return EmitterKind::Point; }
  RGB power() const override { return 4 * kPi * intensity_; }

  std::optional<EmitterPoint> sample_position(const Vec3&) const override {
    EmitterPoint x;
    x.surface.position = position_;
    x.pdf_position = 1;
    return x;
  }
  double pdf_position(const EmitterPoint&) const override { return 1; }
  std::optional<Vec3> invert_position(const EmitterPoint&, const Vec3& auxiliary) const override {
    return auxiliary;
  }

  EmitterDirection sample_direction(const EmitterPoint&, const Vec2& u) const override {
    return {warp::sample_sphere(u), position_, warp::pdf_sphere()};
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
  Vec3 position_;
  RGB intensity_;
};

}  // namespace

std::shared_ptr<Emitter> make_point_emitter(const Vec3& position, const RGB& intensity) {
  return std::make_shared<PointEmitter>(position, intensity);
}

}  // namespace fogbow
