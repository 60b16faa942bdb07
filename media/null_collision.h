// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>

#include "core/scene/medium.h"

namespace fogbow {

// Tracking by null collisions with majorants: unbiased but random, it asks the medium for nothing
// but coefficients at points. The oracle of what is exact.

using UniformSource = std::function<double()>;

/// An unbiased estimate of the transmittance over [t0, t1], by ratio tracking [Novak2014].
RGB ratio_tracking(const Medium& medium, const Ray& ray, double t0, double t1,
                   const UniformSource& uniform);

/// Where delta tracking [Raab2008] ends.
struct NullCollisionFlight {
  double t;
  bool inside;  ///< in the medium; else it came through
  /// What estimates the transmittance in each channel, divided by the density of t (inside) or by
  /// the probability of coming through.
  RGB weight;
};
NullCollisionFlight delta_tracking(const Medium& medium, const Ray& ray, double t0, double t1,
                                   const UniformSource& uniform);

}  // namespace fogbow
