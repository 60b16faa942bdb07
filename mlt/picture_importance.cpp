// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/picture_importance.h"

#include <cmath>
#include <numeric>

#include "core/util/check.h"

namespace fogbow {

namespace {

/// Luminance, in parts of the mean, below which errors are not asked for in proportion to it.
constexpr double kDark = 0.15;

}  // namespace

// With n samples spread as f* w, a pixel of luminance L has a variance ∝ L/(n w). The mean of
// variance / (L² + d²) is least where w ∝ 1/√(L² + d²).
PictureImportance::PictureImportance(const PictureGrid& grid, std::span<const double> luminance) {
  FOGBOW_CHECK(luminance.size() == grid.size());
  const double mean = std::accumulate(luminance.begin(), luminance.end(), 0.0) /
                      static_cast<double>(luminance.size());
  if (!(mean > 0)) return;
  grid_ = grid;
  cells_.clear();
  for (const double l : luminance) cells_.push_back(1 / std::hypot(l / mean, kDark));
}

}  // namespace fogbow
