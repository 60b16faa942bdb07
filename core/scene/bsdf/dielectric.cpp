// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/warp.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class Dielectric final : public Bsdf {
 public:
  Dielectric(double eta, const RGB& reflectance, const RGB& transmittance)
      : eta_(eta),
        reflectance_(checked_reflectance(reflectance)),
        transmittance_(checked_reflectance(transmittance)),
        mean_reflectance_(mean(reflectance)),
        mean_transmittance_(mean(transmittance)) {
    if (!(eta > 0 && std::isfinite(eta)))
      throw std::domain_error("a relative index of refraction must be positive and finite");
  }

  bool has_smooth() const override { return false; }
  bool has_dirac() const override { return true; }
  RGB f_s(const SurfacePoint&, const Vec3&, const Vec3&) const override { return RGB(0); }
  double pdf_sigma(const SurfacePoint&, const Vec3&, const Vec3&) const override { return 0; }

  RGB f_dirac(const SurfacePoint&, const Vec3& w_light, const Vec3& w_eye) const override {
    const double F = refraction(w_light).F;
    const RGB C = w_light.z * w_eye.z > 0 ? F * reflectance_ : (1 - F) * transmittance_;
    return C * sqr(n(w_eye));
  }
  double pdf_dirac(const SurfacePoint&, const Vec3& from, const Vec3& to) const override {
    const double F = refraction(from).F;
    return event_probability(F, from.z * to.z > 0) * sqr(n(to)) * std::fabs(to.z);
  }

  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& from,
                                   const Vec3& u) const override {
    if (from.z == 0) return std::nullopt;
    const auto [F, cos_t] = refraction(from);
    const double P = event_probability(F, true);
    if (u.x < P) return BsdfSample{reflect_z(from), true, P * sqr(n(from)) * std::fabs(from.z)};
    const double P_t = event_probability(F, false);
    if (!(P_t > 0)) return std::nullopt;
    const double scale = 1 / relative_eta(from);
    const Vec3 to(-scale * from.x, -scale * from.y, from.z > 0 ? -cos_t : cos_t);
    return BsdfSample{to, true, P_t * sqr(n(to)) * cos_t};
  }
  std::optional<Vec3> invert(const SurfacePoint&, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (!dirac) return std::nullopt;
    const bool reflects = from.z * to.z > 0;
    const double F = refraction(from).F;
    if (!(event_probability(F, reflects) > 0)) return std::nullopt;
    const double P = event_probability(F, true);
    const double u = reflects ? warp::invert_interval(0, P, auxiliary.x)
                              : warp::invert_interval(P, 1, auxiliary.x);
    return Vec3(u, auxiliary.y, auxiliary.z);
  }

  double eta() const override { return eta_; }
  RGB albedo(const SurfacePoint&) const override { return glm::max(reflectance_, transmittance_); }
  const char* name() const override { return "dielectric"; }

 private:
  /// Index on the side of w.
  double n(const Vec3& w) const { return w.z > 0 ? 1.0 : eta_; }
  double relative_eta(const Vec3& w) const { return w.z > 0 ? eta_ : 1 / eta_; }
  Refraction refraction(const Vec3& w) const {
    return fresnel_dielectric(std::fabs(w.z), relative_eta(w));
  }
  double event_probability(double F, bool reflects) const {
    const double P = reflection_probability(F, mean_reflectance_, mean_transmittance_);
    if (reflects) return P;
    return (1 - F) * mean_transmittance_ > 0 ? 1 - P : 0.0;
  }

  double eta_;
  RGB reflectance_, transmittance_;
  double mean_reflectance_, mean_transmittance_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_dielectric(double eta, const RGB& specular_reflectance,
                                            const RGB& specular_transmittance) {
  return std::make_shared<Dielectric>(eta, specular_reflectance, specular_transmittance);
}

}  // namespace fogbow
