// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/lobes.h"
#include "core/scene/bsdf/microfacet.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

constexpr int kEntries = 64;

/// Mean of value(w, h) over the normals h visible from cosθ = μ, by the midpoint rule on rows ×
/// rows of them; w looks at the interface from there.
template <class Value>
double mean_over_visible(const MicrofacetDistribution& facets, double mu, int rows, Value&& value) {
  const Vec3 w(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < rows; ++j)
      sum += value(w, facets.sample_visible(w, {(i + 0.5) / rows, (j + 0.5) / rows}));
  return sum / (rows * rows);
}

/// What a rough interface reflects of light that comes from there; what is masked on the way out is
/// lost.
double rough_reflectance(const MicrofacetDistribution& facets, double mu, double eta) {
  return mean_over_visible(facets, mu, 12, [&](const Vec3& w, const Vec3& h) {
    const Vec3 out = 2 * dot(w, h) * h - w;
    return out.z > 0 ? facets.G1(out) * fresnel_dielectric(dot(w, h), eta).F : 0.0;
  });
}

/// The same for what gets through.
double rough_transmittance(const MicrofacetDistribution& facets, double mu, double eta) {
  return mean_over_visible(facets, mu, 64, [&](const Vec3& w, const Vec3& h) {
    const double c = dot(w, h);
    const Refraction r = fresnel_dielectric(c, eta);
    const Vec3 out = (c / eta - r.cos_t) * h - w / eta;
    return r.T > 0 && out.z < 0 ? facets.G1(out) * r.T : 0.0;
  });
}

/// A diffuse base under a rough dielectric coat. Light that enters or leaves is dimmed by the
/// coat's directional transmittance, and what is reflected back by its hemispherical one, from
/// tables.
class RoughPlastic final : public ReflectingBsdf {
 public:
  RoughPlastic(const RoughnessSettings& roughness, double eta, bool nonlinear,
               const Textured<RGB>& diffuse, const Textured<RGB>& specular)
      : facets_(roughness.kind, roughness.alpha_u.mean(), roughness.alpha_v.mean()),
        eta_(checked_coat_index(eta)),
        nonlinear_(nonlinear),
        diffuse_(checked_reflectance(diffuse)),
        specular_(checked_reflectance(specular)) {
    if (!roughness.alpha_u.constant() || roughness.alpha_u.mean() != roughness.alpha_v.mean())
      throw std::domain_error("the roughness of roughplastic must be one number");
    internal_ = 0;
    for (int i = 0; i < kEntries; ++i)
      transmittance_[i] = rough_transmittance(facets_, node(i), eta_);
    constexpr int kAngles = 512;  // total reflection sets in steeply
    for (int i = 0; i < kAngles; ++i) {
      const double mu = (i + 0.5) / kAngles;
      internal_ += 2 * mu * rough_reflectance(facets_, mu, 1 / eta_) / kAngles;
    }
  }

  bool has_smooth() const override { return true; }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    const Vec3 h = normalize(w_light + w_eye);
    const double DG =
        facets_.D(h) * facets_.G1(w_light) * facets_.G1(w_eye) / (4 * w_light.z * w_eye.z);
    const double T = transmittance(w_light.z) * transmittance(w_eye.z);
    return specular_(x) * (DG * fresnel_dielectric(dot(w_light, h), eta_).F) +
           T * coated_base(diffuse_(x), nonlinear_, internal_, eta_);
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    if (!(from.z > 0 && to.z > 0)) return 0;
    const auto lobes = weighted(x, from, to);
    return lobes.total() / choice(x, from).total();
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    if (!(from.z > 0)) return std::nullopt;
    const LobeChoice<2> lobes = choice(x, from);
    if (!(lobes.total() > 0)) return std::nullopt;
    double u_lobe = u.x;
    Vec3 to;
    if (lobes.choose(u_lobe) == 0) {
      const Vec3 h = facets_.sample_visible(from, {u.y, u.z});
      to = 2 * dot(from, h) * h - from;
    } else {
      to = warp::sample_cosine_hemisphere({u.y, u.z});
    }
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, pdf_sigma(x, from, to)};
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (dirac || !(from.z > 0 && to.z > 0)) return std::nullopt;
    const auto posterior = weighted(x, from, to);
    if (!(posterior.total() > 0)) return std::nullopt;
    double within = auxiliary.x;
    const std::size_t lobe = posterior.choose(within);
    const Vec2 u = lobe == 0 ? facets_.invert_visible(from, normalize(from + to))
                             : warp::invert_cosine_hemisphere(to);
    return Vec3(choice(x, from).place(lobe, within), u.x, u.y);
  }

  RGB albedo(const SurfacePoint& x) const override { return diffuse_(x); }
  const char* name() const override { return "roughplastic"; }

 private:
  /// Cosines of the table: none is 0, where no facet can be seen.
  static double node(int i) { return std::max<double>(i, 1e-3) / (kEntries - 1); }
  double transmittance(double mu) const {
    const double at = mu * (kEntries - 1);
    const int i = std::min(static_cast<int>(at), kEntries - 2);
    return transmittance_[i] + (at - i) * (transmittance_[i + 1] - transmittance_[i]);
  }
  /// Specular and diffuse, as Mitsuba 3 weighs them.
  LobeChoice<2> choice(const SurfacePoint& x, const Vec3& from) const {
    const double T = transmittance(from.z);
    return {{(1 - T) * mean(specular_(x)), T * mean(diffuse_(x))}};
  }
  /// The weights times the densities of `to`.
  LobeChoice<2> weighted(const SurfacePoint& x, const Vec3& from, const Vec3& to) const {
    LobeChoice<2> lobes = choice(x, from);
    const Vec3 h = normalize(from + to);
    lobes.weights[0] *= facets_.D(h) * facets_.G1(from) / (4 * from.z);
    lobes.weights[1] *= warp::pdf_cosine_hemisphere(to);
    return lobes;
  }

  MicrofacetDistribution facets_;
  double eta_;
  bool nonlinear_;
  Textured<RGB> diffuse_, specular_;
  double internal_;
  std::array<double, kEntries> transmittance_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_rough_plastic(const RoughnessSettings& roughness, double eta,
                                               bool nonlinear, const Textured<RGB>& diffuse,
                                               const Textured<RGB>& specular) {
  return std::make_shared<RoughPlastic>(roughness, eta, nonlinear, diffuse, specular);
}

}  // namespace fogbow
