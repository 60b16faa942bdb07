// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <vector>

#include "core/image/image.h"
#include "core/math/vec.h"

namespace fogbow {

/// Pixels [x, x + width) × [y, y + height) of an image, from its top left.
struct PixelRectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

struct ComparisonOptions {
  int tile_size = 16;
  std::vector<PixelRectangle> exclude;
  /// R, G, B are the standard errors of image or reference; null: its Error.* channels, zero if it
  /// has none.
  const Image* image_error = nullptr;
  const Image* reference_error = nullptr;
  /// Count pixels that are not finite and leave them out, instead of throwing.
  bool skip_non_finite = false;
};

/// A tile's luminance; the tiles at the right and lower border may be smaller.
struct TileDifference {
  PixelRectangle area;
  std::int64_t pixels = 0;  ///< that were compared
  double image = 0, reference = 0;
  double standard_error = 0;  ///< of the difference, pixels taken as independent
  double z = 0;               ///< difference / standard_error; 0 where there is no standard error
};

struct ComparisonResult {
  std::int64_t pixels = 0;  ///< that were compared
  std::int64_t non_finite_image = 0, non_finite_reference = 0;
  double mse = 0;      ///< mean of (I−R)² over pixels and channels
  double rel_mse = 0;  ///< mean of (I−R)²/(R² + 0.01·L²), L the reference's mean luminance
  double rel_mse_epsilon = 0;  ///< 0.01·L²
  RGB mean_image{0}, mean_reference{0};
  RGB mean_ratio{0};           ///< of the means, a channel each; NaN where both are zero
  double luminance_ratio = 0;  ///< of the mean luminances
  double luminance_ratio_error =
      0;  ///< its standard error, from those of pixels or of b; 0 without any

  std::vector<TileDifference> tiles;  ///< row-major; those fully excluded are missing
  bool has_errors = false;        ///< some standard errors were given: what follows has a meaning
  std::int64_t tested_tiles = 0;  ///< with a standard error: the degrees of freedom of chi2
  double chi2 = 0;                ///< Σ z² over tested tiles
  double fraction_above_2 = 0,
         fraction_above_3 = 0;  ///< of tested tiles, |z|; normal: 0.0455, 0.0027
  double max_abs_z = 0;
  /// Tiles that differ although both errors are exactly zero.
  std::int64_t unexplained_tiles = 0;
};

/// Compares R, G, B. Throws Error(InputOutput) where size or channels do not allow it or nothing is
/// left to compare, Error(Numerical) on pixels that are not finite, with their number and the first
/// place.
ComparisonResult compare_images(const Image& image, const Image& reference,
                                const ComparisonOptions& options = {});

/// Indices of tiles, the worst first: by |z| with errors, else by relative difference.
std::vector<std::size_t> worst_tiles(const ComparisonResult& result, std::size_t count);

enum class DifferenceStyle {
  Signed,      ///< image − reference
  FalseColor,  ///< relative luminance difference: red brighter, blue darker, white equal; saturated
               ///< at `range`
};
/// Not finite where either image is not.
Image difference_image(const Image& image, const Image& reference, DifferenceStyle style,
                       double range = 0.25);

}  // namespace fogbow
