// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/compare.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include "core/image/image_metadata.h"
#include "core/util/check.h"
#include "core/util/error.h"

namespace fogbow {
namespace {

/// Three channels of an image; absent ones are black.
class ColorView {
 public:
  ColorView(const Image& image, const std::string& prefix) : image_(image) {
    for (int c = 0; c < 3; ++c) index_[c] = image.channel(prefix + "RGB"[c]);
  }
  bool complete() const { return *std::min_element(index_.begin(), index_.end()) >= 0; }
  RGB operator()(int x, int y) const {
    return {image_.at(x, y, index_[0]), image_.at(x, y, index_[1]), image_.at(x, y, index_[2])};
  }

 private:
  const Image& image_;
  std::array<int, 3> index_;
};

ColorView color(const Image& image, const char* what) {
  const ColorView view(image, "");
  if (!view.complete())
    throw Error(ErrorKind::InputOutput, std::string(what) + " has no channels R, G, B");
  return view;
}

void require_same_size(const Image& a, const Image& b, const char* what) {
  if (a.width != b.width || a.height != b.height)
    throw Error(ErrorKind::InputOutput, std::string(what) + " has " + std::to_string(b.width) +
                                            "x" + std::to_string(b.height) + " pixels, the image " +
                                            std::to_string(a.width) + "x" +
                                            std::to_string(a.height));
}

/// Standard errors of luminance: those of the channels are taken as fully correlated, as
/// Film::develop makes them.
class ErrorView {
 public:
  ErrorView(const Image& image, const Image* separate, const char* what)
      : view_(separate ? color(*separate, what) : ColorView(image, "Error.")),
        present_(view_.complete()) {
    if (separate) require_same_size(image, *separate, what);
    const double b = attribute(image, kMetadataB), error = attribute(image, kMetadataBError);
    if (b > 0 && error > 0) relative_b_error_ = error / b;
  }
  bool present() const { return present_; }
  double variance(int x, int y) const { return present_ ? sqr(luminance(view_(x, y))) : 0; }
  /// Of the mean luminance, from the sum of the pixels' variances: pixels of chains are not
  /// independent, and what the render says of b is then the larger.
  double mean_variance(double sum, double mean, double pixels) const {
    return std::max(sum / sqr(pixels), sqr(relative_b_error_ * mean));
  }

 private:
  static double attribute(const Image& image, const char* name) {
    const auto found = image.metadata.find(name);
    const auto* value =
        found == image.metadata.end() ? nullptr : std::get_if<float>(&found->second);
    return value ? *value : 0;
  }

  ColorView view_;
  bool present_;
  double relative_b_error_ = 0;
};

std::vector<bool> excluded_pixels(const Image& image, const std::vector<PixelRectangle>& areas) {
  std::vector<bool> excluded(static_cast<std::size_t>(image.width) * image.height);
  for (const PixelRectangle& area : areas)
    for (int y = std::max(0, area.y); y < std::min(image.height, area.y + area.height); ++y)
      for (int x = std::max(0, area.x); x < std::min(image.width, area.x + area.width); ++x)
        excluded[static_cast<std::size_t>(y) * image.width + x] = true;
  return excluded;
}

class Comparison {
 public:
  Comparison(const Image& image, const Image& reference, const ComparisonOptions& options)
      : size_(image),
        tile_size_(options.tile_size),
        image_(color(image, "the image")),
        reference_(color(reference, "the reference")),
        image_error_(image, options.image_error, "the image's error"),
        reference_error_(reference, options.reference_error, "the reference's error"),
        skip_(excluded_pixels(image, options.exclude)) {
    require_same_size(image, reference, "the reference");
  }

  ComparisonResult run(bool skip_non_finite) {
    reject_non_finite(skip_non_finite);
    means();
    squared_errors();
    tiles();
    return std::move(result_);
  }

 private:
  template <class F>
  void for_each_pixel(const PixelRectangle& area, F&& visit) const {
    for (int y = area.y; y < area.y + area.height; ++y)
      for (int x = area.x; x < area.x + area.width; ++x)
        if (!skip_[static_cast<std::size_t>(y) * size_.width + x]) visit(x, y);
  }
  PixelRectangle whole() const { return {0, 0, size_.width, size_.height}; }

  void reject_non_finite(bool go_on) {
    std::string first;
    for_each_pixel(whole(), [&](int x, int y) {
      const bool bad_image =
          !is_finite(image_(x, y)) || !std::isfinite(image_error_.variance(x, y));
      const bool bad_reference =
          !is_finite(reference_(x, y)) || !std::isfinite(reference_error_.variance(x, y));
      result_.non_finite_image += bad_image;
      result_.non_finite_reference += bad_reference;
      if (!bad_image && !bad_reference) return;
      skip_[static_cast<std::size_t>(y) * size_.width + x] = true;
      if (first.empty()) first = std::to_string(x) + "," + std::to_string(y);
    });
    if (!first.empty() && !go_on)
      throw Error(ErrorKind::Numerical,
                  "pixels that are not finite: " + std::to_string(result_.non_finite_image) +
                      " in the image, " + std::to_string(result_.non_finite_reference) +
                      " in the reference, the first at " + first);
  }

  void means() {
    double variance_image = 0, variance_reference = 0;
    for_each_pixel(whole(), [&](int x, int y) {
      ++result_.pixels;
      result_.mean_image += image_(x, y);
      result_.mean_reference += reference_(x, y);
      variance_image += image_error_.variance(x, y);
      variance_reference += reference_error_.variance(x, y);
    });
    if (result_.pixels == 0) throw Error(ErrorKind::InputOutput, "no pixels are left to compare");
    const double n = static_cast<double>(result_.pixels);
    result_.mean_image /= n;
    result_.mean_reference /= n;
    result_.mean_ratio = result_.mean_image / result_.mean_reference;
    const double a = luminance(result_.mean_image), b = luminance(result_.mean_reference);
    result_.luminance_ratio = a / b;
    result_.luminance_ratio_error =
        std::sqrt(image_error_.mean_variance(variance_image, a, n) +
                  sqr(a / b) * reference_error_.mean_variance(variance_reference, b, n)) /
        std::fabs(b);
  }

