// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/scene.h"

#include <gtest/gtest.h>

#include "core/geometry/shapes.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
#include "media/media.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

using MediumPointer = std::shared_ptr<const Medium>;
using ShapePointer = std::shared_ptr<const Shape>;

MediumPointer fog(const std::string& id, double emission = 0, double sigma_t = 1) {
  return make_homogeneous_medium(RGB(sigma_t), RGB(0.5), make_isotropic_phase(), RGB(emission), id);
}

Surface boundary(ShapePointer shape, MediumPointer interior, MediumPointer exterior,
                 const std::string& id) {
  Surface s;
  s.shape = std::move(shape);
  s.bsdf = make_null();
  s.medium_boundary = true;
  s.interior = std::move(interior);
  s.exterior = std::move(exterior);
  s.id = id;
  s.where = {"test.xml", 7, 3};
  return s;
}

Surface wall(ShapePointer shape) {
  Surface s;
  s.shape = std::move(shape);
  s.bsdf = make_diffuse(RGB(0.5));
  return s;
}

ShapePointer cube(double half, const Vec3& center = Vec3(0)) {
  return make_cube(Transform::translate(center) * Transform::scale(Vec3(half)));
}

SceneDescription seen_from(const Vec3& origin, std::vector<Surface> surfaces) {
  SceneDescription d;
  d.surfaces = std::move(surfaces);
  PerspectiveSettings camera;
  camera.to_world = Transform::look_at(origin, origin + Vec3(0.1, 0.2, 1), {0, 1, 0});
  d.sensor = make_perspective_sensor(camera);
  d.emitters.push_back(make_point_emitter(origin + Vec3(0.01, 0, 0), RGB(1)));
  return d;
}

int count_with(const Scene& scene, const std::string& text) {
  int count = 0;
  for (const std::string& w : scene.warnings()) count += w.find(text) != std::string::npos;
  return count;
}

TEST(MediumAt, NestedBoundariesAnswersByRadius) {
  const auto a = fog("a"), b = fog("b"), c = fog("c");
  const Scene scene(seen_from(
      {0, 0, -9}, {boundary(make_sphere(Vec3(0), 1), a, b, "core"),
                   boundary(make_sphere({0.2, 0, 0}, 2), b, c, "shell"),
                   boundary(cube(4), c, nullptr, "tank"), wall(make_sphere({0, 3, 0}, 0.5))}));
  EXPECT_TRUE(scene.warnings().empty()) << scene.warnings()[0];
  EXPECT_TRUE(scene.has_media());
  EXPECT_TRUE(scene.has_null_surfaces());
  Rng rng(testing::suite_seed(), RngDomain::Test, 30, 0);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = 10.0 * uniform3(rng) - 5.0;
    const Medium* expected = nullptr;
    if (max_component(glm::abs(p)) < 4) expected = c.get();
    if (length(p - Vec3(0.2, 0, 0)) < 2) expected = b.get();
    if (length(p) < 1) expected = a.get();
    wrong += scene.medium_at(p) != expected;
  }
  EXPECT_EQ(wrong, 0);
}

/// A null cube that reaches through a wall of the room, and lies in fog on one side of it.
TEST(MediumAt, FarFromABlockOfCommensurableFaces) {
  const auto inside = fog("inside");
  const auto block = make_cube(Transform::scale({20, 20, 6}));  // areas 480 : 480 : 1600
  const Scene scene(seen_from({0, 0, -9}, {boundary(block, inside, nullptr, "block")}));
  Rng rng(testing::suite_seed(), RngDomain::Test, 33, 0);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i)
    wrong += scene.medium_at(60.0 * warp::sample_sphere(uniform2(rng))) != nullptr;
  EXPECT_EQ(wrong, 0);
}

TEST(MediumAt, BoundaryThroughAWall) {
  const auto smoke = fog("smoke");
  const Scene scene(seen_from(
      {0, 0, -3}, {wall(cube(4)), boundary(cube(1, {4, 0, 0}), smoke, nullptr, "plume")}));
  EXPECT_TRUE(scene.warnings().empty()) << scene.warnings()[0];
  for (const double x : {3.1, 3.9, 4.1, 4.9})
    EXPECT_EQ(scene.medium_at({x, 0.3, 0.2}), smoke.get());
  for (const double x : {2.9, -3.0, 5.1}) EXPECT_EQ(scene.medium_at({x, 0.3, 0.2}), nullptr);
}

