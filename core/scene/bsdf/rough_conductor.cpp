// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/microfacet.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class RoughConductor final : public ReflectingBsdf {
 public:
  RoughConductor(const RoughnessSettings& roughness, const Textured<RGB>& eta,
                 const Textured<RGB>& k, const Textured<RGB>& reflectance)
      : facets_(roughness), index_(eta, k), tint_(checked_reflectance(reflectance)) {}

  bool has_smooth() const override { return true; }
  double roughness() const override { return facets_.roughness(); }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    const Vec3 h = normalize(w_light + w_eye);
    const MicrofacetDistribution facets = facets_(x);
    const double value =
        facets.D(h) * facets.G1(w_light) * facets.G1(w_eye) / (4 * w_light.z * w_eye.z);
    return value * tint_(x) * index_.reflectance(x, dot(w_light, h));
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    if (!(from.z > 0 && to.z > 0)) return 0;
    return reflected_pdf(facets_(x), from, normalize(from + to));
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    if (!(from.z > 0)) return std::nullopt;
    const MicrofacetDistribution facets = facets_(x);
    const Vec3 h = facets.sample_visible(from, {u.y, u.z});
    const Vec3 to = 2 * dot(from, h) * h - from;
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, reflected_pdf(facets, from, normalize(from + to))};
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (dirac || !(pdf_sigma(x, from, to) > 0)) return std::nullopt;
    const Vec2 u = facets_(x).invert_visible(from, normalize(from + to));
    return Vec3(auxiliary.x, u.x, u.y);
  }

  RGB albedo(const SurfacePoint& x) const override { return tint_(x) * index_.reflectance(x, 1); }
  const char* name() const override { return "roughconductor"; }

 private:
  /// Visible normals times dσ(h)/dσ(to) = 1/(4 from·h); the cosine cancels.
  static double reflected_pdf(const MicrofacetDistribution& facets, const Vec3& from,
                              const Vec3& h) {
    return facets.D(h) * facets.G1(from) / (4 * from.z);
  }

  TexturedFacets facets_;
  ComplexIndex index_;
  Textured<RGB> tint_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_rough_conductor(const RoughnessSettings& roughness,
                                                 const Textured<RGB>& eta, const Textured<RGB>& k,
                                                 const Textured<RGB>& specular_reflectance) {
  return std::make_shared<RoughConductor>(roughness, eta, k, specular_reflectance);
}

}  // namespace fogbow
