// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/scene/medium.h"
#include "core/scene/phase_function.h"
#include "core/scene/volume.h"

namespace fogbow {

std::shared_ptr<const PhaseFunction> make_isotropic_phase();
/// Henyey and Greenstein 1941; g in (−1, 1).
std::shared_ptr<const PhaseFunction> make_henyey_greenstein(double g);
std::shared_ptr<const PhaseFunction> make_rayleigh_phase();
/// Draine 2003; g in (−1, 1), alpha ≥ 0.
std::shared_ptr<const PhaseFunction> make_draine(double g, double alpha);
/// (1 − weight) · first + weight · second; weight in [0, 1].
std::shared_ptr<const PhaseFunction> make_blend_phase(std::shared_ptr<const PhaseFunction> first,
                                                      std::shared_ptr<const PhaseFunction> second,
                                                      double weight);
/// Values in any unit at equal steps of cosθ from −1 to 1, linear in between.
std::shared_ptr<const PhaseFunction> make_tabulated_phase(const std::vector<double>& values);

/// Chromatic; albedo = σ_s/σ_t in [0, 1]; `emission` is radiance per unit length and needs σ_t > 0
/// in some channel. Throws std::domain_error on negative or non-finite coefficients.
std::shared_ptr<const Medium> make_homogeneous_medium(const RGB& sigma_t, const RGB& albedo,
                                                      std::shared_ptr<const PhaseFunction> phase,
                                                      const RGB& emission = RGB(0),
                                                      std::string id = {});

struct HeterogeneousSettings {
  std::shared_ptr<const Volume> sigma_t;  ///< zero outside of its bounds
  double scale = 1;                       ///< of sigma_t
  std::shared_ptr<const Volume> albedo;
  std::shared_ptr<const Volume> emission;  ///< null: none; counts only where σ_t > 0
};

/// Optical depths and free flights are exact, by regular tracking. Throws std::domain_error on an
/// albedo above one and on coefficients that are not finite.
std::shared_ptr<const Medium> make_heterogeneous_medium(const HeterogeneousSettings& settings,
                                                        std::shared_ptr<const PhaseFunction> phase,
                                                        std::string id = {});

}  // namespace fogbow
