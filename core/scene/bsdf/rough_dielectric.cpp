// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/microfacet.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// Refraction at rough interfaces (Walter et al. 2007).
class RoughDielectric final : public Bsdf {
 public:
  RoughDielectric(const RoughnessSettings& roughness, double eta, const Textured<RGB>& reflectance,
                  const Textured<RGB>& transmittance, double n_exterior)
      : roughness_(roughness),
        facets_(roughness),
        eta_(eta),
        n_exterior_(n_exterior),
        reflectance_(checked_reflectance(reflectance)),
        transmittance_(checked_reflectance(transmittance)),
        mean_reflectance_(mean(reflectance.mean())),
        mean_transmittance_(mean(transmittance.mean())),
        constant_(reflectance.constant() && transmittance.constant()) {
    if (!(eta > 0 && std::isfinite(eta) && eta != 1))
      throw std::domain_error(
          "the relative index of refraction of a rough dielectric must be positive, finite and "
          "not 1");
  }

  bool has_smooth() const override { return true; }

  RGB f_s(const SurfacePoint&, const Vec3& w_light, const Vec3& w_eye) const override;
  double pdf_sigma(const SurfacePoint&, const Vec3& from, const Vec3& to) const override;
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override;
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override;

  double eta() const override { return eta_; }
  double n_exterior() const override { return n_exterior_; }
  std::shared_ptr<const Bsdf> between(double n_interior, double n_exterior) const override {
    return make_rough_dielectric(roughness_, n_interior / n_exterior, reflectance_, transmittance_,
                                 n_exterior);
  }
  double roughness() const override { return facets_.roughness(); }
  RGB albedo(const SurfacePoint& x) const override {
    return glm::max(reflectance_(x), transmittance_(x));
  }
  const char* name() const override { return "roughdielectric"; }

 private:
  /// The microfacet that scatters a into b.
  struct Facet {
    Vec3 h;               ///< its normal, on the exterior side
    double cos_a, cos_b;  ///< |a·h|, |b·h|
    double length2;       ///< |n_a a + n_b b|², of refraction
    bool reflects;
    Refraction fresnel;
  };

  double n(const Vec3& w) const { return w.z > 0 ? 1.0 : eta_; }
  double relative_eta(const Vec3& w) const { return w.z > 0 ? eta_ : 1 / eta_; }
  std::optional<Facet> facet(const Vec3& a, const Vec3& b) const;
  EventProbabilities probabilities(const SurfacePoint& x, const Refraction& r) const {
    if (constant_) [[likely]]
      return event_probabilities(r, mean_reflectance_, mean_transmittance_);
    return event_probabilities(r, mean(reflectance_(x)), mean(transmittance_(x)));
  }

  RoughnessSettings roughness_;
  TexturedFacets facets_;
  double eta_, n_exterior_;
  Textured<RGB> reflectance_, transmittance_;
  double mean_reflectance_, mean_transmittance_;
  bool constant_;
};

std::optional<RoughDielectric::Facet> RoughDielectric::facet(const Vec3& a, const Vec3& b) const {
  if (a.z == 0 || b.z == 0) return std::nullopt;
  const bool reflects = a.z * b.z > 0;
  const Vec3 sum = reflects ? a + b : n(a) * a + n(b) * b;
  const double length2 = dot(sum, sum);
  if (!(length2 > 0) || sum.z == 0) return std::nullopt;
  const Vec3 h = sum * (std::copysign(1.0, sum.z) / std::sqrt(length2));
  // Each direction must see the facet from the side that it sees the surface from.
  const double cos_a = a.z > 0 ? dot(a, h) : -dot(a, h), cos_b = b.z > 0 ? dot(b, h) : -dot(b, h);
  if (!(cos_a > 0 && cos_b > 0)) return std::nullopt;
  const double eta = relative_eta(a);
  return Facet{
      h,        cos_a,
      cos_b,    length2,
      reflects, reflects ? fresnel_dielectric(cos_a, eta) : fresnel_of_pair(cos_a, cos_b, eta)};
}

RGB RoughDielectric::f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const {
  const auto m = facet(w_light, w_eye);
  if (!m) return RGB(0);
  const MicrofacetDistribution facets = facets_(x);
  const double DG =
      facets.D(m->h) * facets.G1(w_light) * facets.G1(w_eye) / std::fabs(w_light.z * w_eye.z);
  if (m->reflects) return reflectance_(x) * (m->fresnel.F * DG * 0.25);  // eq. 20
  return transmittance_(x) *
         (m->fresnel.T * DG * m->cos_a * m->cos_b * sqr(n(w_eye)) / m->length2);  // eq. 21
}

double RoughDielectric::pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const {
  const auto m = facet(from, to);
  if (!m) return 0;
  const MicrofacetDistribution facets = facets_(x);
  const double visible = facets.D(m->h) * facets.G1(from) / std::fabs(from.z);  // over cos_a
  const double jacobian = m->reflects ? 0.25 : m->cos_a * m->cos_b * sqr(n(to)) / m->length2;
  const auto [reflection, transmission] = probabilities(x, m->fresnel);
  return (m->reflects ? reflection : transmission) * visible * jacobian;
}

std::optional<BsdfSample> RoughDielectric::sample(const SurfacePoint& x, const Vec3& from,
                                                  const Vec3& u) const {
  if (from.z == 0) return std::nullopt;
  // From below, facets look as from above through a reflection at the origin.
  const double side = from.z > 0 ? 1.0 : -1.0;
  const Vec3 h = side * facets_(x).sample_visible(side * from, {u.y, u.z});
  const double cos_from = dot(from, h);
  const double eta = relative_eta(from);
  const Refraction r = fresnel_dielectric(cos_from, eta);
  const bool reflects = u.x < probabilities(x, r).reflection;
  const Vec3 to = reflects ? 2 * cos_from * h - from : (cos_from / eta - r.cos_t) * h - from / eta;
  if ((to.z * from.z > 0) != reflects) return std::nullopt;
  const double pdf = pdf_sigma(x, from, to);
  if (!(pdf > 0)) return std::nullopt;
  return BsdfSample{to, false, pdf};
}

std::optional<Vec3> RoughDielectric::invert(const SurfacePoint& x, const Vec3& from, const Vec3& to,
                                            bool dirac, const Vec3& auxiliary) const {
  if (dirac || !(pdf_sigma(x, from, to) > 0)) return std::nullopt;
  const auto m = facet(from, to);
  const auto event = invert_event(probabilities(x, m->fresnel), m->reflects, auxiliary.x);
  if (!event) return std::nullopt;
  const double side = from.z > 0 ? 1.0 : -1.0;
  const Vec2 u = facets_(x).invert_visible(side * from, m->h);
  return Vec3(*event, u.x, u.y);
}

}  // namespace

std::shared_ptr<const Bsdf> make_rough_dielectric(const RoughnessSettings& roughness, double eta,
                                                  const Textured<RGB>& specular_reflectance,
                                                  const Textured<RGB>& specular_transmittance,
                                                  double n_exterior) {
  return std::make_shared<RoughDielectric>(roughness, eta, specular_reflectance,
                                           specular_transmittance, n_exterior);
}

}  // namespace fogbow
