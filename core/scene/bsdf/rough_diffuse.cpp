// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// [OrenNayar1994], sampled as Lambertian.
class RoughDiffuse final : public CosineSampledBsdf {
 public:
  RoughDiffuse(const Textured<RGB>& reflectance, const Textured<double>& alpha, bool fast)
      : reflectance_(checked_reflectance(reflectance)), alpha_(alpha), fast_(fast) {
    if (const auto range = alpha.range(); !(range.least >= 0 && std::isfinite(range.greatest)))
      throw std::domain_error("roughness must be finite and not negative");
  }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    // Slopes of the Beckmann distribution of this α have the deviation α/√2.
    const double sigma2 = sqr(alpha_(x)) / 2;
    const RGB rho = reflectance_(x);
    const double sin_light = std::hypot(w_light.x, w_light.y);
    const double sin_eye = std::hypot(w_eye.x, w_eye.y);
    // At the pole every azimuth is right: sines are factors of all that depends on it.
    const double sines = sin_light * sin_eye;
    const double cos_phi =
        sines > 0 ? std::clamp((w_light.x * w_eye.x + w_light.y * w_eye.y) / sines, -1.0, 1.0)
                  : 0.0;
    const double theta_light = std::atan2(sin_light, w_light.z);
    const double theta_eye = std::atan2(sin_eye, w_eye.z);
    const double a = std::max(theta_light, theta_eye), b = std::min(theta_light, theta_eye);
    return fast_ ? qualitative(rho, sigma2, a, b, cos_phi) : full(rho, sigma2, a, b, cos_phi);
  }

  RGB albedo(const SurfacePoint& x) const override { return reflectance_(x); }
  const char* name() const override { return "roughdiffuse"; }

 private:
  /// Sec. 4.4: a the larger polar angle, b the smaller.
  static RGB qualitative(const RGB& rho, double sigma2, double a, double b, double cos_phi) {
    const double A = 1 - 0.5 * sigma2 / (sigma2 + 0.33), B = 0.45 * sigma2 / (sigma2 + 0.09);
    return rho * kInvPi * (A + B * std::max(cos_phi, 0.0) * std::sin(a) * std::tan(b));
  }
  /// Eq. 27 to 29, reflections between facets included.
  static RGB full(const RGB& rho, double sigma2, double a, double b, double cos_phi) {
    const double C1 = 1 - 0.5 * sigma2 / (sigma2 + 0.33);
    const double turned = cos_phi >= 0 ? 0.0 : std::pow(2 * b * kInvPi, 3);
    const double C2 = 0.45 * sigma2 / (sigma2 + 0.09) * (std::sin(a) - turned);
    const double C3 = 0.125 * sigma2 / (sigma2 + 0.09) * sqr(4 * a * b * kInvPi * kInvPi);
    const double once =
        C1 + cos_phi * C2 * std::tan(b) + (1 - std::abs(cos_phi)) * C3 * std::tan((a + b) / 2);
    const double twice = 0.17 * sigma2 / (sigma2 + 0.13) * (1 - cos_phi * sqr(2 * b * kInvPi));
    return rho * kInvPi * (RGB(once) + twice * rho);
  }

  Textured<RGB> reflectance_;
  Textured<double> alpha_;
  bool fast_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_rough_diffuse(const Textured<RGB>& reflectance,
                                               const Textured<double>& alpha,
                                               bool fast_approximation) {
  return std::make_shared<RoughDiffuse>(reflectance, alpha, fast_approximation);
}

}  // namespace fogbow
