// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/axial_phase.h"
#include "media/media.h"

namespace fogbow {
namespace {

/// 3/(16π) (1 + cos²θ): spheres much smaller than the wavelength (Bohren and Huffman 1983, sec.
/// 5.2).
class Rayleigh final : public AxialPhase {
 public:
  double mean_cosine() const override { return 0; }

 private:
  double density(const warp::PolarAngle& angle) const override {
    return 3 * kInvPi / 16 * (1 + sqr(angle.cosine()));
  }
  warp::PolarAngle sample_angle(double u) const override {
    const double d = solve(std::min(u, 1 - u));
    return u > 0.5 ? warp::PolarAngle{2 - d, d} : warp::PolarAngle{d, 2 - d};
  }
  double invert_angle(const warp::PolarAngle& angle) const override {
    const bool forward = angle.one_minus_cos < 1;
    const double u = mass(forward ? angle.one_minus_cos : angle.one_plus_cos);
    return warp::clamp_unit(forward ? u : 1 - u);
  }

  /// Of the angles with 1 − cosθ below d.
  static double mass(double d) { return 0.125 * d * (6 - d * (3 - d)); }
  /// The d ≤ 1 of a mass up to one half: cosθ³ + 3 cosθ = 4 − 8 mass, and a Newton step for the
  /// digits that 1 − cosθ has lost.
  static double solve(double mass_below) {
    const double d = 1 - 2 * std::sinh(std::asinh(2 - 4 * mass_below) / 3);
    return std::max(d - (mass(d) - mass_below) / (0.375 * (1 + sqr(1 - d))), 0.0);
  }
};

}  // namespace

std::shared_ptr<const PhaseFunction> make_rayleigh_phase() { return std::make_shared<Rayleigh>(); }

}  // namespace fogbow
