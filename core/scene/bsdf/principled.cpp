// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <utility>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/fresnel.h"
#include "core/scene/bsdf/lobes.h"
#include "core/scene/bsdf/microfacet.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

double mix(double a, double b, double t) { return a + t * (b - a); }

/// (1 − c)⁵ of Schlick's approximation.
double schlick(double c) {
  const double m = std::clamp(1 - c, 0.0, 1.0);
  return sqr(sqr(m)) * m;
}

/// Generalized Trowbridge–Reitz with exponent 1 [Burley2012, app. B], isotropic.
struct Clearcoat {
  double alpha2;

  explicit Clearcoat(double gloss) : alpha2(sqr(mix(0.1, 0.001, gloss))) {}
  double D(const Vec3& h) const {
    return (alpha2 - 1) / (kPi * std::log(alpha2) * (1 + (alpha2 - 1) * sqr(h.z)));
  }
  Vec3 sample(double u, double v) const {
    const double cos2 = (1 - std::pow(alpha2, 1 - u)) / (1 - alpha2);
    const double sin_theta = std::sqrt(std::max(1 - cos2, 0.0)), phi = 2 * kPi * v;
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), std::sqrt(cos2)};
  }
  Vec2 invert(const Vec3& h) const {
    // 1 − (1 − α²) cos² = sin² + α² cos², without cancellation.
    const double rest = h.x * h.x + h.y * h.y + alpha2 * sqr(h.z);
    return {warp::clamp_unit(1 - std::log(rest) / std::log(alpha2)),
            warp::invert_azimuth(h.x, h.y)};
  }
  /// Smith's masking of GGX with α = 0.25, whatever the gloss.
  static double G1(const Vec3& w) {
    constexpr double a2 = 0.25 * 0.25;
    return 2 * w.z / (w.z + std::sqrt(a2 + (1 - a2) * sqr(w.z)));
  }
};

/// [Burley2012] with the transmission of [Burley2015], as Mitsuba 3.9.1 has it; Base says whether
/// it only reflects. Lobes are chosen by Fresnel's reflectance at the shading normal, which leaves
/// all densities exact.
template <class Base>
class Principled final : public Base {
 public:
  Principled(const PrincipledSettings& settings, bool transmits)
      : s_(settings), transmits_(transmits) {}

  bool has_smooth() const override { return true; }
  double eta() const override { return transmits_ ? s_.eta : 1.0; }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override;
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    const At at(*this, x, from);
    if (from.z == 0 || to.z == 0) return 0;
    return at.weighted(from, to).total() / at.lobes.total();
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override;
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override;

  RGB albedo(const SurfacePoint& x) const override { return s_.base_color(x); }
  const char* name() const override { return "principled"; }

 private:
  enum Lobe : std::size_t { kDiffuse, kSpecular, kCoat, kTransmission };

  /// The parameters of one point, and the choice of lobes for what comes from a direction.
  struct At {
    At(const Principled& p, const SurfacePoint& x, const Vec3& from);
    /// The weights times the densities of `to`.
    LobeChoice<4> weighted(const Vec3& from, const Vec3& to) const;
    /// The facet that refracts a into b, on the exterior side; zero where there is none.
    Vec3 refracting(const Vec3& a, const Vec3& b) const;
    double n(const Vec3& w) const { return w.z > 0 ? 1.0 : eta; }
    double relative_eta(const Vec3& w) const { return w.z > 0 ? eta : 1 / eta; }

    double eta, metallic, reflecting, transmitting;
    MicrofacetDistribution facets;
    Clearcoat coat;
    double coat_amount;
    LobeChoice<4> lobes;
  };

  RGB reflected_fresnel(const SurfacePoint& x, const At& at, double F, double cos_h) const;
  RGB diffuse(const SurfacePoint& x, const At& at, const Vec3& a, const Vec3& b) const;
  static MicrofacetDistribution facets(const PrincipledSettings& s, const SurfacePoint& x) {
    const double rough2 = sqr(s.roughness(x)), aspect = std::sqrt(1 - 0.9 * s.anisotropic(x));
    return {MicrofacetKind::Ggx, std::max(0.001, rough2 / aspect), std::max(0.001, rough2 * aspect),
            x};
  }

  PrincipledSettings s_;
  bool transmits_;
};

template <class Base>
Principled<Base>::At::At(const Principled& p, const SurfacePoint& x, const Vec3& from)
    : eta(p.s_.eta),
      metallic(p.s_.metallic(x)),
      facets(Principled::facets(p.s_, x)),
      coat(p.s_.clearcoat_gloss(x)),
      coat_amount(p.s_.clearcoat(x)) {
  const double spec_trans = p.transmits_ ? p.s_.spec_trans(x) : 0.0;
  reflecting = (1 - metallic) * (1 - spec_trans);
  transmitting = (1 - metallic) * spec_trans;
  const double F = fresnel_dielectric(std::fabs(from.z), relative_eta(from)).F;
  // From inside only the interface is there.
  const bool outside = from.z > 0;
  lobes.weights = {outside ? reflecting : 0.0,
                   outside ? 1 - transmitting * (1 - F) : (p.transmits_ ? std::max(F, 0.05) : 0.0),
                   outside ? 0.25 * coat_amount : 0.0,
                   outside ? transmitting * (1 - F) : (transmitting > 0 ? 1 - F : 0.0)};
}

