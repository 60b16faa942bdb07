// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/lobes.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// Phong's lobe made symmetric and bounded in energy.
class Phong final : public ReflectingBsdf {
 public:
  Phong(const Textured<double>& exponent, const Textured<RGB>& diffuse,
        const Textured<RGB>& specular)
      : exponent_(exponent),
        diffuse_(checked_reflectance(diffuse)),
        specular_(checked_reflectance(specular)) {
    if (const auto range = exponent.range(); !(range.least >= 0 && std::isfinite(range.greatest)))
      throw std::domain_error("the exponent of phong must be finite and not negative");
    // As in Mitsuba 0.6: no more light comes out than in.
    const double most = diffuse.range().greatest + specular.range().greatest;
    if (most > 1) scale_ = 1 / most;
  }

  bool has_smooth() const override { return true; }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    if (!(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
    const double n = exponent_(x);
    const double lobe = (n + 2) / (2 * kPi) * power(w_light, w_eye, n);
    return scale_ * (diffuse_(x) * kInvPi + specular_(x) * lobe);
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    if (!(from.z > 0 && to.z > 0)) return 0;
    const LobeChoice<2> lobes = choice(x);
    return lobes.total() > 0 ? weighted(x, from, to).total() / lobes.total() : 0.0;
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    const LobeChoice<2> lobes = choice(x);
    if (!(from.z > 0 && lobes.total() > 0)) return std::nullopt;
    double u_lobe = u.x;
    Vec3 to;
    if (lobes.choose(u_lobe) == 1) {
      to = warp::sample_cosine_hemisphere({u.y, u.z});
    } else {
      // cosα = (1 − u)^{1/(n+1)}
      const double d = -std::expm1(std::log1p(-u.y) / (exponent_(x) + 1));
      to = Frame(reflect_z(from)).to_world(warp::spherical_direction(d, u.z));
    }
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, pdf_sigma(x, from, to)};
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (dirac || !(pdf_sigma(x, from, to) > 0)) return std::nullopt;
    double within = auxiliary.x;
    const std::size_t lobe = weighted(x, from, to).choose(within);
    const double u_lobe = choice(x).place(lobe, within);
    if (lobe == 1) {
      const Vec2 u = warp::invert_cosine_hemisphere(to);
      return Vec3(u_lobe, u.x, u.y);
    }
    const Vec3 local = Frame(reflect_z(from)).to_local(to);
    const double log_cos = std::log1p(-warp::one_minus_cos(local));
    return Vec3(u_lobe, warp::clamp_unit(-std::expm1((exponent_(x) + 1) * log_cos)),
                warp::invert_azimuth(local.x, local.y));
  }

  RGB albedo(const SurfacePoint& x) const override { return diffuse_(x) + specular_(x); }
  const char* name() const override { return "phong"; }

 private:
  /// cosⁿ of the angle to the mirror image.
  static double power(const Vec3& from, const Vec3& to, double n) {
    const double c = dot(reflect_z(from), to);
    return c > 0 ? std::pow(c, n) : 0.0;
  }
  LobeChoice<2> choice(const SurfacePoint& x) const {
    return {{mean(specular_(x)), mean(diffuse_(x))}};
  }
  /// The weights times the densities of `to`.
  LobeChoice<2> weighted(const SurfacePoint& x, const Vec3& from, const Vec3& to) const {
    const double n = exponent_(x);
    LobeChoice<2> lobes = choice(x);
    lobes.weights[0] *= (n + 1) / (2 * kPi) * power(from, to, n);
    lobes.weights[1] *= warp::pdf_cosine_hemisphere(to);
    return lobes;
  }

  Textured<double> exponent_;
  Textured<RGB> diffuse_, specular_;
  double scale_ = 1;
};

}  // namespace

std::shared_ptr<const Bsdf> make_phong(const Textured<double>& exponent,
                                       const Textured<RGB>& diffuse_reflectance,
                                       const Textured<RGB>& specular_reflectance) {
  return std::make_shared<Phong>(exponent, diffuse_reflectance, specular_reflectance);
}

}  // namespace fogbow
