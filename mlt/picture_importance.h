// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <span>
#include <vector>

#include "core/math/vec.h"

namespace fogbow {

/// Cells of a picture, row by row from its upper left corner.
struct PictureGrid {
  int across = 1, down = 1;

  std::size_t size() const { return static_cast<std::size_t>(across) * down; }
  /// Of a raster position in [0,1]².
  std::size_t cell(const Vec2& raster) const {
    const auto index = [](double u, int n) {
      return std::clamp(static_cast<int>(u * n), 0, n - 1);
    };
    return static_cast<std::size_t>(index(raster.y, down)) * across + index(raster.x, across);
  }
  Vec2 center(std::size_t cell) const {
    return {(static_cast<double>(cell % across) + 0.5) / across,
            (static_cast<double>(cell / across) + 0.5) / down};
  }
};

/// A factor of f* over the picture, by which chains share their time: the second stage of two-stage
/// Metropolis light transport [VeachGuibas1997, Hoberock2010]. Any positive factor leaves the
/// expected picture as it is, for splats are divided by it.
class PictureImportance {
 public:
  /// One everywhere: time in proportion to luminance.
  PictureImportance() = default;
  /// For the least relative error of a picture of these luminances (in any unit), which need not be
  /// known well.
  PictureImportance(const PictureGrid& grid, std::span<const double> luminance);

  double operator()(const Vec2& raster) const { return cells_[grid_.cell(raster)]; }
  double least() const { return *std::ranges::min_element(cells_); }

 private:
  PictureGrid grid_;
  std::vector<double> cells_{1.0};
};

/// Of states that are given none.
inline const PictureImportance kUniformImportance;

}  // namespace fogbow
