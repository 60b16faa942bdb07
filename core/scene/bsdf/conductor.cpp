// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class Conductor final : public ReflectingBsdf {
 public:
  Conductor(const Textured<RGB>& eta, const Textured<RGB>& k, const Textured<RGB>& reflectance)
      : index_(eta, k), tint_(checked_reflectance(reflectance)) {}

  bool has_smooth() const override { return false; }
  bool has_dirac() const override { return true; }
  RGB f_s(const SurfacePoint&, const Vec3&, const Vec3&) const override { return RGB(0); }
  double pdf_sigma(const SurfacePoint&, const Vec3&, const Vec3&) const override { return 0; }

  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    return tint_(x) * index_.reflectance(x, w_light.z);
  }
  double pdf_dirac(const SurfacePoint&, const Vec3& from, const Vec3& to) const override {
    return from.z > 0 && to.z > 0 ? to.z : 0.0;
  }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& from,
                                   const Vec3&) const override {
    if (!(from.z > 0)) return std::nullopt;
    return BsdfSample{reflect_z(from), true, from.z};
  }
  std::optional<Vec3> invert(const SurfacePoint&, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (!(dirac && from.z > 0 && to.z > 0)) return std::nullopt;
    return auxiliary;
  }

  RGB albedo(const SurfacePoint& x) const override { return tint_(x) * index_.reflectance(x, 1); }
  const char* name() const override { return "conductor"; }

 private:
  ComplexIndex index_;
  Textured<RGB> tint_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_conductor(const Textured<RGB>& eta, const Textured<RGB>& k,
                                           const Textured<RGB>& specular_reflectance) {
  return std::make_shared<Conductor>(eta, k, specular_reflectance);
}

}  // namespace fogbow
