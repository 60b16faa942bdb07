// SPDX-License-Identifier: GPL-3.0-or-later
// Directional, spot and environment emitters. Values of Mitsuba 3.9.1 (scalar_rgb) are those of
// emitter.sample_direction (spot, at distance 2) and emitter.eval (envmap).
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/image/image.h"
#include "core/math/random.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/lightcam/emitter_triples.h"

namespace fogbow {
namespace {

using testing::check_triple;
using testing::direction_triple;
using testing::oblique_frame;
using testing::Triple;

const RGB kRadiance(2, 3, 4);

TEST(SpotEmitter, HasMitsubasFalloff) {
  struct Case {
    double cutoff, beam, degrees, red;
  };
  const Case cases[] = {{20, 15, 0, 0.5},        {20, 15, 14.9, 0.5}, {20, 15, 15.1, 0.49},
                        {20, 15, 18, 0.2},       {20, 15, 20, 0},     {20, 15, 100, 0},
                        {30, 10, 14.9, 0.3775},  {30, 10, 25, 0.125}, {30, 10, 29.9, 0.0025},
                        {30, 22.5, 25, 0.333334}};
  const Vec3 axis = normalize(Vec3(1, -2, 0.5));
  const Frame frame = oblique_frame(axis);
  for (const Case& c : cases) {
    const auto emitter = make_spot_emitter(Vec3(1, 2, 3), 7.0 * axis, kRadiance, c.cutoff, c.beam);
    const double angle = c.degrees * kPi / 180;
    const Vec3 w = frame.to_world({std::sin(angle), 0, std::cos(angle)});
    EXPECT_NEAR(emitter->L_e(*emitter->sample_position(Vec3(0)), w).x / 4, c.red, 1e-6);
  }
}

TEST(SpotEmitter, DirectionsAreATripleInItsCone) {
  const Vec3 axis = normalize(Vec3(1, -2, 0.5));
  for (const auto& [cutoff, beam] : {std::pair{20.0, 15.0}, {75.0, 0.0}, {130.0, 120.0}}) {
    const auto emitter = make_spot_emitter(Vec3(1, 2, 3), axis, kRadiance, cutoff, beam);
    EXPECT_EQ(emitter->kind(), EmitterKind::Point);
    const auto x = emitter->sample_position(Vec3(0.1));
    EXPECT_EQ(x->surface.position, Vec3(1, 2, 3));
    const double height = 1 - std::cos(cutoff * kPi / 180);
    testing::Chart chart;  // of the cone alone
    const Frame frame = oblique_frame(axis);
    chart.point = [=](const Vec2& c) {
      const double z = 1 - height * c.x, r = std::sqrt(1 - z * z);
      return frame.to_world({r * std::cos(2 * kPi * c.y), r * std::sin(2 * kPi * c.y), z});
    };
    chart.coordinates = [=](const Vec3& w) {
      const Vec3 p = frame.to_local(w);
      const double turn = std::atan2(p.y, p.x) / (2 * kPi);
      return Vec2((1 - p.z) / height, turn < 0 ? turn + 1 : turn);
    };
    chart.jacobian = [=](const Vec2&) { return 2 * kPi * height; };
    EXPECT_EQ(check_triple("spot", direction_triple(*emitter, *x), chart), "");
    testing::expect_near(testing::emitted_flux_density(*emitter, *x, Vec3(0)), emitter->power(),
                         1e-4);
    EXPECT_EQ(emitter->pdf_direction(*x, -axis), 0);
    EXPECT_FALSE(emitter->invert_direction(*x, {-axis, x->surface.position, 0}));
  }
}

TEST(SpotEmitter, RefusesImpossibleCones) {
  for (const auto& [cutoff, beam] : {std::pair{0.0, 0.0}, {181.0, 1.0}, {20.0, 21.0}, {20.0, -1.0}})
    EXPECT_THROW(make_spot_emitter(Vec3(0), Vec3(1, 0, 0), kRadiance, cutoff, beam),
                 std::domain_error);
  EXPECT_THROW(make_spot_emitter(Vec3(0), Vec3(0), kRadiance, 20, 10), std::domain_error);
}

TEST(DirectionalEmitter, IsADiracDirectionAcrossTheScene) {
  const auto emitter = make_directional_emitter(Vec3(1, 2, -2), kRadiance);
  const Vec3 center(10, -4, 3);
  emitter->bind(center, 2.5);
  EXPECT_EQ(emitter->kind(), EmitterKind::Directional);
  const auto x = emitter->sample_position(Vec3(0.1, 0.2, 0.3));
  ASSERT_TRUE(x);
  EXPECT_LT(length(x->surface.n_g - Vec3(1, 2, -2) / 3.0), 1e-15);
  EXPECT_EQ(x->pdf_position, 1);
  EXPECT_EQ(emitter->pdf_position(*x), 1);
  EXPECT_EQ(*emitter->invert_position(*x, Vec3(0.7, 0.8, 0.9)), Vec3(0.7, 0.8, 0.9));
  testing::expect_near(emitter->power(), kPi * sqr(2.5) * kRadiance, 1e-14);
  Rng rng(testing::suite_seed(), RngDomain::Test, 810, 0);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 u = uniform2(rng);
    const EmitterDirection d = emitter->sample_direction(*x, u);
    EXPECT_EQ(d.w, x->surface.n_g);
    const Vec3 across = cross(d.origin - center, d.w);
    EXPECT_LE(length(across), 2.5 * (1 + 1e-14));
    EXPECT_LT(dot(d.origin - center, d.w), -2.5);
    EXPECT_NEAR(d.pdf_direction, 1 / (kPi * sqr(2.5)), 1e-15);
    const auto back = emitter->invert_direction(*x, {d.w, d.origin + 3.0 * d.w, 0});
    ASSERT_TRUE(back);
    EXPECT_LT(length(Vec3(*back - u, 0)), 1e-12);
  }
  EXPECT_EQ(emitter->L_e(*x, x->surface.n_g), kRadiance);
  EXPECT_THROW(make_directional_emitter(Vec3(0), kRadiance), std::domain_error);
}

/// The picture that Mitsuba was asked with: R = 1 + x, G = 10 (y + 1), B = x + 10 y.
Image ramps() {
  Image image(4, 3, {"R", "G", "B"});
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 4; ++x) {
      image.at(x, y, 0) = static_cast<float>(1 + x);
      image.at(x, y, 1) = static_cast<float>(10 * (y + 1));
      image.at(x, y, 2) = static_cast<float>(x + 10 * y);
    }
  return image;
}

