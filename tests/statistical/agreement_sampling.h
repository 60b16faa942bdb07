// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/estimators/estimator.h"
#include "core/path/path.h"
#include "tests/helpers/statistics.h"

namespace fogbow::testing {

/// What a comparison is to detect with 99% probability, in parts of the true value.
struct Precision {
  double mean = 0;  ///< of the image
  double part = 0;  ///< of a notable path length or tile
};
/// Path lengths with so much of the energy, and tiles with so much of the mean tile's, are notable;
/// the others are compared as one.
inline constexpr double kNotableLength = 0.05, kNotableTile = 0.5;

/// Which samplers have a technique that makes the path, decided by its configuration: technique s
/// needs x_s and x_{s+1} non-degenerate, s = 0 an x₁ that can be run into. path has s = 0, and s =
/// 1 if k > 2; light has s = k − 1.
struct Reach {
  bool path = false, light = false;
};
Reach reach(const Scene& scene, const Path& path);

/// Nearer to the lens than this part of the scene's radius, 1/d² gives light tracing in fog an
/// infinite variance; such paths stay out of its comparisons on both sides.
inline constexpr double kNearLens = 0.15;

enum class Restriction : std::size_t { All, ByPath, ByLight };

/// Luminance by path length and tile (and the mean of each channel), in independent replicates.
class Replicates {
 public:
  Replicates(int replicates, int longest);

  void add_pixel(int replicate, const Vec2& raster, const RGB& value);
  void add_length(int replicate, int k, double value);
  void scale(double factor);

  Estimate mean() const { return sum({kMean}); }
  Estimate channel(int c) const { return sum({c}); }
  /// A part to be compared: a notable length or tile, or the sum of all that are not.
  struct Part {
    std::string name;
    bool notable = false;
    std::vector<int> columns;
  };
  /// As found here; the other side of a comparison is cut up in the same way.
  std::vector<Part> parts() const;
  Estimate sum(const std::vector<int>& columns) const;
  int count() const { return static_cast<int>(rows_.size()); }

 private:
  static constexpr int kTilesAcross = 4, kTiles = kTilesAcross * kTilesAcross;
  static constexpr int kMean = 3, kFirstTile = 4, kFirstLength = kFirstTile + kTiles;

  std::vector<std::vector<double>> rows_;
};

/// One Replicates for each Restriction: each contribution is assembled into its path again. Not
/// `classified`: one for All, which the path tracer needs, as it keeps no subpaths.
using Sampling = std::vector<Replicates>;
Sampling sample(const Scene& scene, const Estimator& estimator, bool classified, int longest,
                int replicates, std::uint64_t samples, std::uint64_t seed);
struct ChainSettings {
  std::string integrator;  ///< pssmlt or mlt
  int longest;
  bool two_stage;
};
/// Independent renders of so many mutations.
Sampling render_chains(const Scene& scene, const ChainSettings& settings, int replicates,
                       std::uint64_t mutations, std::uint64_t seed);

/// Runs an independent pilot to learn how many samples `precision` takes at `level`, then those.
using Sampler = std::function<Sampling(std::uint64_t samples, std::uint64_t seed)>;
Sampling sample_until(const Sampler& sampler, std::uint64_t pilot_samples, Precision precision,
                      double level, std::uint64_t seed);

/// Welch's t-test of the image mean, channels and parts at `level`, each with its power;
/// expectations fail on either. Prints one line. Returns the number of tests.
int expect_agreement(const std::string& name, const Replicates& a, const Replicates& b,
                     Precision precision, double level);

}  // namespace fogbow::testing