  void squared_errors() {
    const double epsilon = 0.01 * sqr(luminance(result_.mean_reference));
    double sum = 0, relative = 0;
    for_each_pixel(whole(), [&](int x, int y) {
      const RGB r = reference_(x, y), d = image_(x, y) - r;
      for (int c = 0; c < 3; ++c) {
        sum += sqr(d[c]);
        // 0/0 in a black reference: no difference is no error.
        if (d[c] != 0) relative += sqr(d[c]) / (sqr(r[c]) + epsilon);
      }
    });
    result_.mse = sum / (3 * static_cast<double>(result_.pixels));
    result_.rel_mse = relative / (3 * static_cast<double>(result_.pixels));
    result_.rel_mse_epsilon = epsilon;
  }

  TileDifference tile(const PixelRectangle& area) const {
    TileDifference tile{.area = area};
    double variance = 0;
    for_each_pixel(area, [&](int x, int y) {
      ++tile.pixels;
      tile.image += luminance(image_(x, y));
      tile.reference += luminance(reference_(x, y));
      variance += image_error_.variance(x, y) + reference_error_.variance(x, y);
    });
    if (tile.pixels == 0) return tile;
    const double n = static_cast<double>(tile.pixels);
    tile.image /= n;
    tile.reference /= n;
    tile.standard_error = std::sqrt(variance) / n;
    if (variance > 0) tile.z = (tile.image - tile.reference) / tile.standard_error;
    return tile;
  }

  void tiles() {
    result_.has_errors = image_error_.present() || reference_error_.present();
    std::int64_t above_2 = 0, above_3 = 0;
    for (int y = 0; y < size_.height; y += tile_size_)
      for (int x = 0; x < size_.width; x += tile_size_) {
        const TileDifference t = tile(
            {x, y, std::min(tile_size_, size_.width - x), std::min(tile_size_, size_.height - y)});
        if (t.pixels == 0) continue;
        result_.tiles.push_back(t);
        if (!(t.standard_error > 0)) {
          result_.unexplained_tiles += result_.has_errors && t.image != t.reference;
          continue;
        }
        ++result_.tested_tiles;
        result_.chi2 += sqr(t.z);
        above_2 += std::fabs(t.z) > 2;
        above_3 += std::fabs(t.z) > 3;
        result_.max_abs_z = std::max(result_.max_abs_z, std::fabs(t.z));
      }
    if (result_.tested_tiles == 0) return;
    result_.fraction_above_2 = static_cast<double>(above_2) / result_.tested_tiles;
    result_.fraction_above_3 = static_cast<double>(above_3) / result_.tested_tiles;
  }

  const Image& size_;
  int tile_size_;
  ColorView image_, reference_;
  ErrorView image_error_, reference_error_;
  std::vector<bool> skip_;
  ComparisonResult result_;
};

/// White at 0, towards red at +1 and blue at −1.
RGB false_color(double t) {
  t = std::clamp(t, -1.0, 1.0);
  return t > 0 ? RGB(1, 1 - t, 1 - t) : RGB(1 + t, 1 + t, 1);
}

}  // namespace

ComparisonResult compare_images(const Image& image, const Image& reference,
                                const ComparisonOptions& options) {
  FOGBOW_CHECK(options.tile_size > 0);
  return Comparison(image, reference, options).run(options.skip_non_finite);
}

std::vector<std::size_t> worst_tiles(const ComparisonResult& result, std::size_t count) {
  std::vector<std::size_t> order(result.tiles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const double floor = std::sqrt(result.rel_mse_epsilon);
  const auto badness = [&](std::size_t i) {
    const TileDifference& t = result.tiles[i];
    const double difference = std::fabs(t.image - t.reference);
    if (difference == 0) return 0.0;
    if (!result.has_errors) return difference / std::hypot(t.reference, floor);
    return t.standard_error > 0 ? std::fabs(t.z) : kInfinity;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return badness(a) > badness(b); });
  order.resize(std::min(count, order.size()));
  return order;
}

Image difference_image(const Image& image, const Image& reference, DifferenceStyle style,
                       double range) {
  require_same_size(image, reference, "the reference");
  const ColorView a = color(image, "the image"), b = color(reference, "the reference");
  Image result(image.width, image.height, {"R", "G", "B"});
  result.x = image.x;
  result.y = image.y;
  result.full_width = image.full_width;
  result.full_height = image.full_height;
  double mean = 0;
  std::int64_t finite = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      if (is_finite(b(x, y))) {
        mean += luminance(b(x, y));
        ++finite;
      }
  if (finite > 0) mean /= static_cast<double>(finite);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      RGB d = a(x, y) - b(x, y);
      if (style == DifferenceStyle::FalseColor) {
        // The same floor as relMSE's: a tenth of the mean luminance.
        const double scale = range * std::hypot(luminance(b(x, y)), 0.1 * mean);
        const double difference = luminance(d);
        d = std::isfinite(difference) ? false_color(difference == 0 ? 0 : difference / scale)
                                      : RGB(std::numeric_limits<double>::quiet_NaN());
      }
      for (int c = 0; c < 3; ++c) result.at(x, y, c) = static_cast<float>(d[c]);
    }
  return result;
}

}  // namespace fogbow