EmitterPoint from(const Vec3& d) {
  EmitterPoint x;
  x.surface.n_g = -normalize(d);
  return x;
}

TEST(EnvironmentEmitter, LooksAsInMitsuba) {
  struct Case {
    Vec3 d;
    RGB expected;
  };
  const Case upright[] = {{{0, 0, 1}, {2.5, 20, 11.5}},
                          {{0, 0, -1}, {2.5, 20, 11.5}},
                          {{1, 0, 0}, {1.5, 20, 10.5}},
                          {{-1, 0, 0}, {3.5, 20, 12.5}},
                          {{.3, .2, .9}, {2.29517, 18.6773, 9.97242}},
                          {{-.3, .2, .9}, {2.70483, 18.6773, 10.3821}},
                          {{.3, .9, -.2}, {1.12567, 12.4258, 2.55143}},
                          {{-.5, -.9, -.2}, {3.74224, 26.5673, 19.3095}},
                          {{0.01, .1, .9}, {2.49293, 19.2956, 10.7885}},
                          {{-.01, .1, .9}, {2.50707, 19.2956, 10.8027}}};
  const auto emitter = make_environment_emitter(ramps(), Transform());
  EXPECT_EQ(emitter->kind(), EmitterKind::Infinite);
  for (const Case& c : upright)
    testing::expect_near(emitter->L_e(from(c.d), Vec3(0)), c.expected, 1e-5);
  EXPECT_NEAR(emitter->L_e(from({1e-9, 1, 0}), Vec3(0)).y, 10, 1e-6);
  EXPECT_NEAR(emitter->L_e(from({1e-9, -1, 0}), Vec3(0)).y, 30, 1e-6);
  // scale 2, rotated by 90 degrees around z
  const Case turned[] = {{{0, 1, 0}, {3, 40, 21}},
                         {{0, -1, 0}, {7, 40, 25}},
                         {{.3, .2, .9}, {4.72158, 44.0055, 26.7271}},
                         {{-.3, .2, .9}, {4.72158, 35.9945, 18.7161}},
                         {{-.5, -.9, -.2}, {7.27842, 33.6729, 18.9513}},
                         {{-.01, .1, .9}, {4.85911, 39.8594, 22.7185}}};
  const auto other = make_environment_emitter(ramps(), Transform::rotate({0, 0, 1}, 90), 2);
  for (const Case& c : turned)
    testing::expect_near(other->L_e(from(c.d), Vec3(0)), c.expected, 1e-5);
}

