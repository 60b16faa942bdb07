// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <functional>
#include <vector>

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
  /// found light. Throws Error(NoLight).
  Bootstrap(
      const Estimator& estimator, std::uint64_t seed, int samples_per_group,
      const PictureImportance& importance = kUniformImportance,
      const BridgeWeight& g = [](const PrimarySample&, double) { return 1.0; });

  const Normalization& normalization() const { return normalization_; }
  /// One of the group's samples, in proportion to its f*: exactly distributed like f*/b once the
  /// picture is scaled by the mean of the group's samples. Another one for each attempt.
  PrimarySample start(int group, std::uint64_t chain, std::uint64_t attempt = 0) const;

 private:
  struct Sample {
    double f_star = 0, g = 1;
  };
  std::uint64_t stream(int group, std::uint64_t sample) const;
  Sample draw(int group, std::uint64_t i, const BridgeWeight& g, PrimarySample& x) const;

  const Estimator& estimator_;
  const PictureImportance& importance_;
  std::uint64_t seed_;
  Normalization normalization_;
  std::array<std::vector<double>, Film::kGroups> f_star_;
};

}  // namespace fogbow
