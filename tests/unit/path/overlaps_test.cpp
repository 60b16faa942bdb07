// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes that overlap: what rays meet is compared with closed forms of the rule, and with scenes
// that are modelled without overlaps.
#include <gtest/gtest.h>

#include <algorithm>

#include "mlt/render.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/path/volume_scenes.h"

namespace fogbow {
namespace {

using namespace testing;

/// A ball of one fog and a turned cube of another. The cube is smaller.
struct TwoFogs {
  Vec3 center{-0.3, 0.1, 0};
  double radius = 1;
  Transform place = Transform::translate({0.6, 0, 0.1}) * Transform::rotate({1, 2, 3}, 40) *
                    Transform::scale({0.7, 0.6, 0.5});
  Mat4 back = place.inverse_matrix();
  MediumPointer a = fog(RGB(0.7, 1.1, 1.9), "a"), b = fog(RGB(2.3, 0.4, 0.9), "b");

  std::vector<Surface> surfaces(int ball_priority) const {
    return {boundary(make_sphere(center, radius), a, nullptr, ball_priority),
            boundary(make_cube(place), b, nullptr)};
  }
  Vec3 to_cube(const Vec3& p) const { return Vec3(back * Vec4(p, 1)); }
  bool in_ball(const Vec3& p) const { return length(p - center) < radius; }
  bool in_box(const Vec3& p) const { return max_component(glm::abs(to_cube(p))) < 1; }
  const Medium* at(const Vec3& p, bool ball_wins) const {
    if (in_ball(p) && (ball_wins || !in_box(p))) return a.get();
    return in_box(p) ? b.get() : nullptr;
  }
  RGB depth(const Vec3& p, const Vec3& q, bool ball_wins) const {
    const Interval ball = in_sphere(p, q - p, center, radius),
                   box = in_cube(to_cube(p), to_cube(q) - to_cube(p));
    const double both = size(cut(ball, box)), l = length(q - p);
    const double of_a = size(ball) - (ball_wins ? 0 : both),
                 of_b = size(box) - (ball_wins ? both : 0);
    return l * (of_a * RGB(0.7, 1.1, 1.9) + of_b * RGB(2.3, 0.4, 0.9));
  }
};

class Priority : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(OfTheBall, Priority, ::testing::Values(0, 1, -1));

TEST_P(Priority, DecidesOpticalDepthBothWays) {
  const TwoFogs fogs;
  const bool ball_wins = GetParam() > 0;
  const Scene scene(describe_scene(fogs.surfaces(GetParam())), true);
  EXPECT_EQ(scene.overlap_notes().size(), 1u);
  Rng rng(testing::suite_seed(), RngDomain::Test, 40, 0);
  double worst = 0;
  int through_both = 0, wrong_medium = 0;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = 3.0 * uniform3(rng) - 1.5, q = 3.0 * uniform3(rng) - 1.5;
    const Vertex x = point_at(p, fogs.at(p, ball_wins)), y = point_at(q, fogs.at(q, ball_wins));
    wrong_medium += scene.medium_at(p) != x.medium;
    const auto there = connect(scene, x, y), back = connect(scene, y, x);
    ASSERT_TRUE(there && back);
    const RGB expected = glm::exp(-fogs.depth(p, q, ball_wins));
    worst = std::max(worst, max_component(glm::abs(there->tau - expected)));
    worst = std::max(worst, max_component(glm::abs(back->tau - expected)));
    through_both += size(cut(in_sphere(p, q - p, fogs.center, fogs.radius),
                             in_cube(fogs.to_cube(p), fogs.to_cube(q) - fogs.to_cube(p)))) > 0;
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(through_both, 500);
  EXPECT_EQ(wrong_medium, 0);
}

TEST_P(Priority, HoldsAtTheEndOfFreeFlights) {
  const TwoFogs fogs;
  const bool ball_wins = GetParam() > 0;
  const Scene scene(describe_scene(fogs.surfaces(GetParam())), true);
  int ended = 0;
  for (int i = 0; i < 5000; ++i) {
    Rng rng(testing::suite_seed(), RngDomain::Test, 41, i);
    const Vec3 p = 3.0 * uniform3(rng) - 1.5, q = 3.0 * uniform3(rng) - 1.5;
    Vertex next;
    Edge edge;
    const Vec2 u(rng.uniform(), rng.uniform());
    if (extend(scene, point_at(p, fogs.at(p, ball_wins)), normalize(q - p), u, next, edge) !=
        ExtendResult::Reached)
      continue;
    ++ended;
    ASSERT_TRUE(next.in_medium());
    ASSERT_EQ(next.medium, fogs.at(next.position(), ball_wins));
    const RGB expected = glm::exp(-fogs.depth(p, next.position(), ball_wins));
    ASSERT_LT(max_component(glm::abs(edge.tau - expected)), 1e-9);
  }
  EXPECT_GT(ended, 500);
}

TEST(Overlaps, PiecesOfOneFogAreTheirUnion) {
  const auto a = fog(RGB(1.3), "a");
  const Vec3 centers[] = {{-0.5, 0, 0}, {0.4, 0.2, 0}, {0, -0.4, 0.3}};
  std::vector<Surface> surfaces;
  for (const Vec3& c : centers) surfaces.push_back(boundary(make_sphere(c, 0.8), a, nullptr));
  const Scene scene(describe_scene(surfaces), true);
  Rng rng(testing::suite_seed(), RngDomain::Test, 42, 0);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = 4.0 * normalize(uniform3(rng) - 0.5), q = -4.0 * normalize(uniform3(rng) - 0.5);
    // Inclusion and exclusion.
    const Interval s[] = {in_sphere(p, q - p, centers[0], 0.8),
                          in_sphere(p, q - p, centers[1], 0.8),
                          in_sphere(p, q - p, centers[2], 0.8)};
    const double inside = size(s[0]) + size(s[1]) + size(s[2]) - size(cut(s[0], s[1])) -
                          size(cut(s[1], s[2])) - size(cut(s[2], s[0])) +
                          size(cut(cut(s[0], s[1]), s[2]));
    const auto edge = connect(scene, point_at(p), point_at(q));
    ASSERT_TRUE(edge);
    ASSERT_NEAR(edge->tau.x, std::exp(-1.3 * length(q - p) * inside), 1e-9);
  }
}

/// Whatever is nested comes first, whatever the priorities of what is around it.
TEST(Overlaps, NestedVolumesComeBeforeThoseAroundThem) {
  const auto inner = fog(RGB(1), "inner"), outer = fog(RGB(2), "outer"),
             other = fog(RGB(3), "other");
  const Scene scene(describe_scene({boundary(make_sphere(Vec3(0), 1), outer, nullptr, 2),
                                    boundary(make_sphere({0.3, 0, 0}, 0.4), inner, outer),
                                    boundary(make_sphere({1, 0, 0}, 1), other, nullptr, 1)}),
                    true);
  EXPECT_EQ(scene.medium_at({0.31, 0.01, 0.02}), inner.get());
  EXPECT_EQ(scene.medium_at({0.8, 0.01, 0.02}), outer.get());
  EXPECT_EQ(scene.medium_at({1.3, 0.01, 0.02}), other.get());
}

TEST(Overlaps, BoxesOnOneFloorShareIt) {
  const auto a = fog(RGB(1), "a"), b = fog(RGB(2), "b");
  const auto box = [](double x0, double x1) {
    return make_cube(Transform::translate({(x0 + x1) / 2, 0.5, 0}) *
                     Transform::scale({(x1 - x0) / 2, 0.5, 1}));
  };
  const Scene scene(
      describe_scene({boundary(box(-1, 0.5), a, nullptr), boundary(box(-0.5, 1), b, nullptr, 1)}),
      true);
  Rng rng(testing::suite_seed(), RngDomain::Test, 43, 0);
  for (int i = 0; i < 2000; ++i) {
    const double x = 2 * rng.uniform() - 1, z = 2 * rng.uniform() - 1;
    const auto edge = connect(scene, point_at({x, -1, z}), point_at({x, 2, z}));
    ASSERT_TRUE(edge);
    ASSERT_NEAR(edge->tau.x, std::exp(x > -0.5 ? -2.0 : -1.0), 1e-9);
  }
}

// --- Glass of milk

constexpr double kGlass = 1.5, kMilk = 1.33;

ShapePointer disk(double z, double radius, bool down) {
  return make_disk(Transform::translate({0, 0, z}) * Transform::scale(Vec3(radius)), down);
}
ShapePointer tube(double z0, double z1, double radius, bool inwards) {
  return make_cylinder({0, 0, z0}, {0, 0, z1}, radius, Transform(), inwards);
}

/// Closed above, lest a ray tell the rim.
std::vector<Surface> glass_outside(int priority) {
  const auto glass = make_dielectric(kGlass);
  return {surface(tube(-1, 1, 1, false), glass, priority),
          surface(disk(1, 1, false), glass, priority), surface(disk(-1, 1, true), glass, priority)};
}

/// The milk reaches into the wall; its surface stands at z = 0.3 within the hollow.
std::vector<Surface> overlapping_milk(const MediumPointer& milk) {
  std::vector<Surface> all = glass_outside(1);
  const auto glass = make_dielectric(kGlass), liquid = make_dielectric(kMilk);
  for (const auto& shape :
       {tube(-0.8, 0.8, 0.8, true), disk(0.8, 0.8, true), disk(-0.8, 0.8, false)})
    all.push_back(surface(shape, glass, 1));
  for (const auto& shape :
       {tube(-0.9, 0.3, 0.9, false), disk(0.3, 0.9, false), disk(-0.9, 0.9, true)})
    all.push_back(boundary(shape, milk, nullptr, 0, liquid));
  return all;
}

std::vector<Surface> exact_milk(const MediumPointer& milk) {
  std::vector<Surface> all = glass_outside(0);
  const auto glass = make_dielectric(kGlass), liquid = make_dielectric(kMilk),
             wall = make_dielectric(kGlass / kMilk);
  all.push_back(surface(tube(0.3, 0.8, 0.8, true), glass));
  all.push_back(surface(disk(0.8, 0.8, true), glass));
  all.push_back(boundary(tube(-0.8, 0.3, 0.8, true), nullptr, milk, 0, wall));
  all.push_back(boundary(disk(-0.8, 0.8, false), nullptr, milk, 0, wall));
  all.push_back(boundary(disk(0.3, 0.8, false), milk, nullptr, 0, liquid));
  return all;
}

struct Crossing {
  double t, ratio;  ///< index behind over index before
  const Medium* behind;
};

std::vector<Crossing> crossings(const Scene& scene, Ray ray) {
  std::vector<Crossing> all;
  PrimitiveId from = kNoPrimitive;
  const Medium* medium = nullptr;
  while (const auto hit = scene.accel().intersect(ray, from)) {
    const Surface& s = scene.surface(hit->id.shape);
    const bool leaves = dot(scene.surface_point(*hit).n_g, ray.d) > 0;
    if (s.medium_boundary) medium = leaves ? s.exterior.get() : s.interior.get();
    all.push_back({hit->t, leaves ? 1 / s.bsdf->eta() : s.bsdf->eta(), medium});
    ray.t_min = hit->t;
    from = hit->id;
  }
  return all;
}

TEST(Overlaps, GlassOfMilkHasTheInterfacesOfTheExactModel) {
  const auto milk = fog(RGB(2), "milk");
  const Scene overlapping(describe_scene(overlapping_milk(milk)), true);
  const Scene exact(describe_scene(exact_milk(milk)));
  Rng rng(testing::suite_seed(), RngDomain::Test, 44, 0);
  int deep = 0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p = 3.0 * normalize(uniform3(rng) - 0.5), q = 1.8 * uniform3(rng) - 0.9;
    const Ray ray{p, normalize(q - p), 0, kInfinity};
    const auto a = crossings(overlapping, ray), b = crossings(exact, ray);
    ASSERT_EQ(a.size(), b.size()) << i;
    for (std::size_t k = 0; k < a.size(); ++k) {
      ASSERT_NEAR(a[k].t, b[k].t, 1e-9);
      ASSERT_NEAR(a[k].ratio, b[k].ratio, 1e-12) << i << ", crossing " << k;
      ASSERT_EQ(a[k].behind, b[k].behind) << i << ", crossing " << k;
    }
    deep += a.size() >= 4;
  }
  EXPECT_GT(deep, 1000);
}