template <class Base>
Vec3 Principled<Base>::At::refracting(const Vec3& a, const Vec3& b) const {
  const Vec3 sum = n(a) * a + n(b) * b;
  const double length2 = dot(sum, sum);
  if (!(length2 > 0) || sum.z == 0) return Vec3(0);
  const Vec3 h = sum * (std::copysign(1.0, sum.z) / std::sqrt(length2));
  return dot(a, h) * a.z > 0 && dot(b, h) * b.z > 0 ? h : Vec3(0);
}

template <class Base>
LobeChoice<4> Principled<Base>::At::weighted(const Vec3& from, const Vec3& to) const {
  LobeChoice<4> w = lobes;
  const double visible = facets.G1(from) / std::fabs(from.z);
  if (from.z * to.z > 0) {
    const Vec3 h = normalize(from + to);
    const Vec3 up = h.z < 0 ? -h : h;
    w.weights[kDiffuse] *= warp::pdf_cosine_hemisphere(to);
    w.weights[kSpecular] *= facets.D(up) * visible / 4;
    w.weights[kCoat] *= coat.D(up) * up.z / (4 * std::fabs(dot(from, up)));
    w.weights[kTransmission] = 0;
    return w;
  }
  w.weights[kDiffuse] = w.weights[kSpecular] = w.weights[kCoat] = 0;
  const Vec3 h = refracting(from, to);
  if (is_black(h)) {
    w.weights[kTransmission] = 0;
    return w;
  }
  const Vec3 sum = n(from) * from + n(to) * to;
  w.weights[kTransmission] *=
      facets.D(h) * visible * std::fabs(dot(from, h) * dot(to, h)) * sqr(n(to)) / dot(sum, sum);
  return w;
}

/// Metal by Schlick, a dielectric with a tint at normal incidence, and one without.
template <class Base>
RGB Principled<Base>::reflected_fresnel(const SurfacePoint& x, const At& at, double F,
                                        double cos_h) const {
  const double tint = s_.spec_tint(x), s = schlick(cos_h);
  RGB result = (1 - at.metallic) * (1 - tint) * F * RGB(1);
  const auto between = [&](const RGB& R0) { return R0 + s * (RGB(1) - R0); };
  const RGB color = s_.base_color(x);
  if (at.metallic > 0) result += at.metallic * between(color);
  if (tint > 0) {
    const double lum = luminance(color), R0 = sqr((at.eta - 1) / (at.eta + 1));
    result += (1 - at.metallic) * tint * between(R0 * (lum > 0 ? color / lum : RGB(1)));
  }
  return result;
}

/// Diffuse with retroreflection or its flat form, and sheen.
template <class Base>
RGB Principled<Base>::diffuse(const SurfacePoint& x, const At& at, const Vec3& a,
                              const Vec3& b) const {
  const Vec3 h = normalize(a + b);
  const double cos_d = dot(a, h), Fa = schlick(a.z), Fb = schlick(b.z);
  const double retro = 2 * s_.roughness(x) * sqr(cos_d);
  const double burley = (1 - 0.5 * Fa) * (1 - 0.5 * Fb) + retro * (Fa + Fb + Fa * Fb * (retro - 1));
  const double flat = s_.flatness(x);
  double shape = burley;
  if (flat > 0) {
    const double Fss = mix(1, retro / 2, Fa) * mix(1, retro / 2, Fb);
    shape = mix(burley, 1.25 * (Fss * (1 / (a.z + b.z) - 0.5) + 0.5), flat);
  }
  const RGB color = s_.base_color(x);
  RGB result = at.reflecting * shape * kInvPi * color;
  if (const double sheen = s_.sheen(x); sheen > 0) {
    const double lum = luminance(color);
    const RGB tint = lum > 0 ? color / lum : RGB(1);
    const RGB c = RGB(1) + s_.sheen_tint(x) * (tint - RGB(1));
    result += sheen * (1 - at.metallic) * schlick(cos_d) * c;
  }
  return result;
}

