// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class Dielectric final : public Bsdf {
 public:
  Dielectric(double eta, const Textured<RGB>& reflectance, const Textured<RGB>& transmittance,
             double n_exterior)
      : eta_(eta),
        n_exterior_(n_exterior),
        reflectance_(checked_reflectance(reflectance)),
        transmittance_(checked_reflectance(transmittance)),
        mean_reflectance_(mean(reflectance.mean())),
        mean_transmittance_(mean(transmittance.mean())),
        constant_(reflectance.constant() && transmittance.constant()) {
    if (!(eta > 0 && std::isfinite(eta)))
      throw std::domain_error("a relative index of refraction must be positive and finite");
  }

  bool has_smooth() const override { return false; }
  bool has_dirac() const override { return true; }
  RGB f_s(const SurfacePoint&, const Vec3&, const Vec3&) const override { return RGB(0); }
  double pdf_sigma(const SurfacePoint&, const Vec3&, const Vec3&) const override { return 0; }

  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    const Refraction r = refraction(w_light, w_eye);
    const RGB C = w_light.z * w_eye.z > 0 ? r.F * reflectance_(x) : r.T * transmittance_(x);
    return C * sqr(n(w_eye));
  }
  double pdf_dirac(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    const auto [reflection, transmission] = probabilities(x, refraction(from, to));
    const double P = from.z * to.z > 0 ? reflection : transmission;
    return P * sqr(n(to)) * std::fabs(to.z);
  }

  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    if (from.z == 0) return std::nullopt;
    const Refraction r = refraction(from);
    const auto [reflection, transmission] = probabilities(x, r);
    if (u.x < reflection) return answer(x, from, reflect_z(from));
    if (!(transmission > 0)) return std::nullopt;
    const double scale = 1 / relative_eta(from);
    const Vec3 to(-scale * from.x, -scale * from.y, from.z > 0 ? -r.cos_t : r.cos_t);
    return answer(x, from, to);
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (!dirac) return std::nullopt;
    const auto u = invert_event(probabilities(x, refraction(from)), from.z * to.z > 0, auxiliary.x);
    if (!u) return std::nullopt;
    return Vec3(*u, auxiliary.y, auxiliary.z);
  }

  double eta() const override { return eta_; }
  double n_exterior() const override { return n_exterior_; }
  std::shared_ptr<const Bsdf> between(double n_interior, double n_exterior) const override {
    return make_dielectric(n_interior / n_exterior, reflectance_, transmittance_, n_exterior);
  }
  RGB albedo(const SurfacePoint& x) const override {
    return glm::max(reflectance_(x), transmittance_(x));
  }
  const char* name() const override { return "dielectric"; }

 private:
  /// Index on the side of w.
  double n(const Vec3& w) const { return w.z > 0 ? 1.0 : eta_; }
  double relative_eta(const Vec3& w) const { return w.z > 0 ? eta_ : 1 / eta_; }
  Refraction refraction(const Vec3& w) const {
    return fresnel_dielectric(std::fabs(w.z), relative_eta(w));
  }
  /// Of the interface between two directions that it joins.
  Refraction refraction(const Vec3& a, const Vec3& b) const {
    if (a.z * b.z > 0) return refraction(a);
    return fresnel_of_pair(std::fabs(a.z), std::fabs(b.z), relative_eta(a));
  }
  BsdfSample answer(const SurfacePoint& x, const Vec3& from, const Vec3& to) const {
    return {to, true, pdf_dirac(x, from, to)};
  }
  EventProbabilities probabilities(const SurfacePoint& x, const Refraction& r) const {
    if (constant_) [[likely]]
      return event_probabilities(r, mean_reflectance_, mean_transmittance_);
    return event_probabilities(r, mean(reflectance_(x)), mean(transmittance_(x)));
  }

  double eta_, n_exterior_;
  Textured<RGB> reflectance_, transmittance_;
  double mean_reflectance_, mean_transmittance_;
  bool constant_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_dielectric(double eta, const Textured<RGB>& specular_reflectance,
                                            const Textured<RGB>& specular_transmittance,
                                            double n_exterior) {
  return std::make_shared<Dielectric>(eta, specular_reflectance, specular_transmittance,
                                      n_exterior);
}

}  // namespace fogbow
