// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "core/math/vec.h"
#include "core/math/warp.h"
#include "core/scene/texture.h"

namespace fogbow {

/// At a smooth interface: unpolarized reflectance and transmittance (F + T = 1), and the cosine on
/// the far side (0 under total reflection).
struct Refraction {
  double F, T, cos_t;
};

/// Of two directions that Snell's law joins, with cosines ≥ 0; `eta` is the far over the near index
/// of refraction. Symmetric to rounding.
inline Refraction fresnel_of_pair(double cos_i, double cos_t, double eta) {
  const double s = 1 / (cos_i + eta * cos_t), p = 1 / (eta * cos_i + cos_t);
  const double r_s = (cos_i - eta * cos_t) * s, r_p = (eta * cos_i - cos_t) * p;
  // T by itself, as 1 − F is mostly rounding where F is close to 1.
  return {0.5 * (r_s * r_s + r_p * r_p), 2 * eta * cos_i * cos_t * (s * s + p * p), cos_t};
}

inline Refraction fresnel_dielectric(double cos_i, double eta) {
  // η² cos²θ_t = (η² − 1) + cos²θ_i: exact for η = 1, and without cancellation at grazing angles.
  const double q = (eta - 1) * (eta + 1) + cos_i * cos_i;
  if (q <= 0) return {1, 0, 0};
  return fresnel_of_pair(cos_i, std::sqrt(q) / eta, eta);
}

/// Reflectance of a smooth interface for diffuse light: ∫ 2μ F(μ) dμ over cosines μ.
double diffuse_fresnel(double eta);
/// Throws std::domain_error unless positive and finite.
double checked_coat_index(double eta);
/// What a diffuse base sends through a coat, 1/sr, but for the transmittances on the way in and
/// out; `internal` is the coat's reflectance for diffuse light from inside. Reflections between the
/// two are tinted by the base every time if `nonlinear`, else not at all.
inline RGB coated_base(const RGB& base, bool nonlinear, double internal, double eta) {
  const RGB lost = internal * (nonlinear ? base : RGB(1));
  return kInvPi / sqr(eta) * base / (RGB(1) - lost);
}

/// Reflectance of a conductor of complex index eta + i k ≠ 0, unpolarized.
double fresnel_conductor(double cos_i, double eta, double k);

/// The complex index of a conductor, channel by channel. Throws std::domain_error where a part is
/// negative or not finite, or both vanish (of textures, both can).
class ComplexIndex {
 public:
  ComplexIndex(const Textured<RGB>& eta, const Textured<RGB>& k);
  RGB reflectance(const SurfacePoint& x, double cos_i) const;

 private:
  Textured<RGB> eta_, k_;
};

/// Probabilities of the two events where F and T are weighted by their tints' means; zero where
/// both are black.
struct EventProbabilities {
  double reflection, transmission;
};
inline EventProbabilities event_probabilities(const Refraction& r, double reflectance,
                                              double transmittance) {
  const double a = r.F * reflectance, b = r.T * transmittance;
  if (!(a + b > 0)) return {0, 0};
  return {a / (a + b), b / (a + b)};
}
/// Primary sample of an event, uniform on its interval; nothing where it has none (transmission
/// below 2⁻⁵³).
inline std::optional<double> invert_event(const EventProbabilities& P, bool reflects,
                                          double auxiliary) {
  const double lo = reflects ? 0 : P.reflection, hi = reflects ? P.reflection : 1;
  if (!(lo < hi) || !((reflects ? P.reflection : P.transmission) > 0)) return std::nullopt;
  return warp::invert_interval(lo, hi, auxiliary);
}

}  // namespace fogbow
