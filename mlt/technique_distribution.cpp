// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/technique_distribution.h"

namespace fogbow {

namespace {

/// Part of all large steps that does not look at the bootstrap, and how fast it falls off with k.
constexpr double kDefensive = 0.2, kFallOff = 0.75;

}  // namespace

TechniqueDistribution::TechniqueDistribution(const std::vector<std::vector<double>>& light,
                                             int max_vertices)
    : by_length_(max_vertices + 1) {
  double total = 0;
  for (const auto& of_length : light)
    for (const double part : of_length) total += part;
  std::vector<double> weights;
  double normalization = 0;
  for (int k = 2; k <= max_vertices; ++k) normalization += std::pow(kFallOff, k);
  for (int k = 2; k <= max_vertices; ++k) {
    by_length_[k].resize(k + 1);
    for (int s = 0; s < k; ++s) {
      const bool known = static_cast<std::size_t>(k) < light.size() &&
                         static_cast<std::size_t>(s) < light[k].size();
      double p = std::pow(kFallOff, k) / normalization / k;
      if (total > 0) p = kDefensive * p + (1 - kDefensive) * (known ? light[k][s] / total : 0.0);
      by_length_[k][s] = p;
      techniques_.push_back({s, k - s});
      weights.push_back(p);
    }
  }
  distribution_ = DiscreteDistribution(weights);
}

TechniqueDistribution::Technique TechniqueDistribution::sample(double u) const {
  return techniques_[distribution_.sample(u)];
}

}  // namespace fogbow
