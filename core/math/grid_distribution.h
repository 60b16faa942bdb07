// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/math/discrete_distribution.h"
#include "core/math/warp.h"

namespace fogbow {

/// Chooses a cell of a grid in proportion to weights ≥ 0, and a place in it; an invertible triple.
class GridDistribution {
 public:
  /// A cell (column, row), and where in it: uniform on the unit square.
  struct Place {
    std::size_t i, j;
    Vec2 within;
  };

  GridDistribution() = default;
  /// Row after row.
  GridDistribution(std::size_t width, std::span<const double> weights) {
    std::vector<double> by_row;
    for (std::size_t first = 0; first < weights.size(); first += width) {
      by_column_.emplace_back(weights.subspan(first, width));
      by_row.push_back(by_column_.back().total());
    }
    by_row_ = DiscreteDistribution(by_row);
  }

  /// Sum of the weights; nothing may be sampled where it is 0.
  double total() const { return by_row_.total(); }
  double probability(std::size_t i, std::size_t j) const {
    return by_row_.probability(j) * by_column_[j].probability(i);
  }

  Place sample(const Vec2& u) const {
    const std::size_t j = by_row_.sample(u.y), i = by_column_[j].sample(u.x);
    return {i, j, {within(by_column_[j], i, u.x), within(by_row_, j, u.y)}};
  }
  /// The u with sample(u) = place.
  Vec2 invert(const Place& p) const {
    return {by_column_[p.j].invert(p.i, p.within.x), by_row_.invert(p.j, p.within.y)};
  }

 private:
  static double within(const DiscreteDistribution& law, std::size_t i, double u) {
    return warp::clamp_unit((u - law.invert(i, 0)) / law.probability(i));
  }

  std::vector<DiscreteDistribution> by_column_;
  DiscreteDistribution by_row_;
};

}  // namespace fogbow
