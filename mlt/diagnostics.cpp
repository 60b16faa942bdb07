// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/diagnostics.h"

#include <cmath>

#include "core/util/check.h"

namespace fogbow {

Convergence convergence(std::span<const ChainMoments> chains, std::span<const double> steps) {
  FOGBOW_CHECK(chains.size() == steps.size() && chains.size() >= 2);
  const auto m = static_cast<double>(chains.size());
  double n = 0, mean = 0, within = 0;
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const double x = chains[i].sum / steps[i];
    n += steps[i] / m;
    mean += x / m;
    // Unbiased only for independent draws; what is missing is in `between`, which is added below.
    within += (chains[i].squares / steps[i] - x * x) / m;
  }
  double between = 0;  // variance of a chain's mean
  for (std::size_t i = 0; i < chains.size(); ++i) {
    const double d = chains[i].sum / steps[i] - mean;
    between += d * d / (m - 1);
  }
  const double variance = within + between;  // of h in the stationary law, over all chains
  Convergence c;
  c.effective_samples = between > 0 ? m * variance / between : m * n;
  if (within > 0)
    c.r_hat = std::sqrt(variance / within);
  else if (between > 0)
    c.r_hat = std::numeric_limits<double>::infinity();
  return c;
}

}  // namespace fogbow
