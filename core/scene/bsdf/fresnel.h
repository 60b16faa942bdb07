// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/vec.h"

namespace fogbow {

/// Unpolarized reflectance of a smooth interface, with the cosine on the far side (0 under total
/// reflection).
struct Refraction {
  double F, cos_t;
};

/// `cos_i` ≥ 0 on the near side, `eta` the far over the near index of refraction.
inline Refraction fresnel_dielectric(double cos_i, double eta) {
  // η² cos²θ_t = (η² − 1) + cos²θ_i: exact for η = 1, and without cancellation at grazing angles.
  const double q = (eta - 1) * (eta + 1) + cos_i * cos_i;
  if (q <= 0) return {1, 0};
  const double eta_cos_t = std::sqrt(q);
  const double cos_t = eta_cos_t / eta;
  const double r_s = (cos_i - eta_cos_t) / (cos_i + eta_cos_t);
  const double r_p = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
  return {std::fmin(0.5 * (r_s * r_s + r_p * r_p), 1.0), cos_t};
}

/// Reflectance of a conductor of complex index eta + i k ≠ 0, unpolarized.
double fresnel_conductor(double cos_i, double eta, double k);

/// The complex index of a conductor, channel by channel. Throws std::domain_error where a part is
/// negative or not finite, or both vanish.
struct ComplexIndex {
  RGB eta, k;
  ComplexIndex(const RGB& eta_, const RGB& k_);
};
RGB fresnel_conductor(double cos_i, const ComplexIndex& index);

/// Probability of reflection where F and 1 − F are weighted by their tints' means; 0 where both are
/// black.
inline double reflection_probability(double F, double reflectance, double transmittance) {
  const double r = F * reflectance, t = (1 - F) * transmittance;
  return r > 0 ? r / (r + t) : 0.0;
}

}  // namespace fogbow