/// A ball of ice half in water, told by the indices of both sides of its surface; it is smaller.
TEST(Overlaps, IceInWaterRefractsBetweenWhatIsThere) {
  const auto water = fog(RGB(1), "water"), ice = fog(RGB(0.5), "ice");
  const Scene scene(
      describe_scene(
          {boundary(make_cube(Transform::translate({0, -1, 0}) * Transform::scale({2, 1, 2})),
                    water, nullptr, 0, make_dielectric(1.33)),
           boundary(make_sphere(Vec3(0), 0.7), ice, nullptr, 0, make_dielectric(1.31))}),
      true);
  const auto column = [&](const Vec3& p, const Vec3& d) {
    return crossings(scene, {p, d, 0, kInfinity});
  };
  const auto down = column({0.1, 3, 0.05}, {0, -1, 0});
  ASSERT_EQ(down.size(), 3u);  // not the water's surface, which lies within the ice
  EXPECT_NEAR(down[0].ratio, 1.31, 1e-12);
  EXPECT_EQ(down[0].behind, ice.get());
  EXPECT_NEAR(down[1].ratio, 1.33 / 1.31, 1e-12);
  EXPECT_EQ(down[1].behind, water.get());
  EXPECT_NEAR(down[2].ratio, 1 / 1.33, 1e-12);
  const auto aside = column({-5, 0.2, 0.05}, {1, 0, 0});
  ASSERT_EQ(aside.size(), 2u);
  EXPECT_NEAR(aside[1].ratio, 1 / 1.31, 1e-12);
  EXPECT_EQ(aside[1].behind, nullptr);
  EXPECT_EQ(column({1, 3, 0.05}, {0, -1, 0}).size(), 2u);  // beside the ice the surface is there
}

