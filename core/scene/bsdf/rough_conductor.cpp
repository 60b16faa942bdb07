// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/microfacet.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class RoughConductor final : public ReflectingBsdf {
 public:
  RoughConductor(const RoughnessSettings& roughness, const RGB& eta, const RGB& k,
                 const RGB& reflectance)
      : facets_(roughness), index_(eta, k), tint_(checked_reflectance(reflectance)) {}

  bool has_smooth() const override { return true; }
  double roughness() const override { return facets_.roughness(); }

  RGB f_s(const SurfacePoint&, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    const Vec3 h = normalize(w_light + w_eye);
    const double value =
        facets_.D(h) * facets_.G1(w_light) * facets_.G1(w_eye) / (4 * w_light.z * w_eye.z);
    return value * tint_ * fresnel_conductor(dot(w_light, h), index_);
  }
  double pdf_sigma(const SurfacePoint&, const Vec3& from, const Vec3& to) const override {
    if (!(from.z > 0 && to.z > 0)) return 0;
    return reflected_pdf(from, normalize(from + to));
  }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& from,
                                   const Vec3& u) const override {
    if (!(from.z > 0)) return std::nullopt;
    const Vec3 h = facets_.sample_visible(from, {u.y, u.z});
    const Vec3 to = 2 * dot(from, h) * h - from;
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, reflected_pdf(from, normalize(from + to))};
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (dirac || !(pdf_sigma(x, from, to) > 0)) return std::nullopt;
    const Vec2 u = facets_.invert_visible(from, normalize(from + to));
    return Vec3(auxiliary.x, u.x, u.y);
  }

  RGB albedo(const SurfacePoint&) const override { return tint_ * fresnel_conductor(1, index_); }
  const char* name() const override { return "roughconductor"; }

 private:
  /// Visible normals times dσ(h)/dσ(to) = 1/(4 from·h); the cosine cancels.
  double reflected_pdf(const Vec3& from, const Vec3& h) const {
    return facets_.D(h) * facets_.G1(from) / (4 * from.z);
  }

  MicrofacetDistribution facets_;
  ComplexIndex index_;
  RGB tint_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_rough_conductor(const RoughnessSettings& roughness, const RGB& eta,
                                                 const RGB& k, const RGB& specular_reflectance) {
  return std::make_shared<RoughConductor>(roughness, eta, k, specular_reflectance);
}

}  // namespace fogbow
