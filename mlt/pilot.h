// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "core/estimators/estimator.h"
#include "mlt/picture_importance.h"

namespace fogbow {

/// What chains are told beforehand of the light; from samples of its own, so that nothing that is
/// made of it depends on where chains start.
struct Pilot {
  /// Luminance that BDPT's techniques carry, by k and s.
  std::vector<std::vector<double>> techniques;
  PictureImportance importance;
  double f_star = 0;  ///< about b, with this importance
};

/// `aspect`: width over height of the picture. `samples` are doubled (up to 64 times as many) until
/// they know as much of the light as `least_effective` equal ones.
Pilot run_pilot(const Estimator& estimator, double aspect, std::uint64_t seed,
                std::uint64_t samples, double least_effective = 0);

}  // namespace fogbow
