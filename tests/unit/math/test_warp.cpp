// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/math/warp.h"
#include "tests/helpers/triples.h"

namespace fogbow {
namespace {

using testing::check_triple;
using testing::Triple;

Vec3 with_third(const Vec2& u, double third) { return {u.x, u.y, third}; }

/// A map of two primary samples to directions.
template <class Sample, class Pdf, class Invert>
Triple directions(Sample sample, Pdf pdf, Invert invert) {
  return {2, [=](const Vec3& u) -> std::optional<Vec3> { return sample(Vec2(u)); },
          [=](const Vec3& w) { return pdf(w); },
          [=](const Vec3& w, const Vec3& auxiliary) -> std::optional<Vec3> {
            if (!(pdf(w) > 0)) return std::nullopt;
            return with_third(invert(w), auxiliary.z);
          }};
}

/// A map of one primary sample to a distance.
template <class Law>
Triple distances(const Law& law) {
  return {1, [=](const Vec3& u) -> std::optional<Vec3> { return Vec3(law.sample(u.x), 0, 0); },
          [=](const Vec3& t) { return law.pdf(t.x); },
          [=](const Vec3& t, const Vec3&) -> std::optional<Vec3> {
            if (!(law.pdf(t.x) > 0)) return std::nullopt;  // underflow
            return Vec3(law.invert(t.x), 0, 0);
          }};
}

TEST(Warp, Disk) {
  const Triple disk{
      2, [](const Vec3& u) -> std::optional<Vec3> { return Vec3(warp::sample_disk(u), 0); },
      [](const Vec3& p) { return warp::pdf_disk(p); },
      [](const Vec3& p, const Vec3&) -> std::optional<Vec3> {
        if (!(warp::pdf_disk(p) > 0)) return std::nullopt;
        return Vec3(warp::invert_disk(p), 0);
      }};
  // Polar coordinates: the rim is a grid line.
  testing::Chart polar;
  polar.point = [](const Vec2& c) {
    return Vec3(c.x * std::cos(2 * kPi * c.y), c.x * std::sin(2 * kPi * c.y), 0);
  };
  polar.coordinates = [](const Vec3& p) {
    const double turn = std::atan2(p.y, p.x) / (2 * kPi);
    return Vec2(std::hypot(p.x, p.y), turn < 0 ? turn + 1 : turn);
  };
  polar.jacobian = [](const Vec2& c) { return 2 * kPi * c.x; };
  EXPECT_EQ(check_triple("disk", disk, polar), "");
}

TEST(Warp, CosineHemisphere) {
  const Triple triple = directions(warp::sample_cosine_hemisphere, warp::pdf_cosine_hemisphere,
                                   warp::invert_cosine_hemisphere);
  EXPECT_EQ(check_triple("cosine hemisphere", triple, testing::sphere_chart()), "");
}

TEST(Warp, CosineHemisphereIsExactAtGrazingAngles) {
  for (const double rim : {1e-6, 1e-9, 1e-12, 1e-15}) {
    const Vec2 u(0.5 * rim, 0.3);
    const Vec3 w = warp::sample_cosine_hemisphere(u);
    EXPECT_NEAR(w.z, std::sqrt(rim * (2 - rim)), 1e-14 * w.z);
    EXPECT_NEAR(warp::invert_cosine_hemisphere(w).x, u.x, 1e-14 * u.x);
  }
}

TEST(Warp, SphereHemisphereCone) {
  EXPECT_EQ(check_triple("sphere",
                         directions(
                             warp::sample_sphere, [](const Vec3&) { return warp::pdf_sphere(); },
                             warp::invert_sphere),
                         testing::sphere_chart()),
            "");
  EXPECT_EQ(check_triple(
                "hemisphere",
                directions(warp::sample_hemisphere, warp::pdf_hemisphere, warp::invert_hemisphere),
                testing::sphere_chart()),
            "");
  for (const double d : {1e-10, 1e-3, 0.25, 1.5}) {
    const Triple cone = directions([d](const Vec2& u) { return warp::sample_cone(u, d); },
                                   [d](const Vec3& w) { return warp::pdf_cone(w, d); },
                                   [d](const Vec3& w) { return warp::invert_cone(w, d); });
    // Half of the grid within the cone: its rim is a grid line.
    EXPECT_EQ(check_triple("cone " + std::to_string(d), cone, testing::lobe_chart(Frame(), d)), "");
  }
}

TEST(Warp, Triangle) {
  const Triple triangle{
      2, [](const Vec3& u) -> std::optional<Vec3> { return Vec3(warp::sample_triangle(u), 0); },
      [](const Vec3&) { return warp::pdf_triangle(); },
      [](const Vec3& b, const Vec3&) -> std::optional<Vec3> {
        return Vec3(warp::invert_triangle(b), 0);
      }};
  testing::Chart chart;  // b₁ = c₀, b₂ = (1 − c₀) c₁
  chart.point = [](const Vec2& c) { return Vec3(c.x, (1 - c.x) * c.y, 0); };
  chart.coordinates = [](const Vec3& b) { return Vec2(b.x, b.y / (1 - b.x)); };
  chart.jacobian = [](const Vec2& c) { return 1 - c.x; };
  EXPECT_EQ(check_triple("triangle", triangle, chart), "");
}

TEST(Warp, HenyeyGreenstein) {
  for (const double g : {-0.99, -0.5, -1e-9, 0.0, 1e-300, 1e-9, 1e-3, 0.3, 0.8, 0.99, 0.9999}) {
    const auto pdf = [g](const Vec3& w) {
      // Plainly, as the formula is written.
      return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * w.z, 1.5));
    };
    const auto sides = [](const Vec3& w) {
      const double d = warp::one_minus_cos(w), s = warp::one_minus_cos(-w);
      return Vec2(d, s);
    };
    const Triple triple =
        directions([g](const Vec2& u) { return warp::sample_henyey_greenstein(u, g); },
                   [g, sides](const Vec3& w) {
                     return warp::pdf_henyey_greenstein(g, sides(w).x, sides(w).y);
                   },
                   [g, sides](const Vec3& w) {
                     return Vec2(warp::invert_henyey_greenstein(g, sides(w).x, sides(w).y),
                                 warp::invert_azimuth(w.x, w.y));
                   });
    const Frame frame(Vec3(0, 0, g < 0 ? -1 : 1));
    const double spread = std::pow(1 - std::fabs(g), 1.5);
    EXPECT_EQ(check_triple("HG " + std::to_string(g), triple, testing::lobe_chart(frame, spread)),
              "");
    for (const double z : {-1.0, -0.3, 0.2, 0.9, 1.0})
      EXPECT_NEAR(warp::pdf_henyey_greenstein(g, 1 - z, 1 + z), pdf({0, 0, z}),
                  1e-15 / sqr(1 - std::fabs(g)) * pdf({0, 0, z}));
  }
}