/// The same where the ice says what is around most of it.
TEST(Overlaps, VolumesThatComeOutOfWhatTheyDeclareAroundThemAreInWhatIsBeyond) {
  const auto water = fog(RGB(1), "water"), ice = fog(RGB(0.5), "ice");
  const auto wet = make_dielectric(1.31 / 1.33, RGB(1), RGB(1), 1.33);
  const Scene scene(describe_scene({boundary(make_cube(Transform::translate({0, -1, 0}) *
                                                       Transform::scale({2, 1, 2})),
                                             water, nullptr, 0, make_dielectric(1.33)),
                                    boundary(make_sphere(Vec3(0), 0.7), ice, water, 0, wet)}),
                    true);
  const auto down = crossings(scene, {{0.1, 3, 0.05}, {0, -1, 0}, 0, kInfinity});
  ASSERT_EQ(down.size(), 3u);
  EXPECT_NEAR(down[0].ratio, 1.31, 1e-12);
  EXPECT_EQ(down[0].behind, ice.get());
  EXPECT_NEAR(down[1].ratio, 1.33 / 1.31, 1e-12);
  EXPECT_EQ(down[1].behind, water.get());
  const auto aside = crossings(scene, {{-5, 0.2, 0.05}, {1, 0, 0}, 0, kInfinity});
  ASSERT_EQ(aside.size(), 2u);
  EXPECT_EQ(aside[1].behind, nullptr);
}