/// Water under an open surface, held by walls that are no boundaries; a ball of glass in it.
TEST(MediumAt, OpenSheetOverAPool) {
  const auto water = fog("water");
  const auto sheet = make_rectangle(Transform::translate({0, 0, 1}) * Transform::scale(Vec3(2)));
  const Scene scene(seen_from({0, 0, 3}, {boundary(sheet, water, nullptr, "surface"),
                                          wall(make_cube(Transform::scale({2, 2, 4}))),
                                          wall(make_sphere({0, 0, -1}, 0.7))}));
  EXPECT_TRUE(scene.warnings().empty()) << scene.warnings()[0];
  Rng rng(testing::suite_seed(), RngDomain::Test, 31, 0);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = Vec3(1.99, 1.99, 3.99) * (2.0 * uniform3(rng) - 1.0);
    wrong += scene.medium_at(p) != (p.z < 1 ? water.get() : nullptr);
  }
  EXPECT_EQ(wrong, 0);
}

/// Walls close an open sheet where they stand on it, at its borders or before them.
TEST(Scene, ReportsBordersThatNoWallCloses) {
  const auto water = fog("water");
  const auto pool = [&](double x, double z, double top, std::shared_ptr<const Bsdf> walls) {
    const auto sheet =
        make_rectangle(Transform::translate({0, 0, 1}) * Transform::scale({x, z, 1}));
    std::vector<Surface> surfaces{boundary(sheet, water, nullptr, "surface")};
    for (int side = 0; side < 4; ++side) {
      surfaces.push_back(wall(make_rectangle(
          Transform::rotate({0, 0, 1}, 90.0 * side) * Transform::translate({2, 0, (top - 4) / 2}) *
          Transform::rotate({0, 1, 0}, 90) * Transform::scale({(top + 4) / 2, 2, 1}))));
      surfaces.back().bsdf = walls;
    }
    return seen_from({0, 0, 3}, std::move(surfaces));
  };
  const auto opaque = make_twosided(make_diffuse(RGB(0.5)));
  const auto complaints = [&](double x, double z, double top, std::shared_ptr<const Bsdf> walls) {
    const Scene scene(pool(x, z, top, std::move(walls)));
    return count_with(scene, "4 border edges") + 10 * count_with(scene, "2 border edges");
  };
  EXPECT_EQ(complaints(2, 2, 4, opaque), 0);
  EXPECT_EQ(complaints(2.02, 2.03, 4, opaque), 0);  // behind the walls, and their corners
  EXPECT_EQ(complaints(1.9, 1.9, 4, opaque), 1);    // a gap all around
  EXPECT_EQ(complaints(1.99, 2, 4, opaque), 10);    // along two walls
  EXPECT_EQ(complaints(2, 2, 1, opaque), 1);        // walls that do not reach above it
  EXPECT_EQ(complaints(2, 2, 4, make_dielectric(1.5)), 1);
  EXPECT_EQ(complaints(2, 2, 4, make_mask(opaque, 0.5)), 1);
}

/// On a boundary itself the primitive it lies on does not count: what is beyond it answers.
TEST(MediumAt, IgnoresThePrimitiveThePointLiesOn) {
  const auto inner = fog("inner"), outer = fog("outer");
  const auto lid = make_rectangle(Transform());
  const Scene scene(seen_from(
      {0, 0, -6}, {boundary(lid, inner, inner, "lid"), boundary(cube(3), outer, nullptr, "tank")}));
  EXPECT_EQ(scene.medium_at({0.1, 0.2, 0}, {0, 0}), outer.get());
}

