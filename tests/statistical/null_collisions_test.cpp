// SPDX-License-Identifier: GPL-3.0-or-later
// Path tracing by null collisions, which knows media only by their coefficients at points, against
// exact tracking with everything that rests on it: equal pictures in homogeneous and heterogeneous,
// chromatic and emissive media.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/estimators/sampling.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow::testing {
namespace {

constexpr int kReplicates = 32, kRounds = 40, kOracleRounds = 160, kTiles = 2;
constexpr int kRegions = 3 + kTiles * kTiles;
const char* const kScenes[] = {"patchy-flame", "nested-media", "flame"};

/// Means of the channels, and of quarters of the picture, replicate by replicate.
std::array<Estimate, kRegions> regions(const Scene& scene, const Estimator& estimator, int rounds,
                                       std::uint64_t stream) {
  constexpr int kFractionBits = 30;
  const int exponent = luminance_exponent(estimator, suite_seed()) - kFractionBits;
  std::array<std::vector<double>, kRegions> values;
  for (int r = 0; r < kReplicates; ++r) {
    IndependentSampling sampling(estimator, scene.film(),
                                 suite_seed() + stream * kReplicates + r + 1, exponent);
    for (int i = 0; i < rounds; ++i) sampling.run_round();
    EXPECT_EQ(sampling.refused(), 0u);
    const Image image = sampling.develop();
    std::array<double, kRegions> sums{};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c) {
          const int tile = y * kTiles / image.height * kTiles + x * kTiles / image.width;
          for (const int region : {c, 3 + tile}) sums[region] += image.at(x, y, c);
        }
    for (int i = 0; i < kRegions; ++i) values[i].push_back(sums[i]);
  }
  std::array<Estimate, kRegions> result;
  for (int i = 0; i < kRegions; ++i) result[i] = estimate(values[i]);
  return result;
}

TEST(NullCollisions, PicturesAgreeWithExactTracking) {
  const double level = sidak(kSuiteFalseAlarm, kRegions * static_cast<int>(std::size(kScenes)));
  std::uint64_t stream = 1;
  for (const char* name : kScenes) {
    SCOPED_TRACE(name);
    const Scene scene(make_test_scene(name));
    const auto exact =
        regions(scene, *make_path_tracer(scene, {.max_depth = 8}), kRounds, stream++);
    const auto oracle =
        regions(scene, *make_path_tracer(scene, {.max_depth = 8, .null_collisions = true}),
                kOracleRounds, stream++);
    for (int i = 0; i < kRegions; ++i) {
      EXPECT_GT(welch(exact[i], oracle[i]), level)
          << "region " << i << ": " << exact[i].mean << " ± " << exact[i].standard_error
          << ", by null collisions " << oracle[i].mean << " ± " << oracle[i].standard_error;
    }
    const double bias = 0.05 * exact[1].mean, seen = power(exact[1], oracle[1], bias, level);
    EXPECT_GT(seen, 0.99) << "a bias of 5% would escape";
    std::printf("%-16s G %.4f ± %.4f, by null collisions %.4f ± %.4f; 5%% seen with %.4f\n", name,
                exact[1].mean, exact[1].standard_error, oracle[1].mean, oracle[1].standard_error,
                seen);
  }
}

}  // namespace
}  // namespace fogbow::testing
