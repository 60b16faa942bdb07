// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "core/estimators/estimator.h"
#include "core/image/film.h"
#include "core/util/rng.h"

namespace fogbow {

/// Σ luminance of contributions by path length k and group.
using LengthTally = std::array<std::vector<double>, Film::kGroups>;

/// Renders with independent samples, one a pixel and round; film and tally do not depend on the
/// number of threads.
class IndependentSampling {
 public:
  /// `unit_exponent`: of the film. With `only_length` > 0 the film takes the paths of so many
  /// vertices alone.
  IndependentSampling(const Estimator& estimator, const FilmSettings& settings, std::uint64_t seed,
                      int unit_exponent, int only_length = 0);

  void run_round();

  const Film& film() const { return film_; }
  std::uint64_t samples() const { return samples_; }
  std::uint64_t refused() const { return refused_ + film_.refused(); }
  LengthTally tally() const;
  /// The part of it that is, or is not, seen light of media.
  const LengthTally& tally(bool glow) const { return tallies_[glow]; }
  /// Mean luminance and the standard error between groups.
  Image develop() const;
  int width() const { return width_; }
  int height() const { return height_; }

 private:
  struct Row;
  void run_row(int row, Row& result);

  const Estimator& estimator_;
  Film film_;
  std::uint64_t seed_;
  int only_length_;
  int width_, height_;
  std::uint64_t round_ = 0, samples_ = 0, refused_ = 0;
  std::array<LengthTally, 2> tallies_;  ///< the second of glow
};

/// Width and height of the part of the film that is rendered.
std::pair<int, int> rendered_size(const FilmSettings& settings);

inline constexpr std::uint64_t kLuminancePilot = 4096;
/// What `estimator` finds in so many samples, or in more up to `most` as long as it finds nothing.
double mean_luminance(const Estimator& estimator, std::uint64_t seed,
                      std::uint64_t most = kLuminancePilot);

/// e with 2^e > the mean luminance that `estimator` finds in some samples; throws Error(NoLight) if
/// it finds none.
int luminance_exponent(const Estimator& estimator, std::uint64_t seed);

/// Uniform numbers from a generator.
class RandomStream final : public SampleStream {
 public:
  explicit RandomStream(Rng& rng) : rng_(rng) {}
  double next() override { return rng_.uniform(); }

 private:
  Rng& rng_;
};

/// Uniform numbers whose first two lie in one pixel: stratification of the raster.
class PixelStream final : public SampleStream {
 public:
  PixelStream(Rng& rng, const Vec2& corner, const Vec2& size)
      : rng_(rng), corner_(corner), size_(size) {}
  double next() override {
    const double u = rng_.uniform();
    if (count_ >= 2) return u;
    const int axis = count_++;
    return std::min(corner_[axis] + u * size_[axis], kOneMinusEpsilon);
  }

 private:
  Rng& rng_;
  Vec2 corner_, size_;
  int count_ = 0;
};

}  // namespace fogbow