/// Three one in the other, of which the innermost comes out of both that are around it.
TEST(Overlaps, WhatComesOutOfAllThatIsAroundItIsInTheOpen) {
  const auto sea = fog(RGB(1), "sea"), tank = fog(RGB(2), "tank"), ice = fog(RGB(0.5), "ice");
  const auto box = [](double half, double top) {
    return make_cube(Transform::translate({0, top - half, 0}) * Transform::scale(Vec3(half)));
  };
  const auto in = [](double n, double n_around) {
    return make_dielectric(n / n_around, RGB(1), RGB(1), n_around);
  };
  const Scene scene(
      describe_scene({boundary(box(4, 0), sea, nullptr, 0, make_dielectric(1.2)),
                      boundary(box(1.5, -0.2), tank, sea, 0, in(1.33, 1.2)),
                      boundary(make_sphere(Vec3(0), 0.7), ice, tank, 0, in(1.31, 1.33))}),
      true);
  const auto leaves_into = [&](double y, double n, const Medium* medium) {
    const auto all = crossings(scene, {{0.01, y, 0.02}, {1, 0, 0}, 0, kInfinity});
    ASSERT_FALSE(all.empty());
    EXPECT_NEAR(all[0].ratio, n / 1.31, 1e-12) << y;
    EXPECT_EQ(all[0].behind, medium) << y;
  };
  leaves_into(0.3, 1, nullptr);
  leaves_into(-0.1, 1.2, sea.get());
  leaves_into(-0.4, 1.33, tank.get());
}

