// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "media/axial_phase.h"
#include "media/media.h"

namespace fogbow {
namespace {

/// Henyey and Greenstein times 1 + α cos²θ (Draine 2003, eq. 4): Rayleigh for g = 0 and α = 1.
class Draine final : public AxialPhase {
 public:
  Draine(double g, double alpha) : g_(g), alpha_(alpha), norm_(1 + alpha * (1 + 2 * g * g) / 3) {
    if (!(g > -1 && g < 1))
      throw std::domain_error("g of a Draine phase function must lie in (-1, 1)");
    if (!(alpha >= 0 && std::isfinite(alpha)))
      throw std::domain_error("alpha of a Draine phase function must be finite and not negative");
  }
  double mean_cosine() const override { return g_ * (1 + alpha_ * (3 + 2 * g_ * g_) / 5) / norm_; }

 private:
  double density(const warp::PolarAngle& angle) const override {
    return warp::pdf_henyey_greenstein(g_, angle.one_minus_cos, angle.one_plus_cos) *
           (1 + alpha_ * sqr(angle.cosine())) / norm_;
  }
  warp::PolarAngle sample_angle(double u) const override;
  double invert_angle(const warp::PolarAngle& angle) const override {
    return warp::clamp_unit(below(angle));
  }

  /// Probability of 1 − cosθ < d around the pole towards which g leans if it is positive: with
  /// r² = 1 + g² − 2g cosθ, ∫x^k r⁻³ dx over (0, d) for k = 0, 1, 2 without division by g.
  double mass(double g, double d) const {
    const double r0 = 1 - g, r = std::sqrt(r0 * r0 + 2 * g * d), sum = r + r0;
    const double I0 = 2 * d / (r0 * r * sum), I1 = 2 * d * d / (r * sum * sum),
                 I2 = 2 * d * d * d * (r + 3 * r0) / (3 * r * sum * sum * sum);
    return 0.5 * (1 - g) * (1 + g) * ((1 + alpha_) * I0 - alpha_ * (2 * I1 - I2)) / norm_;
  }
  double below(const warp::PolarAngle& angle) const {
    return angle.one_minus_cos < 1 ? mass(g_, angle.one_minus_cos)
                                   : 1 - mass(-g_, angle.one_plus_cos);
  }

  double g_, alpha_, norm_;
};

/// Newton's method between bounds, in the primary sample v of Henyey and Greenstein, where the
/// derivative (1 + α cos²θ)/norm is tame.
warp::PolarAngle Draine::sample_angle(double u) const {
  double lo = 0, hi = 1, v = u;
  warp::PolarAngle angle = warp::sample_henyey_greenstein_angle(v, g_);
  for (int i = 0; i < 100; ++i) {
    // What lies on the far side is compared there: its small masses keep their digits.
    const bool forward = angle.one_minus_cos < 1;
    const double excess =
        forward ? mass(g_, angle.one_minus_cos) - u : (1 - u) - mass(-g_, angle.one_plus_cos);
    (excess > 0 ? hi : lo) = v;
    double next = v - excess * norm_ / (1 + alpha_ * sqr(angle.cosine()));
    if (!(next > lo && next < hi)) next = 0.5 * (lo + hi);
    if (next == v || excess == 0) break;
    const bool settled = std::fabs(next - v) < 1e-16 * v;
    v = next;
    angle = warp::sample_henyey_greenstein_angle(v, g_);
    if (settled) break;
  }
  return angle;
}

}  // namespace

std::shared_ptr<const PhaseFunction> make_draine(double g, double alpha) {
  return std::make_shared<Draine>(g, alpha);
}

}  // namespace fogbow
