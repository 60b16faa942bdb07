// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <optional>

#include "core/math/vec.h"

/// Maps of primary samples in [0,1)ⁿ, each with its density and its inverse. Inverses answer
/// numbers in [0,1).
namespace fogbow::warp {

inline double clamp_unit(double u) { return std::min(std::max(u, 0.0), kOneMinusEpsilon); }

/// Uniform on [lo, hi) by `auxiliary`: the primary sample of a choice that owns this interval;
/// needs lo < hi.
inline double invert_interval(double lo, double hi, double auxiliary) {
  const double below = hi >= 1 ? kOneMinusEpsilon : std::nextafter(hi, 0.0);
  return std::min(std::max(lo + auxiliary * (hi - lo), lo), below);
}

/// Azimuth of (x, y) as a fraction of the full turn.
inline double invert_azimuth(double x, double y) {
  const double turn = std::atan2(y, x) * (0.5 * kInvPi);
  return clamp_unit(turn < 0 ? turn + 1 : turn);
}

/// The polar angle of a direction as 1 − cosθ and 1 + cosθ: neither pole loses digits.
struct PolarAngle {
  double one_minus_cos, one_plus_cos;

  double cosine() const { return one_minus_cos < 1 ? 1 - one_minus_cos : one_plus_cos - 1; }
};

inline Vec3 polar_direction(const PolarAngle& angle, double azimuth) {
  const double sin_theta = std::sqrt(angle.one_minus_cos * angle.one_plus_cos);
  const double phi = 2 * kPi * azimuth;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), angle.cosine()};
}

/// Unit vector with 1 − cosθ = d: exact at the pole, where 1 − (1 − d)² is not.
inline Vec3 spherical_direction(double d, double azimuth) {
  const double sin_theta = std::sqrt(std::max(d * (2 - d), 0.0));
  const double phi = 2 * kPi * azimuth;
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - d};
}

/// 1 − cosθ of a unit vector, without cancellation at the pole.
inline double one_minus_cos(const Vec3& w) {
  return w.z > 0 ? (w.x * w.x + w.y * w.y) / (1 + w.z) : 1 - w.z;
}

// --- Disk and cosine hemisphere: concentric squares to circles (Shirley and Chiu 1997)
// -------------------------------

namespace detail {

struct Concentric {
  Vec2 p;               ///< on the unit disk
  double rim_distance;  ///< 1 − |p|
};

inline Concentric concentric(const Vec2& u) {
  const Vec2 rim(std::min(u.x, 1 - u.x), std::min(u.y, 1 - u.y));
  const Vec2 a(2 * u.x - 1, 2 * u.y - 1);
  if (rim.x <= rim.y) {
    if (a.x == 0) return {Vec2(0), 1};
    const double phi = 0.25 * kPi * (a.y / a.x);
    return {Vec2(a.x * std::cos(phi), a.x * std::sin(phi)), 2 * rim.x};
  }
  const double phi = 0.25 * kPi * (a.x / a.y);
  return {Vec2(a.y * std::sin(phi), a.y * std::cos(phi)), 2 * rim.y};
}

inline Vec2 invert_concentric(const Vec2& p, double rim_distance) {
  const auto far = [rim_distance](double coordinate) {
    return clamp_unit(coordinate < 0 ? 0.5 * rim_distance : 1 - 0.5 * rim_distance);
  };
  const auto across = [](double r, double minor, double major) {
    return major == 0 ? 0.5 : clamp_unit(0.5 + 2 * kInvPi * r * std::atan(minor / major));
  };
  const double r = 1 - rim_distance;
  if (std::fabs(p.x) >= std::fabs(p.y)) return {far(p.x), across(std::copysign(r, p.x), p.y, p.x)};
  return {across(std::copysign(r, p.y), p.x, p.y), far(p.y)};
}

}  // namespace detail

/// Uniform on the unit disk.
inline Vec2 sample_disk(const Vec2& u) { return detail::concentric(u).p; }
inline double pdf_disk(const Vec2& p) { return dot(p, p) <= 1 ? kInvPi : 0.0; }
inline Vec2 invert_disk(const Vec2& p) { return detail::invert_concentric(p, 1 - length(p)); }