/// Black pixels, a sun in one of them, and noise.
Image sky() {
  Image image(8, 6, {"R", "G", "B"});
  Rng rng(1, RngDomain::Test, 811, 0);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, c) = y > 3 && x < 4 ? 0.0f : static_cast<float>(0.2 + rng.uniform());
  image.at(2, 1, 0) = image.at(2, 1, 1) = 50;
  return image;
}

/// Charts whose grid lines are those of the map's cells, where the density jumps; rows of four
/// pixels at most.
testing::Chart map_chart(const Transform& to_world, int width, int rows) {
  testing::Chart chart;
  const auto edge = [rows](double row) { return std::cos(kPi * row / rows); };
  chart.point = [=](const Vec2& c) {
    const double row = c.y * rows, j = std::min(std::floor(row), rows - 1.0);
    const double z = edge(j) + (row - j) * (edge(j + 1) - edge(j)), r = std::sqrt(1 - z * z);
    const double phi = 2 * kPi * (c.x + 0.5 / width);
    return -normalize(to_world.vector({r * std::sin(phi), z, -r * std::cos(phi)}));
  };
  chart.coordinates = [=](const Vec3& n) {
    const Vec3 d = normalize(to_world.inverse().vector(-n));
    double turn = std::atan2(d.x, -d.z) / (2 * kPi) - 0.5 / width;
    turn -= std::floor(turn);
    const double j = std::min(std::floor(std::acos(d.y) / kPi * rows), rows - 1.0);
    const double row = j + (d.y - edge(j)) / (edge(j + 1) - edge(j));
    return Vec2(turn, std::clamp(row / rows, 0.0, 1.0));
  };
  chart.jacobian = [=](const Vec2& c) {
    const double j = std::min(std::floor(c.y * rows), rows - 1.0);
    return 2 * kPi * rows * (edge(j) - edge(j + 1));
  };
  chart.columns = 4 * width;
  chart.rows = 4 * rows;
  return chart;
}

TEST(EnvironmentEmitter, DirectionsAreATriple) {
  const Transform turned = Transform::rotate({1, 2, 3}, 70) * Transform::scale({3, 3, -3});
  const std::pair<Image, Transform> cases[] = {{sky(), turned}, {ramps(), Transform()}};
  for (const auto& [image, to_world] : cases) {
    const auto emitter = make_environment_emitter(image, to_world);
    emitter->bind(Vec3(1, 2, 3), 2);
    const auto travelling = [](const Vec3& n) {
      EmitterPoint x;
      x.surface.n_g = n;
      return x;
    };
    const Triple triple{2,
                        [&](const Vec3& u) -> std::optional<Vec3> {
                          const auto x = emitter->sample_position(u);
                          EXPECT_NEAR(length(x->surface.n_g), 1, 1e-14);
                          return x->surface.n_g;
                        },
                        [&](const Vec3& n) { return emitter->pdf_position(travelling(n)); },
                        [&](const Vec3& n, const Vec3& auxiliary) {
                          return emitter->invert_position(travelling(n), auxiliary);
                        }};
    EXPECT_EQ(
        check_triple("environment", triple, map_chart(to_world, image.width, image.height - 1)),
        "");
  }
}

