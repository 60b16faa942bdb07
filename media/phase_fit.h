// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "core/scene/phase_function.h"

namespace fogbow {

/// (1 − weight) · HG(g_hg) + weight · Draine(g_draine, alpha), a compact stand-in for droplets
/// [Jendersie2023].
struct PhaseFit {
  double g_hg, g_draine, alpha, weight;
  double error;     ///< rms of ln(fit/original), over angles that are uniform in θ
  double hg_alone;  ///< g of the best single Henyey–Greenstein function
  double hg_error;  ///< and its error
};

/// The least squares in ln of a phase function's mean over the channels, within bounds: |g| ≤
/// 0.9999, 0 ≤ alpha ≤ 1000, 0 ≤ weight ≤ 1. Throws std::domain_error where it is zero somewhere.
PhaseFit fit_phase(const PhaseFunction& original);

std::shared_ptr<const PhaseFunction> make_fitted_phase(const PhaseFit& fit);

}  // namespace fogbow