/// Density cosθ/π on the upper hemisphere.
inline Vec3 sample_cosine_hemisphere(const Vec2& u) {
  const auto [p, rim] = detail::concentric(u);
  return {p.x, p.y, std::sqrt(rim * (2 - rim))};
}
inline double pdf_cosine_hemisphere(const Vec3& w) { return std::max(w.z, 0.0) * kInvPi; }
inline Vec2 invert_cosine_hemisphere(const Vec3& w) {
  const Vec2 p(w.x, w.y);
  return detail::invert_concentric(p, w.z * w.z / (1 + length(p)));
}

// --- Uniform directions
// ----------------------------------------------------------------------------------------------

/// Uniform in the cone around +z of the given 1 − cosθ_max (1: hemisphere, 2: sphere).
inline Vec3 sample_cone(const Vec2& u, double one_minus_cos_max) {
  return spherical_direction(u.x * one_minus_cos_max, u.y);
}
inline double pdf_cone(const Vec3& w, double one_minus_cos_max) {
  return one_minus_cos(w) <= one_minus_cos_max ? 1 / (2 * kPi * one_minus_cos_max) : 0.0;
}
inline Vec2 invert_cone(const Vec3& w, double one_minus_cos_max) {
  return {clamp_unit(one_minus_cos(w) / one_minus_cos_max), invert_azimuth(w.x, w.y)};
}

inline Vec3 sample_sphere(const Vec2& u) { return sample_cone(u, 2); }
inline double pdf_sphere() { return 0.25 * kInvPi; }
inline Vec2 invert_sphere(const Vec3& w) { return invert_cone(w, 2); }

inline Vec3 sample_hemisphere(const Vec2& u) { return sample_cone(u, 1); }
inline double pdf_hemisphere(const Vec3& w) { return w.z >= 0 ? 0.5 * kInvPi : 0.0; }
inline Vec2 invert_hemisphere(const Vec3& w) { return invert_cone(w, 1); }

// --- Triangle
// --------------------------------------------------------------------------------------------------------

/// Uniform barycentrics (b₁, b₂) of a triangle; b₀ = 1 − b₁ − b₂.
inline Vec2 sample_triangle(const Vec2& u) {
  const double s = std::sqrt(u.x);
  return {s * (1 - u.y), s * u.y};
}
/// With respect to db₁ db₂.
inline double pdf_triangle() { return 2; }
inline Vec2 invert_triangle(const Vec2& b) {
  const double s = b.x + b.y;
  return {clamp_unit(s * s), s > 0 ? clamp_unit(b.y / s) : 0.0};
}

// --- Henyey and Greenstein 1941
// --------------------------------------------------------------------------------------

/// 1 + g² − 2g cosθ, from 1 − cosθ and 1 + cosθ: no cancellation in either peak.
inline double henyey_greenstein_base(double g, double one_minus_cos, double one_plus_cos) {
  return g >= 0 ? sqr(1 - g) + 2 * g * one_minus_cos : sqr(1 + g) - 2 * g * one_plus_cos;
}

/// Density in solid angle; arguments 1 − cosθ and 1 + cosθ of the scattering angle.
inline double pdf_henyey_greenstein(double g, double one_minus_cos, double one_plus_cos) {
  const double base = henyey_greenstein_base(g, one_minus_cos, one_plus_cos);
  return 0.25 * kInvPi * (1 - g) * (1 + g) / (base * std::sqrt(base));
}

/// The distribution function of 1 − cosθ solved without division by g.
inline PolarAngle sample_henyey_greenstein_angle(double u, double g) {
  const double scale = 2 / sqr((1 - u) * (1 + g) + u * (1 - g));
  return {sqr(1 - g) * u * (1 + g * (1 - u)) * scale, sqr(1 + g) * (1 - u) * (1 - g * u) * scale};
}
/// Around +z, the direction of propagation.
inline Vec3 sample_henyey_greenstein(const Vec2& u, double g) {
  return polar_direction(sample_henyey_greenstein_angle(u.x, g), u.y);
}

/// u.x from 1 − cosθ and 1 + cosθ.
inline double invert_henyey_greenstein(double g, double one_minus_cos, double one_plus_cos) {
  const double r = std::sqrt(henyey_greenstein_base(g, one_minus_cos, one_plus_cos));
  return clamp_unit((1 + g) * one_minus_cos / (r * (r + 1 - g)));
}

// --- Distances
// -------------------------------------------------------------------------------------------------------

