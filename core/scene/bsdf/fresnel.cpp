// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/fresnel.h"

#include <stdexcept>

namespace fogbow {

ComplexIndex::ComplexIndex(const RGB& eta_, const RGB& k_) : eta(eta_), k(k_) {
  for (int i = 0; i < 3; ++i)
    if (!(eta[i] >= 0 && k[i] >= 0 && std::isfinite(eta[i] + k[i]) && eta[i] + k[i] > 0))
      throw std::domain_error(
          "a conductor's eta and k must be finite, not negative, and not both zero");
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

RGB fresnel_conductor(double cos_i, const ComplexIndex& index) {
  return {fresnel_conductor(cos_i, index.eta.x, index.k.x),
          fresnel_conductor(cos_i, index.eta.y, index.k.y),
          fresnel_conductor(cos_i, index.eta.z, index.k.z)};
}

}  // namespace fogbow
