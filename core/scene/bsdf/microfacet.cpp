// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/microfacet.h"

#include <algorithm>
#include <stdexcept>

#include "core/math/warp.h"

namespace fogbow {
namespace {

constexpr double kLeastAlpha = 1e-4;
constexpr double kInvSqrtPi = std::numbers::inv_sqrtpi;
/// Primary samples below this (u = 0 alone) would give an infinite slope.
constexpr double kLeastSample = 0x1p-54;

/// First guess of the y with erfc(−y) = 2u.
double normal_quantile_guess(double u) {
  const double log_density = -std::log(4 * u * (1 - u));
  if (log_density < 5) {  // Giles 2010, single-precision central fit
    const double w = log_density - 2.5;
    double p = 2.81022636e-08;
    for (const double c : {3.43273939e-07, -3.5233877e-06, -4.39150654e-06, 0.00021858087,
                           -0.00125372503, -0.00417768164, 0.246640727, 1.50140941})
      p = c + p * w;
    return p * (2 * u - 1);
  }
  // Tail: erfc(t) ≈ e^{−t²}/(t√π).
  const double q = std::min(u, 1 - u);
  const double L = -std::log(2 * q);
  const double t = std::sqrt(L - 0.5 * std::log(kPi * L));
  return u < 0.5 ? -t : t;
}

/// The y below which a standard Gaussian slope e^{−y²}/√π has mass u.
double gaussian_slope(double u) {
  u = std::max(u, kLeastSample);
  double y = normal_quantile_guess(u);
  for (int i = 0; i < 4; ++i) {  // Halley's steps for erfc
    const double side = y < 0 ? -1.0 : 1.0;
    const double t = std::fabs(y);
    const double residual = 0.5 * std::erfc(t) - (y < 0 ? u : 1 - u);
    const double newton = residual / (kInvSqrtPi * std::exp(-t * t));
    const double step = newton / (1 - t * newton);
    y += side * step;
    if (std::fabs(step) < 1e-6 * std::max(t, 1.0)) break;  // the error left is its cube
  }
  return y;
}

/// Visible slopes of a Gaussian surface of unit roughness along the plane of incidence: density ∝
/// (cosθ − x sinθ) e^{−x²} for x < cotθ.
struct VisibleSlope {
  double cos_theta, sin_theta, mass;

