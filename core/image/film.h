// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

#include "core/image/filter.h"
#include "core/image/image.h"
#include "core/math/vec.h"

namespace fogbow {

struct FilmSettings {
  int width = 768, height = 576;
  /// The part that is rendered, in pixels of the whole picture; width 0 means all.
  int crop_x = 0, crop_y = 0, crop_width = 0, crop_height = 0;
  std::shared_ptr<const ReconstructionFilter> filter;  ///< null: the default gaussian
};

/// Sums of splats in 64-bit fixed point: they do not depend on order. Splats from any number of
/// threads. Overflow throws Error(Numerical); a non-finite splat is refused and counted.
class Film {
 public:
  static constexpr int kGroups = 8;
  static constexpr int kMaxUnitExponent = 1000;  ///< in magnitude

  /// `unit_exponent`: one count is 2^unit_exponent of a splat's value.
  /// Throws Error(Usage) on impossible sizes, Error(Memory) where the film does not fit.
  Film(const FilmSettings& settings, int unit_exponent);

  /// Adds to the one pixel that the reconstruction filter, importance-sampled by `u`, chooses
  /// around `raster` (in [0,1)² of the crop window). `group` in [0, kGroups) is the independent
  /// replicate that the splat belongs to.
  void splat(const Vec2& raster, const RGB& value, int group, const Vec2& u) {
    if (const auto placed = place(raster, value, group, u)) add(*placed);
  }

  /// A splat's pixel and counts, before they are added.
  struct Placed {
    std::size_t pixel = 0;
    int group = 0;
    std::array<std::int64_t, 3> rgb{};
    std::int64_t luminance = 0;
  };
  /// Nothing where the splat is black, refused, or reaches no pixel; the pixel's sums are fetched
  /// into the cache meanwhile.
  std::optional<Placed> place(const Vec2& raster, const RGB& value, int group, const Vec2& u);
  void add(const Placed& splat);

  /// Adds another film of the same settings and unit; throws Error(Usage) on any other.
  void add(const Film& other);

  /// R, G, B = `scale` × sum × pixel count, and Error.R, .G, .B: the standard error of that mean
  /// between groups, where group g was given the weight `group_scale[g]` (its own sum ×
  /// group_scale[g] × pixel count estimates the same picture). Error is estimated from luminance
  /// and spread over the channels in proportion. A group of weight 0 has taken no part; with fewer
  /// than two that have there are no Error layers. Throws Error(Numerical) on pixels beyond
  /// float32. With unit-integral W_e a scale of 1/samples makes pixels of radiance.
  Image develop(double scale, const std::vector<double>& group_scale) const;

  /// With the crop window and filter filled in.
  const FilmSettings& settings() const { return settings_; }
  int unit_exponent() const { return unit_exponent_; }
  /// Splats that were not finite.
  std::uint64_t refused() const { return refused_; }
  /// Of a film with these settings.
  static std::size_t memory_bytes(const FilmSettings& settings);

  void serialize(std::ostream& out) const;
  /// Throws Error(InputOutput) on a broken stream or one of a film of other settings.
  static Film deserialize(std::istream& in, const FilmSettings& settings);

  Film(Film&&) noexcept;
  Film& operator=(Film&&) noexcept;

 private:
  void set_unit(int exponent);
  std::size_t group_place(const Placed& splat) const;
  std::int64_t to_count(double value) const;
  void add_error_layers(Image& image, double scale, const std::vector<double>& group_scale) const;

  FilmSettings settings_;
  int unit_exponent_;
  double counts_per_unit_;
  std::vector<double> column_mass_,
      row_mass_;  ///< Z_j = column × row: the part of a pixel's filter on the crop window
  std::vector<std::atomic<std::int64_t>> rgb_;    ///< 3 a pixel
  std::vector<std::atomic<std::int64_t>> group_;  ///< luminance, one group after the other
  std::atomic<std::uint64_t> refused_{0};
};

/// Splats of one thread on their way: sums that are not in the cache cost a wait each, unless they
/// are asked for some splats ahead. What was not flushed is lost.
class SplatQueue {
 public:
  explicit SplatQueue(Film& film) : film_(film) {}

  void splat(const Vec2& raster, const RGB& value, int group, const Vec2& u) {
    if (size_ == queue_.size()) flush();
    if (const auto placed = film_.place(raster, value, group, u)) queue_[size_++] = *placed;
  }
  void flush() {
    for (std::size_t i = 0; i < size_; ++i) film_.add(queue_[i]);
    size_ = 0;
  }

 private:
  Film& film_;
  std::array<Film::Placed, 32> queue_;
  std::size_t size_ = 0;
};

}  // namespace fogbow