/// Free flight in σ_t on (0, T), T may be infinite, where the wall is reached with probability τ(T)
/// (notation.md).
struct FreeFlight {
  double sigma_t, T;

  /// 1 − τ(T): below it lie the primary samples of the medium, from it on those of the wall.
  double medium_mass() const { return sigma_t > 0 ? -std::expm1(-sigma_t * T) : 0.0; }
  double wall_mass() const { return sigma_t > 0 ? std::exp(-sigma_t * T) : 1.0; }
  /// Nothing: the wall.
  std::optional<double> sample(double u) const {
    if (u >= medium_mass()) return std::nullopt;
    return std::min(-std::log1p(-u) / sigma_t, std::nextafter(T, 0.0));
  }
  double pdf(double t) const { return sigma_t * std::exp(-sigma_t * t); }
  double invert(double t) const {
    return std::min(-std::expm1(-sigma_t * t), std::nextafter(medium_mass(), 0.0));
  }
  /// Nothing where the wall's mass is lost to rounding (σ_t T > 36).
  std::optional<double> invert_wall(double auxiliary) const {
    const double lo = medium_mass();
    if (lo >= 1) return std::nullopt;
    return invert_interval(lo, 1, auxiliary);
  }
};

/// The exponential law cut to (0, T). T may be infinite if σ_t > 0.
struct TruncatedExponential {
  double sigma_t, T;

  double sample(double u) const {
    if (is_uniform()) return u * T;
    return std::min(-std::log1p(u * std::expm1(-sigma_t * T)) / sigma_t, std::nextafter(T, 0.0));
  }
  double pdf(double t) const {
    if (is_uniform()) return 1 / T;
    return -sigma_t * std::exp(-sigma_t * t) / std::expm1(-sigma_t * T);
  }
  double invert(double t) const {
    if (is_uniform()) return clamp_unit(t / T);
    return clamp_unit(std::expm1(-sigma_t * t) / std::expm1(-sigma_t * T));
  }

 private:
  /// To rounding: the density varies by a factor e^{−σ_t T}.
  bool is_uniform() const { return !(sigma_t * T > 1e-17); }
};

/// Density ∝ 1/distance² to a point (Kulla and Fajardo 2012) on (t0, t1) of a ray; t1 may be
/// infinite. The point projects to `foot` on the ray and lies at `distance` > 0 from it. Angles are
/// measured from the nearer end, so nothing cancels.
struct Equiangular {
  double foot, distance, t0, t1;

  /// Angle under which (t0, t1) is seen.
  double angle() const { return angle_between(t0, t1); }
  double sample(double u) const {
    const double total = angle();
    const double t = u < 0.5 ? from_start(u * total) : from_end(u * total, (1 - u) * total);
    return std::min(std::max(t, t0), t1);
  }
  double pdf(double t) const {
    return distance / (angle() * (distance * distance + sqr(t - foot)));
  }
  double invert(double t) const {
    const double below = angle_between(t0, t), above = angle_between(t, t1);
    return clamp_unit(below < above ? below / (below + above) : 1 - above / (below + above));
  }

 private:
  /// Where the angle from t0 is phi. Each formula subtracts only what the result is as large as.
  double from_start(double phi) const {
    const double D = distance, a = t0 - foot;
    const double c = std::cos(phi), s = std::sin(phi);
    return t0 + (D * D + a * a) * s / (D * c - a * s);
  }
  /// Where the angles from t0 and to t1 are phi and psi.
  double from_end(double phi, double psi) const {
    const double D = distance, a = t0 - foot, b = t1 - foot;
    const double c = std::cos(psi), s = std::sin(psi);
    const bool endless = std::isinf(t1);
    if (a >= 0) {  // the foot lies before the segment
      const double inverse_cos = endless ? 1 / s : std::sqrt(D * D + b * b) / (D * c + b * s);
      return t0 + std::sqrt(D * D + a * a) * std::sin(phi) * inverse_cos;
    }
    if (b <= 0) return t1 - (D * D + b * b) * s / (D * c + b * s);  // behind it
    return foot + (endless ? D * c / s : D * (b * c - D * s) / (D * c + b * s));
  }
  double angle_between(double from, double to) const {
    if (std::isinf(to)) return std::atan2(distance, from - foot);
    return std::atan2(distance * (to - from), distance * distance + (to - foot) * (from - foot));
  }
};

}  // namespace fogbow::warp
