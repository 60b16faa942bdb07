// SPDX-License-Identifier: GPL-3.0-or-later
// Path tracing by null collisions, which knows media only by their coefficients at points, against
// exact tracking with everything that rests on it: equal pictures in homogeneous and heterogeneous,
// chromatic and emissive media.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "core/estimators/sampling.h"
#include "core/geometry/shapes.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
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

/// The sky straight through a pane: with Fresnel's R = ((η − 1)/(η + 1))² it passes 1 − 2R/(1 + R)
/// of its tint, channel by channel, though all of them pass or stop at once.
TEST(NullCollisions, PanesPassTheirColours) {
  const RGB tint(0.9, 0.5, 0.1);
  SceneDescription d;
  d.film = {4, 4, 0, 0, 0, 0, make_box_filter()};
  PerspectiveSettings camera;
  camera.width = camera.height = 4;
  camera.fov_x_degrees = 0.1;
  d.sensor = make_perspective_sensor(camera);
  d.emitters = {make_constant_emitter(RGB(1))};
  Surface& pane = d.surfaces.emplace_back();
  pane.shape = make_rectangle(Transform::translate({0, 0, 3}));
  pane.bsdf = make_thin_dielectric(1.5, RGB(1), tint);
  const Scene scene(std::move(d));
  const auto path = make_path_tracer(scene, {.max_depth = 1, .null_collisions = true});
  constexpr int kSamples = 40000;
  RGB sum(0);
  Workspace w;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    Rng rng(suite_seed(), RngDomain::Test, 99, i);
    RandomStream stream(rng);
    path->sample(stream, stream, w);
    for (const Contribution& c : w.contributions) sum += c.value / double(kSamples);
  }
  const double R = sqr(0.5 / 2.5);
  // 4.5 standard errors of the brightest channel.
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(sum[c] / (tint[c] * (1 - 2 * R / (1 + R))), 1, 0.025);
}

}  // namespace
}  // namespace fogbow::testing