TEST(MediumAt, WithoutBoundariesIsWhatTheCameraDeclares) {
  const auto haze = fog("haze");
  SceneDescription d = seen_from(Vec3(0), {wall(cube(2))});
  d.sensor_medium = haze;
  d.sensor_medium_declared = true;
  const Scene scene(std::move(d));
  EXPECT_EQ(scene.medium_at({1, 1, 1}), haze.get());
  EXPECT_TRUE(scene.warnings().empty());
  const Scene clear(seen_from(Vec3(0), {wall(cube(2))}));
  EXPECT_EQ(clear.medium_at({1, 1, 1}), nullptr);
}

TEST(Scene, ReportsACameraInAnUndeclaredMedium) {
  const auto smoke = fog("smoke");
  const auto surfaces = [&] {
    return std::vector<Surface>{boundary(cube(2), smoke, nullptr, "box")};
  };
  const Scene scene(seen_from(Vec3(0), surfaces()));
  EXPECT_EQ(count_with(scene, "the camera lies in medium 'smoke' and does not declare it"), 1);
  EXPECT_THROW(Scene(seen_from(Vec3(0), surfaces()), true), Error);
  SceneDescription declared = seen_from(Vec3(0), surfaces());
  declared.sensor_medium = smoke;
  declared.sensor_medium_declared = true;
  EXPECT_NO_THROW(Scene(std::move(declared), true));
  SceneDescription wrong = seen_from({0, 0, -5}, surfaces());
  wrong.sensor_medium = smoke;
  wrong.sensor_medium_declared = true;
  EXPECT_EQ(count_with(Scene(std::move(wrong)), "declares medium 'smoke' but lies in vacuum"), 1);
}

TEST(Scene, ReportsBoundariesThatOverlap) {
  const auto a = fog("a"), b = fog("b");
  const Scene nested(seen_from(Vec3(0), {boundary(make_sphere(Vec3(0), 2), a, b, "inner"),
                                         boundary(cube(4), b, nullptr, "outer")}));
  EXPECT_EQ(count_with(nested, "overlap"), 0);
  // The slab cuts through the cube, which is smaller; an open sheet cannot.
  const auto slab = make_cube(Transform::scale({0.1, 10, 10}));
  const Scene crossed(seen_from({0.01, 0.02, 0.03}, {boundary(cube(1), a, nullptr, "cube"),
                                                     boundary(slab, b, nullptr, "slab")}));
  EXPECT_EQ(crossed.medium_at(Vec3(0)), a.get());
  ASSERT_EQ(crossed.overlap_notes().size(), 1u);
  EXPECT_EQ(crossed.overlap_notes()[0],
            "shape 'slab' (test.xml:7:3), which holds medium 'b', overlaps shape 'cube' "
            "(test.xml:7:3), which holds medium 'a': where both are, that of shape 'cube' "
            "(test.xml:7:3) holds, whose volume is smaller");
  EXPECT_EQ(count_with(crossed, "overlap"), 0);
  EXPECT_EQ(count_with(crossed, "the camera lies in medium 'a'"), 1);
  const Scene sheet(seen_from(
      {0, 0, 9}, {boundary(cube(1), a, nullptr, "cube"),
                  boundary(make_rectangle(Transform::scale(Vec3(3))), b, nullptr, "sheet")}));
  EXPECT_EQ(count_with(sheet,
                       "shape 'sheet' (test.xml:7:3), whose boundary is open, runs through "
                       "medium 'a', which shape 'cube' (test.xml:7:3) bounds"),
            1);
}

/// Within a ball of one fog a sheet beside the lamp says that there is another.
TEST(Scene, ReportsPointLightsOfWhichBoundariesDisagree) {
  const auto a = fog("a"), b = fog("b");
  SceneDescription d = seen_from(
      {0, 0, 9},
      {boundary(make_sphere(Vec3(0), 1), a, nullptr, "ball"),
       boundary(make_rectangle(Transform::translate({0, 0, -0.2}) * Transform::scale(Vec3(0.1))),
                nullptr, b, "sheet")});
  d.emitters = {make_point_emitter({0.01, 0.02, 0}, RGB(1))};
  EXPECT_EQ(count_with(Scene(std::move(d)),
                       "a point light lies within the closed boundary of medium 'a', but what it "
                       "sees of the boundaries says medium 'b'"),
            1);
}