  VisibleSlope(double c, double s) : cos_theta(c), sin_theta(s), mass(1) {
    if (s > 0)
      mass = primitive(c / s);
    else
      mass = c;
  }
  /// ∫_{−∞}^x; a sum of positive terms.
  double primitive(double x) const {
    return 0.5 * (cos_theta * std::erfc(-x) + sin_theta * kInvSqrtPi * std::exp(-x * x));
  }
  double invert(double x) const { return warp::clamp_unit(primitive(x) / mass); }
  double sample(double u) const;
};

double VisibleSlope::sample(double u) const {
  u = std::max(u, kLeastSample);
  // The law grows with cotθ, from Rayleigh's at grazing incidence to the Gaussian at normal
  // incidence.
  constexpr double kGuessError = 0.1;
  const double gaussian = normal_quantile_guess(u);
  double lo = -std::sqrt(-std::log(u));
  double hi = std::min(gaussian + kGuessError, sin_theta > 0 ? cos_theta / sin_theta : kInfinity);
  double x = lo + cos_theta * (std::min(gaussian, hi) - lo);
  const double target = u * mass;
  for (int i = 0; i < 64; ++i) {
    const double e = kInvSqrtPi * std::exp(-x * x);
    const double residual = 0.5 * (cos_theta * std::erfc(-x) + sin_theta * e) - target;
    (residual > 0 ? hi : lo) = x;
    const double slope = cos_theta - x * sin_theta;
    const double newton = residual / (slope * e);
    // Halley, with f''/f' = −2x − sinθ/slope; halving where it leaves the bracket.
    const double step = newton / (1 + 0.5 * newton * (2 * x + sin_theta / slope));
    if (!(x - step >= lo && x - step <= hi)) {
      x = 0.5 * (lo + hi);
      continue;
    }
    x -= step;
    if (std::fabs(step) < 1e-6 * std::min(1.0, slope)) break;  // the error left is its cube
  }
  return x;
}

}  // namespace

MicrofacetDistribution::MicrofacetDistribution(MicrofacetKind kind, double alpha_u, double alpha_v,
                                               const Vec2& u_axis)
    : kind_(kind),
      alpha_(std::max(alpha_u, kLeastAlpha), std::max(alpha_v, kLeastAlpha)),
      u_(u_axis),
      normalization_(kInvPi / (alpha_.x * alpha_.y)) {
  for (const double a : {alpha_u, alpha_v})
    if (!(a >= 0 && std::isfinite(a)))
      throw std::domain_error("roughness must be finite and not negative");
}

TexturedFacets::TexturedFacets(const RoughnessSettings& roughness)
    : settings_(roughness),
      constant_(roughness.kind, roughness.alpha_u.mean(), roughness.alpha_v.mean()),
      varies_(!roughness.alpha_u.constant() || !roughness.alpha_v.constant() ||
              roughness.alpha_u.mean() != roughness.alpha_v.mean()) {
  const Texture::Range u = roughness.alpha_u.range(), v = roughness.alpha_v.range();
  // Throws where the constructor of a distribution could.
  const MicrofacetDistribution least(roughness.kind, u.least, v.least);
  roughness_ = MicrofacetDistribution(roughness.kind, u.greatest, v.greatest).roughness();
}

double MicrofacetDistribution::D(const Vec3& normal) const {
  const Vec3 h = to_axes(normal);
  const double z2 = h.z * h.z;
  const double slope2 = sqr(h.x / alpha_.x) + sqr(h.y / alpha_.y);
  if (kind_ == MicrofacetKind::Ggx) return normalization_ / sqr(slope2 + z2);
  return z2 > 0 ? normalization_ * std::exp(-slope2 / z2) / sqr(z2) : 0.0;
}

double MicrofacetDistribution::G1(const Vec3& direction) const {
  const Vec3 w = to_axes(direction);
  const double z = std::fabs(w.z);
  const double stretched = std::sqrt(sqr(alpha_.x * w.x) + sqr(alpha_.y * w.y));
  if (kind_ == MicrofacetKind::Ggx)
    return z > 0 ? 2 * z / (z + std::sqrt(z * z + stretched * stretched)) : 0.0;
  constexpr double kUnmasked = 6;  // here 1 − G1 < 1e-17
  if (z >= kUnmasked * stretched) return 1;
  if (z == 0) return 0;
  const double a = z / stretched;
  return 2 * a / (a * std::erfc(-a) + kInvSqrtPi * std::exp(-a * a));
}

Vec3 MicrofacetDistribution::sample_visible(const Vec3& w, const Vec2& u) const {
  const Vec3 v = stretch(w);
  if (kind_ == MicrofacetKind::Ggx) {
    // Reflections of v at the hemisphere are uniform on a spherical cap (Dupuy and Benyoub 2023).
    const Vec3 c = warp::spherical_direction(u.x * (1 + v.z), u.y);
    const Vec3 h = c + v;
    return from_axes(normalize(Vec3(alpha_.x * h.x, alpha_.y * h.y, h.z)));
  }
  const double sin_theta = std::sqrt(v.x * v.x + v.y * v.y);
  const Vec2 plane = sin_theta > 0 ? Vec2(v.x, v.y) / sin_theta : Vec2(1, 0);
  const double x = VisibleSlope(v.z, sin_theta).sample(u.x), y = gaussian_slope(u.y);
  const Vec2 slope(plane.x * x - plane.y * y, plane.y * x + plane.x * y);
  return from_axes(normalize(Vec3(-alpha_.x * slope.x, -alpha_.y * slope.y, 1)));
}

Vec2 MicrofacetDistribution::invert_visible(const Vec3& w, const Vec3& normal) const {
  const Vec3 v = stretch(w), h = to_axes(normal);
  if (kind_ == MicrofacetKind::Ggx) {
    const Vec3 m = normalize(Vec3(h.x / alpha_.x, h.y / alpha_.y, h.z));
    const Vec3 c = 2 * dot(v, m) * m - v;
    return {warp::clamp_unit(warp::one_minus_cos(c) / (1 + v.z)), warp::invert_azimuth(c.x, c.y)};
  }
  const double sin_theta = std::sqrt(v.x * v.x + v.y * v.y);
  const Vec2 plane = sin_theta > 0 ? Vec2(v.x, v.y) / sin_theta : Vec2(1, 0);
  const Vec2 slope(-h.x / (h.z * alpha_.x), -h.y / (h.z * alpha_.y));
  const double x = plane.x * slope.x + plane.y * slope.y;
  const double y = plane.x * slope.y - plane.y * slope.x;
  return {VisibleSlope(v.z, sin_theta).invert(x), warp::clamp_unit(0.5 * std::erfc(-y))};
}

}  // namespace fogbow