/// What sampling says of the flux is what the emitter says, and weights are bounded.
TEST(EnvironmentEmitter, SamplesWhatShines) {
  const auto emitter = make_environment_emitter(sky(), Transform::rotate({1, 0, 1}, 30));
  emitter->bind(Vec3(0), 1);
  RGB sum(0);
  constexpr int kSamples = 400000;
  Rng rng(testing::suite_seed(), RngDomain::Test, 812, 0);
  double largest = 0;
  for (int i = 0; i < kSamples; ++i) {
    const auto x = emitter->sample_position(uniform3(rng));
    const RGB weight = emitter->L_e(*x, x->surface.n_g) / x->pdf_position;
    largest = std::max(largest, luminance(weight));
    sum += weight;
  }
  const RGB flux = emitter->power() / kPi;
  // A corner's share of its cell's flux is no less than that of the pole's row: 1/2 · 1/3.
  EXPECT_LT(largest, 6 * luminance(flux));
  // Against the integral over the sphere, cell by cell of the map.
  const testing::Chart chart = map_chart(Transform::rotate({1, 0, 1}, 30), 8, 5);
  for (int c = 0; c < 3; ++c) {
    double integral = 0;
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j < 5; ++j)
        integral += testing::integrate(
            [&](const Vec2& p) {
              EmitterPoint x;
              x.surface.n_g = chart.point(p);
              return emitter->L_e(x, Vec3(0))[c] * chart.jacobian(p);
            },
            Vec2(i / 8.0, j / 5.0 + 1e-12), Vec2((i + 1) / 8.0, (j + 1) / 5.0 - 1e-12), 1e-6);
    EXPECT_NEAR(integral, flux[c], 1e-4 * flux[c]);
  }
  testing::expect_near(sum / double(kSamples), flux, 0.005);
}

TEST(EnvironmentEmitter, ResolvesPolesAndSeams) {
  const auto emitter = make_environment_emitter(sky(), Transform());
  emitter->bind(Vec3(0), 1);
  for (const double side : {1.0, -1.0})
    for (const double x : {1e-2, 1e-5, 1e-8, 1e-12}) {
      const EmitterPoint p = from({side * x, side, 0.3 * x});
      const auto u = emitter->invert_position(p, Vec3(0.5));
      ASSERT_TRUE(u);
      const auto back = emitter->sample_position(*u);
      // Primary samples near one are coarser than those near zero.
      EXPECT_LT(length(back->surface.n_g - p.surface.n_g), side > 0 ? 1e-7 * x + 1e-15 : 1e-7);
    }
  const Vec3 seam(0, 0.3, -1);
  EXPECT_LT(length(emitter->L_e(from(seam + Vec3(1e-12, 0, 0)), Vec3(0)) -
                   emitter->L_e(from(seam - Vec3(1e-12, 0, 0)), Vec3(0))),
            1e-9);
}

TEST(EnvironmentEmitter, RefusesWhatIsNoSky) {
  EXPECT_THROW(make_environment_emitter(Image(1, 3, {"R", "G", "B"}), Transform()),
               std::domain_error);
  EXPECT_THROW(make_environment_emitter(Image(4, 3, {"R", "G", "B"}), Transform()),
               std::domain_error);
  Image bad = ramps();
  bad.at(2, 1, 0) = -1;
  EXPECT_THROW(make_environment_emitter(bad, Transform()), std::domain_error);
  bad.at(2, 1, 0) = std::numeric_limits<float>::infinity();
  EXPECT_THROW(make_environment_emitter(bad, Transform()), std::domain_error);
  Image depth(4, 3, {"R", "G", "Z"});
  EXPECT_THROW(make_environment_emitter(depth, Transform()), std::domain_error);
  EXPECT_THROW(make_environment_emitter(ramps(), Transform::scale({1, 2, 1})), std::domain_error);
}

}  // namespace
}  // namespace fogbow