/// A marble that says nothing of media, where two liquids overlap: the one that holds there, the
/// smaller, is around it and in it.
TEST(Overlaps, GlassThatSaysNothingOfMediaKeepsThatAroundIt) {
  const auto water = fog(RGB(1), "water"), oil = fog(RGB(0.5), "oil");
  const Scene scene(
      describe_scene(
          {boundary(make_cube(Transform::translate({0, -1, 0}) * Transform::scale({2, 1, 2})),
                    water, nullptr, 0, make_dielectric(1.33)),
           boundary(make_sphere(Vec3(0), 0.7), oil, nullptr, 0, make_dielectric(1.4)),
           surface(make_sphere({0, -0.4, 0}, 0.1), make_dielectric(1.5))}),
      true);
  const auto all = crossings(scene, {{0.01, 3, 0.02}, {0, -1, 0}, 0, kInfinity});
  ASSERT_EQ(all.size(), 5u);
  const double ratios[] = {1.4, 1.5 / 1.4, 1.4 / 1.5, 1.33 / 1.4, 1 / 1.33};
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(all[i].ratio, ratios[i], 1e-12) << i;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(all[i].behind, oil.get()) << i;
  EXPECT_EQ(all[3].behind, water.get());
}

/// Where fog lies upon water, the water's surface is there, whichever of the two comes first.
TEST(Overlaps, FogUponWaterLeavesItsSurface) {
  const auto water = fog(RGB(1), "water"), mist = fog(RGB(0.5), "mist");
  for (const int priority : {0, 1})
    for (const double half : {0.5, 3.0}) {
      const auto over =
          make_cube(Transform::translate({0, half, 0}) * Transform::scale(Vec3(half)));
      const Scene scene(describe_scene({boundary(make_cube(Transform::translate({0, -1, 0})), water,
                                                 nullptr, 0, make_dielectric(1.33)),
                                        boundary(over, mist, nullptr, priority)},
                                       {0.3, 9, 6}),
                        true);
      const auto down = crossings(scene, {{0.01, 7, 0.02}, {0, -1, 0}, 0, kInfinity});
      ASSERT_EQ(down.size(), 3u) << priority << ' ' << half;
      EXPECT_EQ(down[0].behind, mist.get());
      EXPECT_NEAR(down[1].ratio, 1.33, 1e-12);
      EXPECT_EQ(down[1].behind, water.get());
      const auto up = crossings(scene, {{0.01, -7, 0.02}, {0, 1, 0}, 0, kInfinity});
      ASSERT_EQ(up.size(), 3u) << priority << ' ' << half;
      EXPECT_NEAR(up[1].ratio, 1 / 1.33, 1e-12);
      EXPECT_EQ(up[1].behind, mist.get());
    }
}

/// Pieces of one medium and of two priorities are two volumes.
TEST(Overlaps, PiecesOfOneFogMayHaveTwoPriorities) {
  const auto a = fog(RGB(1), "a"), b = fog(RGB(2), "b");
  const Scene scene(describe_scene({boundary(make_sphere({-1, 0, 0}, 0.8), a, nullptr, 0),
                                    boundary(make_sphere({1, 0, 0}, 0.8), a, nullptr, 2),
                                    boundary(make_sphere(Vec3(0), 0.9), b, nullptr, 1)}),
                    true);
  EXPECT_EQ(scene.medium_at({-0.5, 0.01, 0.02}), b.get());
  EXPECT_EQ(scene.medium_at({0.5, 0.01, 0.02}), a.get());
}

