// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/transport.h"

#include <gtest/gtest.h>

#include <map>

#include "core/geometry/shapes.h"
#include "core/math/random.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
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

/// A pinhole at the origin that looks along +z, from 0.5 to 2 of it in front, and what stands
/// there.
Scene clipped_scene(std::initializer_list<double> walls) {
  SceneDescription d;
  d.film = {16, 16, 0, 0, 0, 0, make_box_filter()};
  PerspectiveSettings s;
  s.width = s.height = 16;
  s.fov_x_degrees = 90;
  s.near_clip = 0.5;
  s.far_clip = 2;
  d.sensor = make_perspective_sensor(s);
  d.emitters = {make_constant_emitter(RGB(1))};
  for (const double z : walls) {
    Surface& wall = d.surfaces.emplace_back();
    wall.shape = make_rectangle(Transform::translate({0, 0, z}) * Transform::scale(Vec3(5)));
    wall.bsdf = make_diffuse(RGB(0.5));
  }
  return Scene(std::move(d));
}

/// Planes across the axis: beside it, they are farther away.
TEST(Connect, ReachesTheEyeFromBetweenItsClips) {
  const Scene scene = clipped_scene({});
  Vertex light;
  light.kind = VertexKind::PointLight;
  for (const double x : {0.0, 0.8})
    for (const double z : {0.49, 0.51, 1.0, 1.99, 2.01}) {
      light.point.position = Vec3(x * z, 0, z);
      EXPECT_EQ(connect(scene, light, sensor_vertex(scene)).has_value(), z > 0.5 && z < 2) << z;
    }
}

/// What stands beyond the clips hides neither a light between them nor the sky.
TEST(Connect, SeesThroughWhatIsClipped) {
  Vertex light, sky;
  light.kind = VertexKind::PointLight;
  light.point.position = Vec3(0.3, 0.1, 1.5);
  sky.kind = VertexKind::InfiniteLight;
  sky.point.n_g = normalize(Vec3(-0.2, 0.1, -1));
  const auto seen = [](const Scene& scene, const Vertex& x) {
    return connect(scene, x, sensor_vertex(scene)).has_value();
  };
  const Scene clear = clipped_scene({0.3, 2.5}), walled = clipped_scene({1});
  EXPECT_TRUE(seen(clear, light));
  EXPECT_TRUE(seen(clear, sky));
  EXPECT_FALSE(seen(walled, light));
  EXPECT_FALSE(seen(walled, sky));
}

/// Profiles are used for one ray after another, and remember what they were asked.
TEST(RayProfile, ForgetsTheRayBefore) {
  const Scene scene(testing::make_test_scene("patchy-flame"));
  const Vertex x = sensor_vertex(scene);
  RayProfile used;
  int different = 0;
  RGB before(0);
  for (int i = 0; i < 200; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, 6, i);
    const SensorRay ray = scene.sensor().sample_direction(x.position(), uniform2(rng));
    RayProfile fresh;
    used.trace(scene, x, ray.w);
    fresh.trace(scene, x, ray.w);
    constexpr double t = 3;
    const RGB tau = fresh.tau_q(t);
    ASSERT_EQ(used.tau_q(t), tau);
    different += tau != before;
    before = tau;
  }
  EXPECT_GT(different, 20);
}

}  // namespace
}  // namespace fogbow
