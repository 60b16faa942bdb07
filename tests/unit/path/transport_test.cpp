// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/transport.h"

#include <gtest/gtest.h>

#include <map>

#include "core/math/random.h"
#include "core/scene/bsdf/bsdfs.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

Vertex sensor_vertex(const Scene& scene) {
  Vertex x;
  x.kind = VertexKind::Sensor;
  x.point.position = scene.sensor().sample_position(Vec2(0.5));
  x.medium = scene.sensor_medium();
  return x;
}

/// Through two nested chromatic media to a wall, free flight falls where q(t) and Q_M say.
TEST(Extend, DistancesFollowTheirDensity) {
  const Scene scene(testing::make_test_scene("nested-media"));
  const Vertex x = sensor_vertex(scene);
  const Vec3 w = normalize(Vec3(0.05, 0, 0) - x.position());
  constexpr int kSamples = 200000, kCells = 60;
  // The wall behind the scene is missed: the way ends at infinity.
  const double t0 = 1.5, t1 = 5;
  std::vector<std::uint64_t> counts(kCells + 1);
  std::vector<double> expected(kCells + 1);
  for (int i = 0; i < kSamples; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, 3, i);
    Vertex y;
    Edge edge;
    const auto result = extend(scene, x, w, uniform2(rng), y, edge);
    const bool scattered = result == ExtendResult::Reached && y.in_medium();
    const int cell = scattered ? static_cast<int>((edge.length - t0) / (t1 - t0) * kCells) : kCells;
    ASSERT_GE(cell, 0);
    ++counts[cell];
  }
  double inside = 0;
  for (int cell = 0; cell < kCells; ++cell) {
    constexpr int kPoints = 400;
    for (int j = 0; j < kPoints; ++j) {
      const double t = t0 + (t1 - t0) * (cell + (j + 0.5) / kPoints) / kCells;
      Edge edge;
      if (const auto y = medium_vertex_at(scene, x, w, t, 0, edge))
        expected[cell] += kSamples * pdf_distance(scene, edge, *y) * (t1 - t0) / kCells / kPoints;
    }
    inside += expected[cell];
  }
  expected[kCells] = kSamples - inside;
  EXPECT_GT(testing::chi2_test(counts, expected), testing::kSuiteFalseAlarm);
}

TEST(Extend, DistanceInvertsToUniformNumbersThatLeadBack) {
  const Scene scene(testing::make_test_scene("nested-media"));
  const Vertex x = sensor_vertex(scene);
  std::vector<double> channel, distance;
  for (int i = 0; i < 20000; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, 4, i);
    const Vec3 target(0.4 * rng.uniform() - 0.2, -0.9 * rng.uniform(), 0);
    const Vec3 w = normalize(target - x.position());
    Vertex y, again;
    Edge edge, edge_again;
    const auto result = extend(scene, x, w, uniform2(rng), y, edge);
    const Vec2 u = invert_distance(scene, edge, y, uniform2(rng));
    ASSERT_EQ(extend(scene, x, w, u, again, edge_again), result);
    if (result == ExtendResult::Reached) {
      ASSERT_EQ(again.kind, y.kind);
      ASSERT_NEAR(edge_again.length, edge.length, 1e-9 * edge.length);
    }
    channel.push_back(u.x);
    distance.push_back(u.y);
  }
  EXPECT_GT(testing::uniform_ks_test(channel), testing::sidak(testing::kSuiteFalseAlarm, 2));
  EXPECT_GT(testing::uniform_ks_test(distance), testing::sidak(testing::kSuiteFalseAlarm, 2));
}