template <class Base>
RGB Principled<Base>::f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const {
  if (w_light.z == 0 || w_eye.z == 0) return RGB(0);
  if (!transmits_ && !(w_light.z > 0 && w_eye.z > 0)) return RGB(0);
  const At at(*this, x, w_eye);
  const double masked =
      at.facets.G1(w_light) * at.facets.G1(w_eye) / std::fabs(w_light.z * w_eye.z);
  if (w_light.z * w_eye.z < 0) {
    const Vec3 h = at.refracting(w_light, w_eye);
    if (is_black(h)) return RGB(0);
    const double c_light = std::fabs(dot(w_light, h)), c_eye = std::fabs(dot(w_eye, h));
    const Vec3 sum = at.n(w_light) * w_light + at.n(w_eye) * w_eye;
    const double T = fresnel_of_pair(c_light, c_eye, at.relative_eta(w_light)).T;
    const double value = at.transmitting * T * at.facets.D(h) * masked * c_light * c_eye *
                         sqr(at.n(w_eye)) / dot(sum, sum);
    return value * glm::sqrt(s_.base_color(x));
  }
  const Vec3 sum = normalize(w_light + w_eye), h = sum.z < 0 ? -sum : sum;
  const double c = std::fabs(dot(w_light, h));
  const double F = fresnel_dielectric(c, at.relative_eta(w_light)).F;
  const double specular = at.facets.D(h) * masked / 4;
  if (w_light.z < 0) return RGB(at.transmitting * F * specular);
  RGB result = specular * reflected_fresnel(x, at, F, c) + diffuse(x, at, w_light, w_eye);
  if (at.coat_amount > 0)
    result += RGB(0.25 * at.coat_amount * mix(0.04, 1, schlick(c)) * at.coat.D(h) *
                  Clearcoat::G1(w_light) * Clearcoat::G1(w_eye));
  return result;
}

template <class Base>
std::optional<BsdfSample> Principled<Base>::sample(const SurfacePoint& x, const Vec3& from,
                                                   const Vec3& u) const {
  if (from.z == 0) return std::nullopt;
  const At at(*this, x, from);
  if (!(at.lobes.total() > 0)) return std::nullopt;
  double u_lobe = u.x;
  const std::size_t lobe = at.lobes.choose(u_lobe);
  const double side = from.z > 0 ? 1.0 : -1.0;
  Vec3 to;
  if (lobe == kDiffuse) {
    to = warp::sample_cosine_hemisphere({u.y, u.z});
  } else {
    const Vec3 h = lobe == kCoat ? at.coat.sample(u.y, u.z)
                                 : side * at.facets.sample_visible(side * from, {u.y, u.z});
    const double c = dot(from, h);
    to = 2 * c * h - from;
    if (lobe == kTransmission) {
      const double eta = at.relative_eta(from);
      const Refraction r = fresnel_dielectric(c, eta);
      if (!(r.T > 0)) return std::nullopt;
      to = (c / eta - r.cos_t) * h - from / eta;
    }
  }
  if (!(to.z * from.z * (lobe == kTransmission ? -1 : 1) > 0)) return std::nullopt;
  const double pdf = pdf_sigma(x, from, to);
  if (!(pdf > 0)) return std::nullopt;
  return BsdfSample{to, false, pdf};
}

template <class Base>
std::optional<Vec3> Principled<Base>::invert(const SurfacePoint& x, const Vec3& from,
                                             const Vec3& to, bool dirac,
                                             const Vec3& auxiliary) const {
  if (dirac || !(pdf_sigma(x, from, to) > 0)) return std::nullopt;
  const At at(*this, x, from);
  double within = auxiliary.x;
  const std::size_t lobe = at.weighted(from, to).choose(within);
  Vec2 u;
  if (lobe == kDiffuse) {
    u = warp::invert_cosine_hemisphere(to);
  } else if (lobe == kTransmission) {
    const double side = from.z > 0 ? 1.0 : -1.0;
    u = at.facets.invert_visible(side * from, at.refracting(from, to));
  } else {
    const Vec3 sum = normalize(from + to), h = sum.z < 0 ? -sum : sum;
    const double side = from.z > 0 ? 1.0 : -1.0;
    u = lobe == kCoat ? at.coat.invert(h) : at.facets.invert_visible(side * from, h);
  }
  return Vec3(at.lobes.place(lobe, within), u.x, u.y);
}

template <class T>
void check_unit(const Textured<T>& value) {
  if (const auto range = value.range(); !(range.least >= 0 && range.greatest <= 1))
    throw std::domain_error("the parameters of principled must lie in [0, 1]");
}

}  // namespace

std::shared_ptr<const Bsdf> make_principled(const PrincipledSettings& s) {
  check_unit(s.base_color);
  for (const auto* value : {&s.roughness, &s.anisotropic, &s.metallic, &s.spec_trans, &s.spec_tint,
                            &s.sheen, &s.sheen_tint, &s.flatness, &s.clearcoat, &s.clearcoat_gloss})
    check_unit(*value);
  if (!(s.eta > 0 && std::isfinite(s.eta) && s.eta != 1))
    throw std::domain_error("the index of refraction of principled must be positive and not 1");
  if (s.spec_trans.range().greatest > 0) return std::make_shared<Principled<Bsdf>>(s, true);
  return std::make_shared<Principled<ReflectingBsdf>>(s, false);
}

}  // namespace fogbow
