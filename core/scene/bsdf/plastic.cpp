// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/lobes.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// A diffuse base under a smooth dielectric coat, with all reflections between the two.
class Plastic final : public ReflectingBsdf {
 public:
  Plastic(double eta, bool nonlinear, const Textured<RGB>& diffuse, const Textured<RGB>& specular)
      : eta_(checked_coat_index(eta)),
        nonlinear_(nonlinear),
        diffuse_(checked_reflectance(diffuse)),
        specular_(checked_reflectance(specular)),
        internal_(diffuse_fresnel(1 / eta)) {}

  bool has_smooth() const override { return true; }
  bool has_dirac() const override { return true; }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    const double T = transmittance(w_light) * transmittance(w_eye);
    return T * coated_base(diffuse_(x), nonlinear_, internal_, eta_);
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    if (!(from.z > 0 && to.z > 0)) return 0;
    return choice(x, from).probability(1) * warp::pdf_cosine_hemisphere(to);
  }
  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    return specular_(x) * fresnel_dielectric(w_light.z, eta_).F;
  }
  double pdf_dirac(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    if (!(from.z > 0 && to.z > 0)) return 0;
    return choice(x, from).probability(0) * to.z;
  }

  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    if (!(from.z > 0)) return std::nullopt;
    const LobeChoice<2> lobes = choice(x, from);
    if (!(lobes.total() > 0)) return std::nullopt;
    double u_lobe = u.x;
    if (lobes.choose(u_lobe) == 0)
      return BsdfSample{reflect_z(from), true, lobes.probability(0) * from.z};
    const Vec3 to = warp::sample_cosine_hemisphere({u.y, u.z});
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, pdf_sigma(x, from, to)};
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (!(from.z > 0 && to.z > 0)) return std::nullopt;
    const LobeChoice<2> lobes = choice(x, from);
    if (!(lobes.weights[dirac ? 0 : 1] > 0)) return std::nullopt;
    if (dirac) return Vec3(lobes.place(0, auxiliary.x), auxiliary.y, auxiliary.z);
    const Vec2 u = warp::invert_cosine_hemisphere(to);
    return Vec3(lobes.place(1, auxiliary.x), u.x, u.y);
  }

  RGB albedo(const SurfacePoint& x) const override { return diffuse_(x); }
  const char* name() const override { return "plastic"; }

 private:
  double transmittance(const Vec3& w) const { return fresnel_dielectric(w.z, eta_).T; }
  /// Specular and diffuse, as Mitsuba 3 weighs them.
  LobeChoice<2> choice(const SurfacePoint& x, const Vec3& from) const {
    const Refraction r = fresnel_dielectric(from.z, eta_);
    return {{r.F * mean(specular_(x)), r.T * mean(diffuse_(x))}};
  }

  double eta_;
  bool nonlinear_;
  Textured<RGB> diffuse_, specular_;
  double internal_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_plastic(double eta, bool nonlinear, const Textured<RGB>& diffuse,
                                         const Textured<RGB>& specular) {
  return std::make_shared<Plastic>(eta, nonlinear, diffuse, specular);
}

}  // namespace fogbow