TEST(Warp, TruncatedExponential) {
  for (const double sigma : {0.0, 1e-320, 1e-12, 0.1, 3.0, 500.0}) {
    const warp::TruncatedExponential law{sigma, 2.0};
    const double scale = sigma > 1 ? 1 / sigma : 2.0;
    testing::Chart chart = testing::interval_chart(0, kInfinity, scale);
    const Triple triple = distances(law);
    Triple cut = triple;
    cut.pdf = [law](const Vec3& t) { return t.x < 2 ? law.pdf(t.x) : 0.0; };
    cut.invert = [law](const Vec3& t, const Vec3&) -> std::optional<Vec3> {
      if (!(t.x < 2 && law.pdf(t.x) > 0)) return std::nullopt;
      return Vec3(law.invert(t.x), 0, 0);
    };
    EXPECT_EQ(check_triple("truncated exponential " + std::to_string(sigma), cut, chart), "");
  }
  const warp::TruncatedExponential endless{0.5, kInfinity};
  EXPECT_EQ(
      check_triple("exponential", distances(endless), testing::interval_chart(0, kInfinity, 2)),
      "");
}

/// Medium and wall together: the wall is the point (−1, 0, 0), with a mass instead of a density.
TEST(Warp, FreeFlightWithWall) {
  for (const double T : {1e-9, 0.3, 2.0, 12.0}) {
    const warp::FreeFlight law{1.7, T};
    const Triple medium{1,
                        [law](const Vec3& u) -> std::optional<Vec3> {
                          const auto t = law.sample(u.x);
                          if (!t) return std::nullopt;
                          return Vec3(*t, 0, 0);
                        },
                        [law](const Vec3& t) { return law.pdf(t.x); },
                        [law](const Vec3& t, const Vec3&) -> std::optional<Vec3> {
                          return Vec3(law.invert(t.x), 0, 0);
                        }};
    EXPECT_EQ(check_triple("free flight " + std::to_string(T), medium,
                           testing::interval_chart(0, T), {.mass = -std::expm1(-1.7 * T)}),
              "");
    EXPECT_NEAR(law.wall_mass() + law.medium_mass(), 1, 1e-15);
    for (const double auxiliary : {0.0, 0.3, kOneMinusEpsilon}) {
      const auto u = law.invert_wall(auxiliary);
      ASSERT_TRUE(u);
      EXPECT_FALSE(law.sample(*u)) << "the wall's primary samples lead to the wall";
      EXPECT_NEAR(*u, 1 - std::exp(-1.7 * T) * (1 - auxiliary), 1e-14);
    }
    // Up to the wall, and never beyond it.
    EXPECT_LT(*law.sample(std::nextafter(law.medium_mass(), 0.0)), T);
  }
  EXPECT_FALSE((warp::FreeFlight{0.0, 1.0}.sample(0.0))) << "vacuum";
  EXPECT_FALSE((warp::FreeFlight{0.0, kInfinity}.sample(0.999))) << "endless vacuum";
  EXPECT_FALSE((warp::FreeFlight{1.0, 100.0}.invert_wall(0.5)));
}

