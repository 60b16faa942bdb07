// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/frame.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"
#include "core/scene/parallel_light.h"

namespace fogbow {
namespace {

class DirectionalEmitter final : public ParallelLight {
 public:
  DirectionalEmitter(const Vec3& direction, const RGB& irradiance)
      : irradiance_(require_radiance(irradiance)) {
    if (!is_finite(direction) || !(length(direction) > 0))
      throw std::domain_error("the direction of light must be finite and not zero");
    direction_ = normalize(direction);
  }

  EmitterKind kind() const override { return EmitterKind::Directional; }
  RGB power() const override { return area() * irradiance_; }

  std::optional<EmitterPoint> sample_position(const Vec3&) const override {
    return point(direction_, 1);
  }
  double pdf_position(const EmitterPoint&) const override { return 1; }
  std::optional<Vec3> invert_position(const EmitterPoint&, const Vec3& auxiliary) const override {
    return auxiliary;
  }

  RGB L_e(const EmitterPoint&, const Vec3&) const override { return irradiance_; }

 private:
  Vec3 direction_;
  RGB irradiance_;
};

}  // namespace

std::shared_ptr<Emitter> make_directional_emitter(const Vec3& direction, const RGB& irradiance) {
  return std::make_shared<DirectionalEmitter>(direction, irradiance);
}

}  // namespace fogbow
