// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

#include "core/math/discrete_distribution.h"

namespace fogbow {

/// c_{s,t}: how often a large step tries each technique of bidirectional path tracing. Every
/// technique of paths up to the longest has some probability.
class TechniqueDistribution {
 public:
  /// `light`: by k and s, the part of b that a technique has carried in the bootstrap.
  TechniqueDistribution(const std::vector<std::vector<double>>& light, int max_vertices);

  struct Technique {
    int s, t;
  };
  Technique sample(double u) const;
  /// c_{l, k−l} for l = 0 … k.
  std::span<const double> probabilities(int k) const { return by_length_[k]; }

 private:
  std::vector<std::vector<double>> by_length_;
  std::vector<Technique> techniques_;
  DiscreteDistribution distribution_;
};

}  // namespace fogbow
