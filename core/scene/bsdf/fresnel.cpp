// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/fresnel.h"

#include <stdexcept>

namespace fogbow {

ComplexIndex::ComplexIndex(const Textured<RGB>& eta, const Textured<RGB>& k) : eta_(eta), k_(k) {
  const Texture::Range e = eta.range(), a = k.range();
  bool both_zero = e.least + a.least == 0;
  if (eta.constant() && k.constant()) {
    const RGB sum = eta.mean() + k.mean();
    both_zero = sum.x == 0 || sum.y == 0 || sum.z == 0;
  }
  if (!(e.least >= 0 && a.least >= 0 && std::isfinite(e.greatest + a.greatest)) || both_zero)
    throw std::domain_error(
        "a conductor's eta and k must be finite, not negative, and not both zero");
}

RGB ComplexIndex::reflectance(const SurfacePoint& x, double cos_i) const {
  const RGB eta = eta_(x), k = k_(x);
  return {fresnel_conductor(cos_i, eta.x, k.x), fresnel_conductor(cos_i, eta.y, k.y),
          fresnel_conductor(cos_i, eta.z, k.z)};
}

double checked_coat_index(double eta) {
  if (!(eta > 0 && std::isfinite(eta)))
    throw std::domain_error("a relative index of refraction must be positive and finite");
  return eta;
}

double diffuse_fresnel(double eta) {
  // What gets in must get out: (1 − F(1/η)) η² = 1 − F(η); only the side without total reflection
  // is smooth.
  if (eta < 1) return 1 - (1 - diffuse_fresnel(1 / eta)) * sqr(eta);
  constexpr int kIntervals = 1024;
  double sum = 0;  // Simpson's rule
  for (int i = 0; i <= kIntervals; ++i) {
    const double mu = static_cast<double>(i) / kIntervals;
    const double weight = i == 0 || i == kIntervals ? 1 : (i % 2 == 1 ? 4 : 2);
    sum += weight * 2 * mu * fresnel_dielectric(mu, eta).F;
  }
  return sum / (3 * kIntervals);
}

// Born and Wolf 1999, sec. 14.2: with (a + ib)² = (η + ik)² − sin²θ.
double fresnel_conductor(double cos_i, double eta, double k) {
  const double cos2 = cos_i * cos_i, sin2 = 1 - cos2;
  const double t = eta * eta - k * k - sin2;
  const double ab2 = std::sqrt(t * t + sqr(2 * eta * k));  // a² + b²
  // 2a² = ab2 + t, written so that it does not cancel where t < 0.
  const double a = t >= 0 ? std::sqrt(0.5 * (ab2 + t))
                          : (ab2 > 0 ? std::sqrt(2.0) * eta * k / std::sqrt(ab2 - t) : 0.0);
  const double two_a_cos = 2 * a * cos_i;
  const double R_s = (ab2 + cos2 - two_a_cos) / (ab2 + cos2 + two_a_cos);
  const double p = cos2 * ab2 + sin2 * sin2;
  const double R_p = R_s * (p - two_a_cos * sin2) / (p + two_a_cos * sin2);
  return 0.5 * (R_s + R_p);
}

}  // namespace fogbow