bool may_glow_at(const Scene& scene, const Medium* medium, const Vec3& position) {
  EmitterPoint x;
  x.surface.position = position;
  const int emitter = scene.emitter_of_medium(medium);
  return scene.emitter(static_cast<std::size_t>(emitter)).pdf_position(x) > 0;
}

/// The surface of a pool ends at its walls: what glows in it may be anywhere in the scene.
TEST(Scene, LetsAnOpenBoundaryGlowBelowIt) {
  const auto glow = fog("glow", 1);
  const auto level = [](double y, double half) {
    return make_rectangle(Transform::translate({0, y, 0}) * Transform::rotate({1, 0, 0}, -90) *
                          Transform::scale(Vec3(half)));
  };
  SceneDescription d = seen_from({0, 2, 0}, {boundary(level(0, 1), glow, nullptr, "surface")});
  for (int i = 0; i < 4; ++i)
    d.surfaces.push_back(
        wall(make_rectangle(Transform::rotate({0, 1, 0}, 90 * i) *
                            Transform::translate({0, -0.5, -1}) * Transform::scale(Vec3(1)))));
  d.surfaces.push_back(wall(level(-1, 1)));
  EXPECT_TRUE(may_glow_at(Scene(std::move(d)), glow.get(), {0.2, -0.5, 0.3}));
}

/// All of a room glows but for a bubble around the eye.
TEST(Scene, LetsWhatIsOutsideOfABoundaryGlow) {
  const auto glow = fog("glow", 1);
  const Scene scene(seen_from(
      Vec3(0), {boundary(make_sphere(Vec3(0), 0.5), nullptr, glow, "bubble"), wall(cube(2))}));
  EXPECT_TRUE(may_glow_at(scene, glow.get(), {1.2, -1.5, 1.3}));
}

/// Beyond the wall of a pool lies what boundaries in sight say, not the pool that is nearer.
TEST(Scene, TakesNoWordFromBoundariesBehindWalls) {
  const auto water = fog("water"), mist = fog("mist");
  const auto level = make_rectangle(Transform::rotate({1, 0, 0}, -90));
  const Scene scene(seen_from(
      {0, 2, 0},
      {boundary(level, water, nullptr, "surface"),
       wall(make_cube(Transform::translate({1.1, -1, 0}) * Transform::scale({0.1, 1.2, 3}))),
       boundary(make_sphere({3, -0.5, 0}, 0.5), mist, nullptr, "ball")}));
  EXPECT_EQ(scene.medium_at({1.5, -0.5, 0.1}), nullptr);
  EXPECT_EQ(scene.medium_at({0.5, -0.5, 0.1}), water.get());
}

/// A lamp that is half in fog begins its light in what is around each of its points.
TEST(Scene, KnowsThatLampsMayReachOutOfAMedium) {
  const auto mist = fog("mist");
  SceneDescription d = seen_from(
      {0, 0, -5},
      {boundary(cube(1), mist, nullptr, "mist"),
       wall(make_rectangle(Transform::translate({1, 0, 0}) * Transform::scale(Vec3(0.5))))});
  d.surfaces[1].emitter = make_area_emitter(d.surfaces[1].shape, RGB(1));
  const Scene scene(std::move(d));
  const int emitter = scene.emitter_of_surface(1);
  EXPECT_EQ(scene.medium_around_emitter(emitter, {0.8, 0.1, 0}, {1, 0}), mist.get());
  EXPECT_EQ(scene.medium_around_emitter(emitter, {1.2, 0.1, 0}, {1, 0}), nullptr);
}

/// Half of space is fog: from the other half the sky shines, whichever half it is.
TEST(Scene, SeesTheSkyBesideUnboundedFog) {
  const auto mist = fog("mist");
  const Vec3 x(1, 0, 0), y(0, 1, 0);
  for (const Transform& turn :
       {Transform(), Transform::rotate(x, 180), Transform::rotate(x, 90), Transform::rotate(x, -90),
        Transform::rotate(y, 90), Transform::rotate(y, -90)}) {
    SceneDescription d =
        seen_from(Vec3(0), {boundary(make_rectangle(turn * Transform::translate({0, 0, -1}) *
                                                    Transform::scale(Vec3(50))),
                                     mist, nullptr, "level")});
    d.emitters.push_back(make_constant_emitter(RGB(1)));
    EXPECT_EQ(Scene(std::move(d)).emitter_count(), 2u) << turn.vector({0, 0, 1}).x;
  }
}

