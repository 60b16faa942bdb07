// SPDX-License-Identifier: GPL-3.0-or-later
// Values: eval() of Mitsuba 3.9.1's sunsky (scalar_rgb), sun at azimuth 0.3.
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/math/random.h"
#include "core/scene/sun_sky_model.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/lightcam/emitter_triples.h"

namespace fogbow {
namespace {

using testing::check_triple;
using testing::oblique_frame;

constexpr double kDegree = kPi / 180;

Vec3 direction(double elevation_degrees, double azimuth) {
  const double e = elevation_degrees * kDegree;
  return {std::cos(e) * std::cos(azimuth), std::cos(e) * std::sin(azimuth), std::sin(e)};
}

EmitterPoint from(const Vec3& d) {
  EmitterPoint x;
  x.surface.n_g = -d;
  return x;
}
RGB radiance(const Emitter& emitter, const Vec3& d) { return emitter.L_e(from(d), -d); }

void expect_color(const RGB& ours, const RGB& mitsubas, double relative) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(ours[c], mitsubas[c], relative * max_component(glm::abs(mitsubas)));
}

TEST(SkyEmitter, IsMitsubas) {
  struct Value {
    double elevation, turbidity;
    RGB albedo;
    Vec2 towards;
    RGB radiance;
  };
  const Value values[] = {
      {3, 2.5, {0.1, 0.3, 0.6}, {80, 2}, {0.006144712, 0.009909875, 0.01376049}},
      {3, 2.5, {0.1, 0.3, 0.6}, {5, 0.35}, {0.2973296, 0.1696751, 0.05387278}},
      {3, 2.5, {0.1, 0.3, 0.6}, {1, 3.9}, {0.0803073, 0.05552835, 0.02236767}},
      {25, 6.3, RGB(0.3), {80, 2}, {0.0244418, 0.0376373, 0.06010465}},
      {25, 6.3, RGB(0.3), {27, 0.35}, {0.7592413, 0.6822373, 0.4897786}},
      {25, 6.3, RGB(0.3), {1, 3.9}, {0.1252948, 0.1289547, 0.1225053}},
      {70, 1, {0, 1, 0.5}, {80, 2}, {0.01753447, 0.06447811, 0.1142475}},
      {70, 1, {0, 1, 0.5}, {72, 0.35}, {0.03182622, 0.09350622, 0.133798}},
      {70, 1, {0, 1, 0.5}, {1, 3.9}, {0.1071709, 0.3599449, 0.2987681}},
  };
  for (const Value& v : values) {
    SunSkySettings s;
    s.turbidity = v.turbidity;
    s.albedo = v.albedo;
    s.sun_direction = direction(v.elevation, 0.3);
    const auto sky = make_sky_emitter(s);
    const Vec3 d = direction(v.towards.x, v.towards.y);
    expect_color(radiance(*sky, d), v.radiance, 1e-5);
    EXPECT_EQ(radiance(*sky, Vec3(d.x, d.y, -d.z)), RGB(0));
    s.sky_scale = 2;
    expect_color(radiance(*make_sky_emitter(s), d), 2.0 * v.radiance, 1e-5);
  }
}

TEST(SunEmitter, IsMitsubas) {
  struct Value {
    double elevation, turbidity;
    RGB flat, limb, large;  ///< the last two with limb darkening; apertures 0.5358, 0.5358 and 4
  };
  const Value values[] = {
      {3,
       2.5,
       {6554.512, 2401.073, 158.4077},
       {7282.179, 2580.198, 65.12849},
       {175.9895, 71.93463, 5.965867}},
      {25,
       6.3,
       {16147.5, 12121.95, 7664.866},
       {16428.1, 12353.71, 7823.779},
       {332.646, 257.5484, 171.423}},
      {70,
       1,
       {22641.17, 19136.09, 14949.41},
       {22943.28, 19394.21, 15130.13},
       {459.1123, 397.6939, 322.5231}},
  };
  for (const Value& v : values) {
    SunSkySettings s;
    s.turbidity = v.turbidity;
    s.sun_direction = direction(v.elevation, 0.3);
    // Of the mean over the disk Mitsuba's quadrature is a little coarser, and so is its ratio of
    // two small solid angles, in single precision.
    expect_color(radiance(*make_sun_emitter(s), s.sun_direction), v.flat, 3e-3);
    s.limb_darkening = true;
    expect_color(radiance(*make_sun_emitter(s), direction(v.elevation + 0.2, 0.3)), v.limb, 1e-4);
    EXPECT_EQ(radiance(*make_sun_emitter(s), direction(v.elevation + 0.27, 0.3)), RGB(0));
    s.sun_aperture_degrees = 4;
    expect_color(radiance(*make_sun_emitter(s), direction(v.elevation + 1, 0.3)), v.large, 3e-3);
  }
}

/// A world that is turned, or mirrored, with its sun has the same sky.
TEST(SunAndSky, TurnWithTheWorld) {
  const Transform turn = Transform::rotate({1, 2, -0.5}, 70);
  for (const Transform& to_world : {turn, turn * Transform::scale({3, -3, 3})})
    for (const bool limb_darkening : {false, true}) {
      SunSkySettings s;
      s.sun_direction = direction(12, 0.3);
      s.sun_aperture_degrees = 10;
      s.limb_darkening = limb_darkening;
      SunSkySettings turned = s;
      turned.to_world = to_world;
      turned.sun_direction = normalize(to_world.vector(s.sun_direction));
      for (const auto make : {make_sky_emitter, make_sun_emitter}) {
        const auto plain = make(s), other = make(turned);
        for (const Vec3& d : {direction(9, 0.3), direction(14, 0.27), direction(12, 0.35)}) {
          const RGB expected = radiance(*plain, d);
          EXPECT_GT(expected.x, 0);
          expect_color(radiance(*other, normalize(to_world.vector(d))), expected, 1e-9);
        }
      }
    }
}

/// Of a sun on the horizon the lower half is not there.
TEST(SunEmitter, EndsAtTheHorizon) {
  for (const bool limb_darkening : {false, true}) {
    SunSkySettings s;
    s.sun_direction = direction(0.5, 0.3);
    s.sun_aperture_degrees = 6;
    s.limb_darkening = limb_darkening;
    const auto sun = make_sun_emitter(s);
    EXPECT_GT(radiance(*sun, direction(1, 0.3)).x, 0);
    EXPECT_EQ(radiance(*sun, direction(-1, 0.3)), RGB(0));
  }
}

/// sun_direction of Mitsuba 3.9.1, which computes it in single precision.
TEST(SunDirection, IsMitsubas) {
  const auto expect = [](const SunTime& t, const Vec3& d) {
    EXPECT_LT(length(sun_direction(t) - d), 2e-3);
  };
  expect({}, {0.05138545, 0.6917480, 0.7203085});
  SunTime t;
  t.hour = 9;
  t.minute = 30;
  t.second = 20;
  expect(t, {0.13950056, -0.5181220, 0.8438538});
  t = {2010, 3, 20, 12, 0, 0, 48, 11, 1};
  expect(t, {0.74033242, -0.1023862, 0.6643983});
  t = {2022, 12, 1, 10, 0, 0, -33, 151, 10};
  expect(t, {-0.14290468, -0.4101345, 0.9007596});
  t = SunTime{};
  t.hour = 22;
  expect(t, {-0.7897207, 0.4152324, -0.4515787});
}

testing::Triple position_triple(const Emitter& emitter) {
  return {2,
          [&emitter](const Vec3& u) -> std::optional<Vec3> {
            const auto x = emitter.sample_position(u);
            EXPECT_NEAR(x->pdf_position, emitter.pdf_position(*x), 1e-9 * x->pdf_position);
            return -x->surface.n_g;
          },
          [&emitter](const Vec3& d) { return emitter.pdf_position(from(d)); },
          [&emitter](const Vec3& d, const Vec3& auxiliary) {
            return emitter.invert_position(from(d), auxiliary);
          }};
}

SunSkySettings oblique_settings() {
  SunSkySettings s;
  s.to_world = Transform::rotate(Vec3(1, 2, -0.5), 70);
  s.sun_direction = s.to_world.vector(direction(20, 1));
  return s;
}

TEST(SkyEmitter, DirectionsAreATriple) {
  const SunSkySettings s = oblique_settings();
  const auto sky = make_sky_emitter(s);
  sky->bind(Vec3(0), 1);
  // The horizon is a line of the chart's grid.
  const auto axis = [&](const Vec3& v) { return s.to_world.vector(v); };
  const Frame frame(axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1}));
  EXPECT_EQ(check_triple("sky", position_triple(*sky), testing::sphere_chart(frame)), "");
}