/// The eye in two pieces of one fog at once, and within another: nothing is doubtful.
TEST(Overlaps, TwoPiecesOfOneFogHoldTheEye) {
  const auto a = fog(RGB(1), "a"), b = fog(RGB(2), "b");
  SceneDescription d = describe_scene({boundary(make_sphere({-0.3, 0, 0}, 0.8), a, b),
                                       boundary(make_sphere({0.3, 0, 0}, 0.8), a, b),
                                       boundary(make_sphere(Vec3(0), 3), b, nullptr)},
                                      {0.05, 0.03, 0.1});
  d.sensor_medium = a;
  d.sensor_medium_declared = true;
  const Scene scene(std::move(d));
  EXPECT_TRUE(scene.warnings().empty()) << scene.warnings().front();
}

TEST(Overlaps, PiecesThatAreInsideOutAreReported) {
  const auto a = fog(RGB(1), "a");
  for (const bool flip : {false, true}) {
    const Scene scene(describe_scene(
        {boundary(make_cube(Transform()), a, nullptr),
         boundary(make_cube(Transform::translate({1, 0.3, 0.2}), flip), a, nullptr)}));
    EXPECT_EQ(std::ranges::any_of(scene.warnings(),
                                  [](const std::string& warning) {
                                    return warning.find("partly inside out") != std::string::npos;
                                  }),
              flip);
    EXPECT_EQ(scene.warnings().empty(), !flip);
  }
}

/// One block of ice, of which the lid is told by its index against air and the rest by that against
/// water.
TEST(Overlaps, IndicesMayBeToldAgainstWhateverIsOutside) {
  const auto ice = fog(RGB(0.5), "ice"), mist = fog(RGB(1), "mist");
  const auto dry = make_dielectric(1.31), wet = make_dielectric(1.31 / 1.33, RGB(1), RGB(1), 1.33);
  const Scene scene(describe_scene({boundary(disk(1, 1, false), ice, nullptr, 0, dry),
                                    boundary(tube(-1, 1, 1, false), ice, nullptr, 0, wet),
                                    boundary(disk(-1, 1, true), ice, nullptr, 0, wet),
                                    boundary(make_sphere({0, 0, 1}, 0.5), mist, nullptr)}),
                    true);
  const auto down = crossings(scene, {{0.01, 0.02, 3}, {0, 0, -1}, 0, kInfinity});
  ASSERT_GE(down.size(), 2u);
  EXPECT_EQ(down[0].behind, mist.get());
  EXPECT_NEAR(down[1].ratio, 1.31, 1e-12);
}

/// An open-topped tank of walls, which bound the water as well: mist that reaches into it finds one
/// index there.
TEST(Overlaps, WallsMayCloseWhatRefracts) {
  const auto water = fog(RGB(1), "water"), mist = fog(RGB(0.5), "mist");
  const auto wall = make_twosided(make_diffuse(RGB(0.5)));
  const Scene scene(
      describe_scene({boundary(disk(0, 1, false), water, nullptr, 0, make_dielectric(1.33)),
                      boundary(tube(-1, 0, 1, false), water, nullptr, 0, wall),
                      boundary(disk(-1, 1, true), water, nullptr, 0, wall),
                      boundary(make_sphere(Vec3(0), 0.5), mist, nullptr)}),
      true);
  const auto down = crossings(scene, {{0.01, 0.02, 3}, {0, 0, -1}, 0, kInfinity});
  ASSERT_GE(down.size(), 3u);
  EXPECT_EQ(down[0].behind, mist.get());
  EXPECT_NEAR(down[1].ratio, 1.33, 1e-12);
  EXPECT_EQ(down[1].behind, mist.get());
  EXPECT_EQ(down[2].behind, water.get());
}