TEST(Scene, RefusesWhatCannotBeRendered) {
  SceneDescription d = seen_from(Vec3(0), {wall(cube(1))});
  d.sensor = nullptr;
  EXPECT_THROW(Scene(std::move(d)), Error);
  d = seen_from(Vec3(0), {wall(cube(1))});
  d.emitters.clear();
  EXPECT_THROW(Scene(std::move(d)), Error);
  d = seen_from(Vec3(0), {wall(cube(1))});
  d.surfaces[0].bsdf = nullptr;
  EXPECT_THROW(Scene(std::move(d)), Error);
}

TEST(Scene, ChoosesEmittersHalfByPowerHalfAlike) {
  SceneDescription d = seen_from(Vec3(0), {wall(cube(3)), wall(make_sphere({0, 2, 0}, 0.5))});
  d.surfaces[1].emitter = make_area_emitter(d.surfaces[1].shape, RGB(1, 2, 3));
  d.emitters.push_back(make_constant_emitter(RGB(0.1)));
  const Scene scene(std::move(d));
  ASSERT_EQ(scene.emitter_count(), 3u);
  EXPECT_EQ(scene.emitter_of_surface(0), -1);
  const int light = scene.emitter_of_surface(1);
  ASSERT_GE(light, 0);
  EXPECT_EQ(scene.emitter(static_cast<std::size_t>(light)).sample_position(Vec3(0.3))->id.shape,
            1u);
  ASSERT_EQ(scene.infinite_emitters().size(), 1u);
  double total = 0;
  for (std::size_t i = 0; i < 3; ++i) total += luminance(scene.emitter(i).power());
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(scene.emitter_distribution().probability(i),
                0.5 * luminance(scene.emitter(i).power()) / total + 0.5 / 3, 1e-15);
  EXPECT_NEAR(scene.power(), total, 1e-12 * total);
  EXPECT_NEAR(scene.radius(), 3 * std::sqrt(3.0), 1e-12);
}

TEST(Scene, NeverChoosesEmittersWithoutPowerWhereOthersShine) {
  SceneDescription d = seen_from(Vec3(0), {wall(cube(1))});
  d.emitters = {make_point_emitter(Vec3(0), RGB(0)), make_point_emitter(Vec3(0.1), RGB(1e-30)),
                make_point_emitter(Vec3(0.2), RGB(1e30))};
  const Scene scene(std::move(d));
  EXPECT_EQ(scene.emitter_distribution().probability(0), 0);
  EXPECT_NEAR(scene.emitter_distribution().probability(1), 0.25, 1e-15);
  EXPECT_NEAR(scene.emitter_distribution().probability(2), 0.75, 1e-15);
}

TEST(Scene, ChoosesUniformlyAmongEmittersWithoutPower) {
  SceneDescription d = seen_from(Vec3(0), {wall(cube(1))});
  d.emitters = {make_point_emitter(Vec3(0), RGB(0)), make_point_emitter(Vec3(0.1), RGB(0))};
  const Scene scene(std::move(d));
  EXPECT_EQ(scene.emitter_distribution().probability(0), 0.5);
}

TEST(Scene, LeavesOutLightFromBeyondUnboundedFog) {
  const auto haze = fog("haze");
  SceneDescription d = seen_from(Vec3(0), {wall(cube(1, {5, 0, 0}))});
  d.sensor_medium = haze;
  d.sensor_medium_declared = true;
  d.emitters.push_back(make_constant_emitter(RGB(1)));
  const Scene scene(std::move(d));
  EXPECT_TRUE(scene.infinite_emitters().empty());
  EXPECT_EQ(scene.emitter_count(), 1u);
  EXPECT_EQ(count_with(scene, "unbounded fog"), 1);
  // Fog that is bounded does not matter.
  SceneDescription bounded = seen_from({0, 0, -9}, {boundary(cube(2), haze, nullptr, "box")});
  bounded.emitters.push_back(make_constant_emitter(RGB(1)));
  EXPECT_EQ(Scene(std::move(bounded)).infinite_emitters().size(), 1u);
}

