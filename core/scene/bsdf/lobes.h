// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstddef>

#include "core/math/warp.h"

namespace fogbow {

/// Several ways to sample that share one primary sample, in proportion to weights that are not all
/// zero.
template <std::size_t N>
struct LobeChoice {
  std::array<double, N> weights;

  double total() const {
    double sum = 0;
    for (const double w : weights) sum += w;
    return sum;
  }
  double probability(std::size_t i) const { return weights[i] / total(); }
  /// The lobe on whose part of [0, 1) u lies; u becomes uniform on [0, 1) anew.
  std::size_t choose(double& u) const {
    double scaled = u * total();
    std::size_t i = 0, last = 0;
    for (; i < N; ++i) {
      if (weights[i] > 0) last = i;
      if (scaled < weights[i]) break;
      scaled -= weights[i];
    }
    if (i == N) {  // rounding
      i = last;
      scaled = weights[i];
    }
    u = warp::clamp_unit(scaled / weights[i]);
    return i;
  }
  /// The u from which choose() makes i and `within`.
  double place(std::size_t i, double within) const {
    double before = 0;
    for (std::size_t j = 0; j < i; ++j) before += weights[j];
    return warp::clamp_unit((before + within * weights[i]) / total());
  }
};

}  // namespace fogbow