TEST(Warp, Equiangular) {
  const warp::Equiangular laws[] = {
      {0.7, 0.4, 0, 2},    {-3, 0.1, 0, 1},       {5, 1e-3, 0, 4.9},
      {0.5, 1e-7, 0, 1},   {1e6, 1e-3, 0, 1e6},   {2, 30, 0.1, 5},
      {0.7, 0.4, 0, 1e12}, {-1e5, 1e-4, 0, 1e-3}, {1e5, 1e-4, 0, 1e-3}};
  int number = 0;
  for (const auto& law : laws) {
    testing::Chart chart = testing::interval_chart(law.t0, law.t1);
    // In the law's own angle the density is smooth, however narrow it is.
    const double a = std::atan2(law.t0 - law.foot, law.distance),
                 b = std::atan2(law.t1 - law.foot, law.distance);
    if (b - a > 0.5) {
      chart.point = [=](const Vec2& c) {
        return Vec3(law.foot + law.distance * std::tan(a + c.x * (b - a)), 0, 0);
      };
      chart.coordinates = [=](const Vec3& t) {
        return Vec2((std::atan2(t.x - law.foot, law.distance) - a) / (b - a), 0.5);
      };
      chart.jacobian = [=](const Vec2& c) {
        return law.distance * (b - a) / sqr(std::cos(a + c.x * (b - a)));
      };
    }
    EXPECT_EQ(check_triple("equiangular " + std::to_string(number++), distances(law), chart,
                           {.tolerance = 1e-12}),
              "");
  }
  // The foot far nearer than the end: the density falls as 1/t² over twelve decades.
  const warp::Equiangular steep{-1e-3, 1e-6, 0, 1e9};
  testing::Chart reciprocal;
  reciprocal.columns = 256;
  reciprocal.rows = 1;
  reciprocal.point = [](const Vec2& c) { return Vec3(1e-3 * c.x / (1 - c.x + 1e-12), 0, 0); };
  reciprocal.coordinates = [](const Vec3& t) {
    return Vec2(t.x * (1 + 1e-12) / (t.x + 1e-3), 0.5);
  };
  reciprocal.jacobian = [](const Vec2& c) { return 1e-3 * (1 + 1e-12) / sqr(1 - c.x + 1e-12); };
  EXPECT_EQ(check_triple("equiangular steep", distances(steep), reciprocal, {.tolerance = 1e-12}),
            "");
  const warp::Equiangular endless{0.7, 0.4, 0, kInfinity};
  EXPECT_EQ(check_triple("equiangular endless", distances(endless),
                         testing::interval_chart(0, kInfinity, 0.7), {.tolerance = 1e-12}),
            "");
  const warp::Equiangular endless_behind{-0.7, 0.4, 0, kInfinity};
  EXPECT_EQ(check_triple("equiangular endless behind", distances(endless_behind),
                         testing::interval_chart(0, kInfinity, 0.7), {.tolerance = 1e-12}),
            "");
}

TEST(Warp, InvertedIntervalsStayInside) {
  for (const double lo : {0.0, 0.1, 0.5, 1 - 0x1p-52})
    for (const double hi : {std::nextafter(lo, 1.0), lo + 0.5 * (1 - lo), 1.0})
      for (const double auxiliary : {0.0, 0.5, kOneMinusEpsilon}) {
        if (!(hi > lo)) continue;
        const double u = warp::invert_interval(lo, hi, auxiliary);
        EXPECT_GE(u, lo);
        EXPECT_LT(u, hi);
      }
}

}  // namespace
}  // namespace fogbow