/// Light from infinity sets out in the fog that is everywhere, though not everywhere of a density.
TEST(Scene, LightFromInfinityBeginsInWhatIsAround) {
  HeterogeneousSettings settings;
  settings.sigma_t = std::make_shared<Volume>(RGB(0.3), Transform::scale(Vec3(4)));
  settings.albedo = std::make_shared<Volume>(RGB(0.5));
  const auto cloud = make_heterogeneous_medium(settings, make_isotropic_phase());
  SceneDescription d = seen_from(Vec3(0), {wall(cube(1, Vec3(0, 0, 5)))});
  d.emitters = {make_constant_emitter(RGB(1))};
  d.sensor_medium = cloud;
  d.sensor_medium_declared = true;
  const Scene scene(std::move(d));
  ASSERT_EQ(scene.infinite_emitters().size(), 1u);
  EXPECT_EQ(scene.medium_around_emitter(scene.infinite_emitters()[0], Vec3(50), kNoPrimitive),
            cloud.get());
}

TEST(Scene, EmittingMediaAreEmittersWithinTheirBoundaries) {
  const auto flame = fog("flame", 2);
  SceneDescription d = seen_from(
      {0, 0, -4}, {boundary(make_sphere({1, 0, 0}, 0.5), flame, nullptr, "fire"),
                   boundary(cube(0.1, {1, 0, 0}), nullptr, flame, "hole"), wall(cube(5))});
  const Scene scene(std::move(d));
  EXPECT_TRUE(scene.warnings().empty()) << scene.warnings()[0];
  const int index = scene.emitter_of_medium(flame.get());
  ASSERT_GE(index, 0);
  const Emitter& emitter = scene.emitter(static_cast<std::size_t>(index));
  Rng rng(testing::suite_seed(), RngDomain::Test, 32, 0);
  int found = 0, wrong = 0;
  constexpr int kSamples = 20000;
  for (int i = 0; i < kSamples; ++i) {
    const auto x = emitter.sample_position(uniform3(rng));
    if (!x) continue;
    ++found;
    const Vec3 p = x->surface.position - Vec3(1, 0, 0);
    wrong += length(p) > 0.5 || max_component(glm::abs(p)) < 0.1;
    EXPECT_DOUBLE_EQ(x->pdf_position, 1);
  }
  EXPECT_EQ(wrong, 0);
  // The volume of ball less hole, in a bounding box of volume one.
  const double share = kPi / 6 - 0.008, sigma = std::sqrt(share * (1 - share) * kSamples);
  EXPECT_GT(testing::p_value_normal((found - share * kSamples) / sigma), testing::kSuiteFalseAlarm);
}

TEST(Scene, EmittingMediumWithoutBoundsIsReported) {
  const auto glow = fog("glow", 1);
  const auto description = [&](std::vector<Surface> surfaces) {
    SceneDescription d = seen_from(Vec3(0), std::move(surfaces));
    d.sensor_medium = glow;
    d.sensor_medium_declared = true;
    return d;
  };
  EXPECT_THROW(Scene(description({})), Error);
  const Scene open(description({wall(cube(1, {3, 0, 0}))}));
  EXPECT_EQ(count_with(open, "is not bounded"), 1);
  const Scene room(description({wall(cube(3))}));
  EXPECT_TRUE(room.warnings().empty());
  EXPECT_GE(room.emitter_of_medium(glow.get()), 0);
}

TEST(Scene, WithoutSurfacesSpansCameraAndLights) {
  SceneDescription d = seen_from({1, 2, 3}, {});
  d.emitters = {make_point_emitter({4, 6, 3}, RGB(1))};
  d.sensor_medium = fog("fog");
  d.sensor_medium_declared = true;
  const Scene scene(std::move(d));
  EXPECT_DOUBLE_EQ(scene.radius(), 2.5);
  EXPECT_FALSE(scene.accel().intersect({Vec3(0), Vec3(0, 0, 1)}));
}

}  // namespace
}  // namespace fogbow
