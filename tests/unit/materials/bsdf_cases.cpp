// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/materials/bsdf_cases.h"

namespace fogbow::testing {

double textbook_fresnel(double cos_i, double n_i, double n_t) {
  const double theta_i = std::acos(std::fabs(cos_i));
  const double sin_t = n_i / n_t * std::sin(theta_i);
  if (sin_t >= 1) return 1;
  const double theta_t = std::asin(sin_t);
  if (theta_i < 1e-7) return sqr((n_i - n_t) / (n_i + n_t));
  const double r_s = std::sin(theta_i - theta_t) / std::sin(theta_i + theta_t);
  const double r_p = std::tan(theta_i - theta_t) / std::tan(theta_i + theta_t);
  return 0.5 * (r_s * r_s + r_p * r_p);
}

}  // namespace fogbow::testing
