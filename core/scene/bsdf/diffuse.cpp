// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class Diffuse final : public CosineSampledBsdf {
 public:
  explicit Diffuse(const Textured<RGB>& reflectance)
      : reflectance_(checked_reflectance(reflectance)) {}

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return w_light.z > 0 && w_eye.z > 0 ? reflectance_(x) * kInvPi : RGB(0);
  }

  RGB albedo(const SurfacePoint& x) const override { return reflectance_(x); }
  const char* name() const override { return "diffuse"; }

 private:
  Textured<RGB> reflectance_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_diffuse(const Textured<RGB>& reflectance) {
  return std::make_shared<Diffuse>(reflectance);
}

}  // namespace fogbow
