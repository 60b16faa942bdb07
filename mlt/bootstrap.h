// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "core/math/discrete_distribution.h"
#include "mlt/normalization.h"
#include "mlt/primary_sample.h"

namespace fogbow {

/// Independent estimates from which chains start.
class Bootstrap {
 public:
  /// g of the state that a chain would start from if it were given this sample and this uniform
  /// number.
  using BridgeWeight = std::function<double(const PrimarySample& x, double u)>;

  /// `samples_per_group` for every group, doubled (up to 64 times as many) until all groups have
  /// found light, and all together as much as `least_effective` equal samples know of it. Throws
  /// Error(NoLight).
  Bootstrap(
      const Estimator& estimator, std::uint64_t seed, int samples_per_group,
      const PictureImportance& importance = kUniformImportance,
      const BridgeWeight& g = [](const PrimarySample&, double) { return 1.0; },
      double least_effective = 0);

  const Normalization& normalization() const { return normalization_; }
  /// The group's sample at this quantile of its f*, in the order of path lengths and places in the
  /// picture. With u uniform it is exactly distributed like f*/b once the picture is scaled by the
  /// mean of the group's samples; equidistant u share starts among all parts of the light.
  PrimarySample start(int group, double u) const;

 private:
  struct Sample {
    double f_star = 0, g = 1;
    std::uint32_t place = 0;
  };
  /// Those that carry light, in their order.
  struct Starts {
    std::vector<std::uint64_t> samples;
    DiscreteDistribution law;
  };
  std::uint64_t stream(int group, std::uint64_t sample) const;
  Sample draw(int group, std::uint64_t i, const BridgeWeight& g, PrimarySample& x) const;

  const Estimator& estimator_;
  const PictureImportance& importance_;
  std::uint64_t seed_;
  Normalization normalization_;
  std::array<Starts, Film::kGroups> starts_;
};

}  // namespace fogbow
