// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// A pane with all reflections inside it; what it transmits goes straight through.
class ThinDielectric final : public Bsdf {
 public:
  ThinDielectric(double eta, const Textured<RGB>& reflectance, const Textured<RGB>& transmittance)
      : eta_(checked_coat_index(eta)),
        reflectance_(checked_reflectance(reflectance)),
        transmittance_(checked_reflectance(transmittance)) {}

  bool has_smooth() const override { return false; }
  bool has_dirac() const override { return true; }
  bool has_passage() const override { return true; }
  RGB passage(const SurfacePoint& x, const Vec3& w) const override {
    return transmittance_(x) * (1 - reflected(w));
  }
  RGB f_s(const SurfacePoint&, const Vec3&, const Vec3&) const override { return RGB(0); }
  double pdf_sigma(const SurfacePoint&, const Vec3&, const Vec3&) const override { return 0; }

  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return w_light.z * w_eye.z > 0 ? reflectance_(x) * reflected(w_light) : RGB(0);
  }
  double pdf_dirac(const SurfacePoint&, const Vec3& from, const Vec3& to) const override {
    return from.z * to.z > 0 ? std::fabs(to.z) : 0.0;
  }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& from,
                                   const Vec3&) const override {
    if (from.z == 0) return std::nullopt;
    return BsdfSample{reflect_z(from), true, std::fabs(from.z)};
  }
  std::optional<Vec3> invert(const SurfacePoint&, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (!dirac || !(from.z * to.z > 0)) return std::nullopt;
    return auxiliary;
  }

  RGB albedo(const SurfacePoint& x) const override {
    return glm::max(reflectance_(x), transmittance_(x));
  }
  const char* name() const override { return "thindielectric"; }

 private:
  /// R + T²R + T²R³ + … = 2R/(1 + R).
  double reflected(const Vec3& w) const {
    const double R = fresnel_dielectric(std::fabs(w.z), eta_).F;
    return 2 * R / (1 + R);
  }

  double eta_;
  Textured<RGB> reflectance_, transmittance_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_thin_dielectric(double eta, const Textured<RGB>& reflectance,
                                                 const Textured<RGB>& transmittance) {
  return std::make_shared<ThinDielectric>(eta, reflectance, transmittance);
}

}  // namespace fogbow