/// Through a mask that lets half of the light pass, a chromatic pane and fog behind both: every
/// kind of end is met as often as pdf_distance() says, and inverts to what leads there.
TEST(Extend, SurfacesThatPassLightInPartStopTheRest) {
  SceneDescription d = testing::make_test_scene("nested-media");
  const RGB tint(0.9, 0.6, 0.3);
  for (Surface& s : d.surfaces)
    if (s.medium_boundary && s.interior && s.exterior)
      s.bsdf = make_mask(make_diffuse(RGB(1)), 0.5);
    else if (s.medium_boundary)
      s.bsdf = make_thin_dielectric(1.5, RGB(1), tint);
  const Scene scene(std::move(d));
  const Vertex x = sensor_vertex(scene);
  const Vec3 w = normalize(Vec3(0.05, 0, 0) - x.position());
  constexpr int kSamples = 100000;
  std::map<double, int> walls;
  std::map<double, double> mass;
  int in_media = 0;
  std::vector<double> channel, distance;
  for (int i = 0; i < kSamples; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, 6, i);
    Vertex y, again;
    Edge edge, edge_again;
    const auto result = extend(scene, x, w, uniform2(rng), y, edge);
    const Vec2 u = invert_distance(scene, edge, y, uniform2(rng));
    ASSERT_EQ(extend(scene, x, w, u, again, edge_again), result);
    if (result == ExtendResult::Reached) {
      ASSERT_NEAR(edge_again.length, edge.length, 1e-9 * edge.length);
    }
    channel.push_back(u.x);
    distance.push_back(u.y);
    if (y.in_medium() && result == ExtendResult::Reached) {
      ++in_media;
      continue;
    }
    ++walls[edge.length];
    mass[edge.length] =
        result == ExtendResult::Reached ? pdf_distance(scene, edge, y) : mean(edge.tau_q);
    if (result == ExtendResult::Reached) {
      const auto straight = connect(scene, y, x);
      ASSERT_TRUE(straight);
      ASSERT_EQ(straight->passages, edge.passages);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(straight->tau[c], edge.tau[c], 1e-12);
    }
  }
  EXPECT_GE(walls.size(), 5u) << "two walls of either boundary, and the way out";
  std::vector<std::uint64_t> counts{static_cast<std::uint64_t>(in_media)};
  std::vector<double> expected{kSamples};
  for (const auto& [t, count] : walls) {
    counts.push_back(count);
    expected.push_back(kSamples * mass[t]);
    expected[0] -= kSamples * mass[t];
  }
  EXPECT_GT(testing::chi2_test(counts, expected), testing::kSuiteFalseAlarm);
  EXPECT_GT(testing::uniform_ks_test(channel), testing::sidak(testing::kSuiteFalseAlarm, 2));
  EXPECT_GT(testing::uniform_ks_test(distance), testing::sidak(testing::kSuiteFalseAlarm, 2));
}

/// f_s of a pane of n layers of masks is the product of what passes.
TEST(Connect, MultipliesWhatSurfacesPass) {
  SceneDescription d = testing::make_test_scene("nested-media");
  for (Surface& s : d.surfaces) {
    if (!s.medium_boundary) continue;
    s.medium_boundary = false;
    s.interior = s.exterior = nullptr;
    s.bsdf = make_mask(make_diffuse(RGB(1)), 0.25);
  }
  const Scene scene(std::move(d));
  const Vertex x = sensor_vertex(scene);
  Vertex y = x;
  y.point.position = Vec3(0.1, 0, 0) - 3.0 * (x.position() - Vec3(0.1, 0, 0));
  const auto edge = connect(scene, y, x);
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->passages, 4);
  EXPECT_NEAR(edge->tau.x, std::pow(0.75, 4), 1e-14);
  EXPECT_NEAR(edge->tau_q.x, std::pow(0.75, 4), 1e-14);
}

TEST(Connect, SeesWhatExtendReached) {
  for (const auto& test : testing::test_scenes()) {
    const Scene scene(test.make());
    const Vertex x = sensor_vertex(scene);
    int reached = 0;
    for (int i = 0; i < 5000; ++i) {
      Rng rng(testing::suite_seed(), RngDomain::Test, 5, i);
      const SensorRay ray = scene.sensor().sample_direction(x.position(), uniform2(rng));
      Vertex y;
      Edge there;
      if (extend(scene, x, ray.w, uniform2(rng), y, there, scene.sensor().near_distance(ray.w)) !=
          ExtendResult::Reached)
        continue;
      ++reached;
      const auto back = connect(scene, y, x);
      ASSERT_TRUE(back) << test.name;
      ASSERT_NEAR(back->length, there.length, 1e-12 * there.length);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(back->tau[c], there.tau[c], 1e-12) << test.name;
    }
    EXPECT_GT(reached, 1000) << test.name;
  }
}

}  // namespace
}  // namespace fogbow
