// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/estimators/estimator.h"
#include "core/image/image.h"
#include "core/scene/scene.h"
#include "tests/helpers/statistics.h"

namespace fogbow::testing {

/// Of classes that are not compared one by one.
inline constexpr const char* kOtherClasses = "the others";
inline constexpr int kTile = 16;  // pixels
inline constexpr int kBlock = 4;  // tiles

/// Mitsuba 3 ends its shadow rays this part of their length before the lamp (ShadowEpsilon in
/// single precision) and takes the fog from the lamp to there for empty.
inline constexpr double kMitsubaShadowEpsilon = 8.940696716308594e-4;

/// Mean luminance of tiles.
struct Tiles {
  int across = 0;
  std::vector<std::vector<double>> replicates;
  /// By how much Mitsuba's fault makes a tile too bright at most: every path whose x₂ can be
  /// connected to a lamp in fog counts as if it had been.
  std::vector<double> excess;
  /// The part of it that lands by light tracing (t = 1), wherever samples are taken; empty for
  /// chains.
  std::vector<std::vector<double>> splats{};
  /// b_k^c by configuration, in each replicate; empty where the sampler does not tell.
  std::map<std::string, std::vector<double>> classes{};
  /// Their parts by where they come from: the blocks of pixels, and light tracing.
  std::map<std::string, std::vector<std::vector<double>>> class_sources{};

  std::size_t count() const { return excess.size(); }
  /// Blocks of kBlock × kBlock tiles.
  std::size_t blocks_across() const {
    return (static_cast<std::size_t>(across) + kBlock - 1) / kBlock;
  }
  std::size_t block_count() const { return block(count() - 1) + 1; }
  std::size_t block(std::size_t tile) const {
    const auto width = static_cast<std::size_t>(across);
    return tile / width / kBlock * blocks_across() + tile % width / kBlock;
  }
  Estimate estimate(const std::vector<std::size_t>& tiles) const;
  double mean_excess(const std::vector<std::size_t>& tiles) const;
  void add_class(const std::string& configuration, int replicate, double value);
};

/// What independent samples make: all of it, and what light tracing can make too (reach()).
struct Pictures {
  Tiles all, by_light;
};
/// Of the pixels of a block, in every replicate.
using SamplesPerPixel = std::function<int(std::size_t block)>;
/// `classified`: with excess, classes and by_light, which need every path in one piece; the path
/// tracer has none.
Pictures render_tiles(const Scene& scene, const Estimator& estimator, bool classified,
                      int replicates, const SamplesPerPixel& samples, std::uint64_t seed);
struct ChainOptions {
  std::string integrator;  ///< pssmlt or mlt
  int max_depth;
  std::string mutations;  ///< with weights; empty: the default ones
};
/// By independent renders.
Tiles render_tiles_by_chains(const Scene& scene, const ChainOptions& settings, int replicates,
                             double mutations_per_pixel, std::uint64_t seed);

/// The reference of scenes/NAME where `scene`'s crop window lies, and its standard errors.
struct Reference {
  Image mean, error;
  Estimate estimate(const std::vector<std::size_t>& tiles, const Tiles& like) const;
};
Reference read_reference(const std::string& name, const Scene& scene);

}  // namespace fogbow::testing