TEST(SunEmitter, DirectionsAreATriple) {
  SunSkySettings s = oblique_settings();
  for (const double aperture : {0.5358, 40.0}) {
    s.sun_aperture_degrees = aperture;
    const auto sun = make_sun_emitter(s);
    sun->bind(Vec3(0), 1);
    const double width = 1 - std::cos(0.5 * aperture * kDegree);
    EXPECT_EQ(check_triple("sun", position_triple(*sun),
                           testing::lobe_chart(oblique_frame(s.sun_direction), width)),
              "");
  }
}

/// What the ground gets, once over the dome and once by samples; and power() against the integral
/// of the radiance. A bad table of densities would make the samples' worth run wild.
TEST(SunAndSky, IrradianceOfTheGround) {
  SunSkySettings s;
  for (const double elevation : {5.0, 30.0, 75.0})
    for (const double turbidity : {2.0, 8.0}) {
      s.turbidity = turbidity;
      s.sun_direction = direction(elevation, 1);
      const auto sky = make_sky_emitter(s);
      sky->bind(Vec3(0), 1);
      double irradiance = 0, flux = 0;
      constexpr int n = 1500;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const double z = (j + 0.5) / n, phi = 2 * kPi * (i + 0.5) / n, r = std::sqrt(1 - z * z);
          const Vec3 d(r * std::cos(phi), r * std::sin(phi), z);
          const double L = luminance(radiance(*sky, d)) * 2 * kPi / (double(n) * n);
          irradiance += L * z;
          flux += L;
        }
      EXPECT_NEAR(luminance(sky->power()) / kPi, flux, 2e-3 * flux);
      Rng rng(testing::suite_seed(), RngDomain::Test, 740, 0);
      double sum = 0, squares = 0;
      constexpr int kSamples = 100000;
      for (int i = 0; i < kSamples; ++i) {
        const auto x = sky->sample_position(Vec3(uniform2(rng), 0));
        const Vec3 d = -x->surface.n_g;
        const double worth = luminance(radiance(*sky, d)) * d.z / x->pdf_position;
        sum += worth;
        squares += sqr(worth);
      }
      const double mean = sum / kSamples;
      const double deviation = std::sqrt(squares / kSamples - sqr(mean));
      EXPECT_LT(deviation, 1.2 * mean) << elevation << ' ' << turbidity;
      EXPECT_NEAR(mean, irradiance, 4.5 * deviation / std::sqrt(double(kSamples)));
      const auto sun = make_sun_emitter(s);
      sun->bind(Vec3(0), 1);
      const double solid_angle = 2 * kPi * (1 - std::cos(0.2679 * kDegree));
      testing::expect_near(sun->power() / kPi, solid_angle * radiance(*sun, s.sun_direction), 1e-9);
    }
}

TEST(SunAndSky, RefuseWhatTheModelDoesNotKnow) {
  const auto refused = [](auto&& change) {
    SunSkySettings s;
    change(s);
    EXPECT_THROW((make_sky_emitter(s), make_sun_emitter(s)), std::domain_error);
  };
  refused([](auto& s) { s.turbidity = 0.9; });
  refused([](auto& s) { s.turbidity = 10.1; });
  refused([](auto& s) { s.turbidity = std::nan(""); });
  refused([](auto& s) { s.albedo = RGB(0.5, 1.1, 0); });
  refused([](auto& s) { s.sun_direction = direction(-1, 0); });
  refused([](auto& s) { s.sun_aperture_degrees = 0; });
  refused([](auto& s) { s.sky_scale = -1; });
  refused([](auto& s) { s.to_world = Transform::scale(Vec3(1, 1, 2)); });
}

}  // namespace
}  // namespace fogbow
