// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/math/vec.h"
#include "core/util/check.h"

namespace fogbow {

/// Chooses an index in proportion to weights ≥ 0; an invertible triple.
class DiscreteDistribution {
 public:
  DiscreteDistribution() = default;
  explicit DiscreteDistribution(std::span<const double> weights) : cdf_(weights.size() + 1, 0.0) {
    for (std::size_t i = 0; i < weights.size(); ++i) {
      FOGBOW_CHECK(weights[i] >= 0 && std::isfinite(weights[i]));
      cdf_[i + 1] = cdf_[i] + weights[i];
    }
    total_ = cdf_.back();
    if (total_ > 0)
      for (double& c : cdf_) c /= total_;
  }

  std::size_t size() const { return cdf_.empty() ? 0 : cdf_.size() - 1; }
  /// Sum of the weights; nothing may be sampled where it is 0.
  double total() const { return total_; }
  double probability(std::size_t i) const { return cdf_[i + 1] - cdf_[i]; }

  std::size_t sample(double u) const {
    const auto it = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
    std::size_t i = static_cast<std::size_t>(it - cdf_.begin()) - 1;
    while (i > 0 && probability(i) == 0) --i;  // rounding may land on an empty last bin
    return i;
  }
  /// A u with sample(u) = i, uniform on its interval by `auxiliary`.
  double invert(std::size_t i, double auxiliary) const {
    return std::min(cdf_[i] + auxiliary * probability(i), kOneMinusEpsilon);
  }

 private:
  std::vector<double> cdf_;
  double total_ = 0;
};

}  // namespace fogbow