/// A lamp shines where fog lies upon it as well.
TEST(Overlaps, LampsThatBoundMediaShineEverywhere) {
  const auto a = fog(RGB(1), "a"), b = fog(RGB(2), "b");
  Surface lamp = boundary(make_sphere(Vec3(0), 0.5), a, nullptr, 0, make_diffuse(RGB(0.5)));
  lamp.emitter = make_area_emitter(lamp.shape, RGB(1));
  const Scene scene(
      describe_scene({lamp, boundary(make_cube(Transform::translate({1, 0, 0})), b, nullptr)}),
      true);
  for (const double x : {-0.4, -0.1, 0.1, 0.4}) {
    Ray ray{{x, 0.01, 3}, {0, 0, -1}, 0, kInfinity};
    std::optional<Hit> hit;
    PrimitiveId from = kNoPrimitive;
    int shining = 0;
    while ((hit = scene.accel().intersect(ray, from))) {
      shining += scene.emitter_of_surface(hit->id.shape) == 0;
      ray.t_min = hit->t;
      from = hit->id;
    }
    EXPECT_EQ(shining, 2) << x;
  }
}

TEST(Overlaps, ThatCannotBeResolvedAreReported) {
  const auto a = fog(RGB(1), "a"), b = fog(RGB(2), "b");
  PrincipledSettings clear;
  clear.spec_trans = 1.0;
  const auto overlapping = [&](std::shared_ptr<const Bsdf> bsdf) {
    return describe_scene({boundary(make_sphere(Vec3(0), 1), a, nullptr, 0, make_dielectric(1.3)),
                           boundary(make_sphere({0.5, 0, 0}, 0.9), b, nullptr, 0, bsdf)});
  };
  const Scene scene(overlapping(make_principled(clear)));
  ASSERT_EQ(scene.warnings().size(), 1u);
  EXPECT_NE(scene.warnings()[0].find("principled"), std::string::npos) << scene.warnings()[0];
  EXPECT_EQ(scene.surfaces().size(), 2u);
  EXPECT_THROW(Scene(overlapping(make_principled(clear)), true), Error);
  EXPECT_NO_THROW(Scene(overlapping(make_dielectric(1.6)), true));
}

/// Two boxes that overlap, and the same two all but abutting: one picture, by every integrator.
TEST(Overlaps, GiveThePictureOfTheSceneWithoutThem) {
  const auto a = fog(RGB(1.5, 1, 0.7), "a"), b = fog(RGB(0.5, 1.2, 2.5), "b");
  const auto box = [](double x0, double x1) {
    return make_cube(Transform::translate({(x0 + x1) / 2, 0, 0}) *
                     Transform::scale({(x1 - x0) / 2, 0.8, 0.8}));
  };
  const auto lit = [&](std::vector<Surface> surfaces) {
    surfaces.push_back(
        surface(make_cube(Transform::translate({0, -1.5, 0}) * Transform::scale({3, 0.5, 3})),
                make_diffuse(RGB(0.5))));
    SceneDescription d = describe_scene(surfaces, {0.3, 1, 6});
    d.emitters = {make_point_emitter({0.4, 2, 0.5}, RGB(20))};
    return d;
  };
  // The smaller box reaches from 0 to 1.2 and holds in the overlap.
  const Scene overlapping(
      lit({boundary(box(-1.2, 0.6), a, nullptr), boundary(box(0, 1.2), b, nullptr)}), true);
  const Scene abutting(
      lit({boundary(box(-1.2, -1e-6), a, nullptr), boundary(box(0, 1.2), b, nullptr)}));
  const auto run = [](const Scene& scene, const std::string& integrator, double spp) {
    RenderOptions options;
    options.integrator = integrator;
    options.samples_per_pixel = spp;
    options.threads = 1;
    options.seed = testing::suite_seed();
    options.overrides = {{"max_depth", "6"}};
    if (integrator == "mlt" || integrator == "pssmlt")
      options.overrides.push_back({"luminance_samples", "32768"});
    return render(scene, options);
  };
  const RenderResult expected = run(abutting, "bdpt", 64);
  for (const char* integrator : {"path", "bdpt", "pssmlt", "mlt"}) {
    const RenderResult result = run(overlapping, integrator, 64);
    const double sigma = std::hypot(result.b_stderr, expected.b_stderr);
    EXPECT_LT(std::abs(result.b - expected.b), 4.5 * sigma) << integrator;
    EXPECT_LT(sigma, 0.02 * expected.b) << integrator << ": no power";
  }
}

}  // namespace
}  // namespace fogbow
