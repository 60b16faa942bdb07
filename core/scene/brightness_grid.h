// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>

#include "core/math/grid_distribution.h"

namespace fogbow {

/// A law on the unit square: cells as likely as something is bright there, points in them uniform.
class BrightnessGrid {
 public:
  BrightnessGrid() = default;
  /// Looks `color` up at many points; a part of the law is spread evenly, so that what lies between
  /// them is not lost. Throws std::domain_error where all are black.
  explicit BrightnessGrid(const std::function<RGB(const Vec2&)>& color);

  /// Of the colors that were looked up.
  const RGB& mean() const { return mean_; }

  Vec2 sample(const Vec2& u) const;
  double pdf(const Vec2& x) const;
  Vec2 invert(const Vec2& x) const { return grid_.invert(place(x)); }

 private:
  GridDistribution::Place place(const Vec2& x) const;

  RGB mean_{0};
  GridDistribution grid_;
};

}  // namespace fogbow
