// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"

namespace fogbow::testing {
namespace {

TEST(Fresnel, KnownAngles) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5), 0.04, 1e-15);
  const double brewster = std::atan(1.5);  // p vanishes: half of s = sin²(2θ − π/2)
  EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1.5), sqr(std::cos(2 * brewster)) / 2, 1e-15);
  EXPECT_EQ(fresnel_dielectric(std::cos(0.8), 1 / 1.5), 1);  // beyond 41.8°
  EXPECT_LT(fresnel_dielectric(std::cos(0.7), 1 / 1.5), 1);
  for (const double angle : {0.1, 0.7, 1.4})  // the same from both sides
    EXPECT_NEAR(fresnel_dielectric(std::cos(angle), 1.33),
                fresnel_dielectric(std::cos(std::asin(std::sin(angle) / 1.33)), 1 / 1.33), 1e-14);
}

TEST(FresnelPlate, EqualsTheBouncesAddedOneByOne) {
  for (const double angle : {0.0, 0.6, 1.3}) {
    for (const double optical_depth : {0.0, 0.7}) {
      const double c = std::cos(angle), inside = std::cos(std::asin(std::sin(angle) / 1.5));
      const double pass = std::exp(-optical_depth / inside);
      double reflected = fresnel_dielectric(c, 1.5), transmitted = 0, flux = 1 - reflected;
      for (int bounce = 0; bounce < 200; ++bounce) {
        flux *= pass;
        const double f = fresnel_dielectric(inside, 1 / 1.5);
        (bounce % 2 ? reflected : transmitted) += flux * (1 - f);
        flux *= f;
      }
      const SlabTransport plate = fresnel_plate(c, 1.5, optical_depth);
      EXPECT_NEAR(plate.reflected, reflected, 1e-13);
      EXPECT_NEAR(plate.transmitted, transmitted, 1e-13);
      if (optical_depth == 0) {
        EXPECT_NEAR(plate.reflected + plate.transmitted, 1, 1e-14);
      }
    }
  }
}

TEST(Refraction, ObeysSnellInThePlaneOfIncidence) {
  const Vec3 d = normalize(Vec3(0.3, -0.2, -0.9)), n(0, 0, 1);
  const Vec3 t = *refract_direction(d, n, 1.5);
  EXPECT_NEAR(length(t), 1, 1e-15);
  EXPECT_NEAR(length(cross(t, n)) * 1.5, length(cross(d, n)), 1e-15);
  EXPECT_NEAR(dot(cross(d, n), t), 0, 1e-15);
  EXPECT_LT(dot(t, n), 0);
  EXPECT_NEAR(length(*refract_direction(t, n, 1 / 1.5) - d), 0, 1e-14);
  EXPECT_FALSE(refract_direction(normalize(Vec3(1, 0, -0.5)), n, 1 / 1.5));
}

TEST(MirrorImage, GivesTheIrradianceOfTheFoldedPath) {
  const Vec3 light(0.3, 0.4, 2), p(1, 0.5, 0), n(0, 0, 1), plane(2, 0, 0), across(-1, 0, 0);
  const Vec3 image = mirror_image(light, plane, across);
  EXPECT_NEAR(length(image - Vec3(3.7, 0.4, 2)), 0, 1e-15);
  const SpecularLink link = flat_mirror(light, p, plane, across);
  const double unfolded = length(link.vertex - light) + length(p - link.vertex);
  EXPECT_NEAR(unfolded, length(image - p), 1e-14);
  EXPECT_NEAR(point_irradiance(p, n, image, 5),
              5 * link.jacobian * dot(normalize(link.vertex - p), n), 1e-14);
  EXPECT_NEAR(link.vertex.x, 2, 1e-15);
  EXPECT_EQ(point_irradiance(p, -n, image, 5), 0);
}

struct FlatCase {
  Vec3 a, b;
  double n_a, n_b;
};
const Vec3 kPoint(0.1, -0.3, 0.2), kNormal = normalize(Vec3(0.2, -0.1, 1));
const FlatCase kFlat[] = {{{0, 0, 1.7}, {1.4, 0.6, -0.8}, 1, 1.5},
                          {{0, 0, 1.7}, {1.4, 0.6, -0.8}, 1.5, 1},
                          {{-3, 1, 1.9}, {4, -1, -2.5}, 1, 1.33},
                          {{-3, 1, 1.4}, {-3.1, 1.05, -2.5}, 1.33, 1}};

TEST(FlatRefraction, EqualsFiniteDifferences) {
  for (const FlatCase& c : kFlat) {
    const SpecularLink link = flat_refraction(c.a, c.b, kPoint, kNormal, c.n_a, c.n_b);
    EXPECT_NEAR(dot(link.vertex - kPoint, kNormal), 0, 1e-14);
    const auto trace = [&](const Vec3& d) -> std::optional<Ray> {
      const Vec3 hit = c.a + d * (dot(kPoint - c.a, kNormal) / dot(d, kNormal));
      const std::optional<Vec3> beyond = refract_direction(d, kNormal, c.n_b / c.n_a);
      if (!beyond) return std::nullopt;
      return Ray{hit, *beyond};
    };
    const Vec3 start = normalize(link.vertex - c.a);
    const Ray last = *trace(start);
    EXPECT_NEAR(length(cross(c.b - last.o, last.d)), 0, 1e-12);  // the chain meets b
    EXPECT_NEAR(jacobian_by_differences(trace, start, c.b) / link.jacobian, 1, 1e-9);
  }
}

TEST(FlatRefraction, ReversesByTheSquaredIndices) {
  for (const FlatCase& c : kFlat) {
    const double there = flat_refraction(c.a, c.b, kPoint, kNormal, c.n_a, c.n_b).jacobian;
    const double back = flat_refraction(c.b, c.a, kPoint, -kNormal, c.n_b, c.n_a).jacobian;
    EXPECT_NEAR(sqr(c.n_a) * there / (sqr(c.n_b) * back), 1, 1e-14);
  }
}

TEST(FlatRefraction, MatchedIndicesAndNormalIncidence) {
  const FlatCase& c = kFlat[0];
  EXPECT_NEAR(
      flat_refraction(c.a, c.b, kPoint, kNormal, 1.3, 1.3).jacobian * length_squared(c.b - c.a), 1,
      1e-14);
  // straight down: apparent depth l_a + l_b n_a/n_b
  const SpecularLink link = flat_refraction({0, 0, 2}, {0, 0, -3}, Vec3(0), {0, 0, 1}, 1, 1.5);
  EXPECT_NEAR(link.jacobian, 1 / sqr(2 + 3 / 1.5), 1e-15);
  EXPECT_THROW(flat_refraction(c.a, c.a, kPoint, kNormal, 1, 1.5), std::domain_error);
}

TEST(FlatMirror, EqualsFiniteDifferences) {
  const Vec3 a(0, 0, 1.7), b(1.4, 0.6, 0.9);
  const SpecularLink link = flat_mirror(a, b, kPoint, kNormal);
  EXPECT_NEAR(dot(link.vertex - kPoint, kNormal), 0, 1e-14);
  const auto trace = [&](const Vec3& d) -> std::optional<Ray> {
    return Ray{a + d * (dot(kPoint - a, kNormal) / dot(d, kNormal)), mirror_direction(d, kNormal)};
  };
  EXPECT_NEAR(jacobian_by_differences(trace, normalize(link.vertex - a), b) / link.jacobian, 1,
              1e-9);
}

TEST(PixelGrid, PixelsCoverTheSolidAngleOfThePicture) {
  const PixelGrid grid{70, 6, 4};
  // dσ = cos³ dA on the film plane at distance 1
  double solid_angle = 0;
  const double half = std::tan(35 * kPi / 180), area = sqr(2 * half / 6);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x)
      solid_angle += area * grid.pixel_mean(x, y, [](const Vec3& d) { return d.z * d.z * d.z; });
  const double a = half, b = half * 4 / 6;  // of a rectangle 2a × 2b seen from distance 1
  EXPECT_NEAR(solid_angle, 4 * std::atan(a * b / std::sqrt(1 + a * a + b * b)), 1e-12);
  EXPECT_NEAR(std::atan2(grid.direction(6, 2).x, grid.direction(6, 2).z), 35 * kPi / 180, 1e-14);
  EXPECT_LT(grid.direction(1, 3.9).x, 0);
  EXPECT_GT(grid.direction(1, 3.9).y, 0);
}

TEST(PixelGrid, RasterInvertsDirectionAndImportanceIsItsDensity) {
  const PixelGrid grid{70, 6, 4};
  for (const Vec2 p : {Vec2(0.3, 3.9), Vec2(3, 2), Vec2(5.5, 0.2)}) {
    const Vec3 d = grid.direction(p.x, p.y);
    EXPECT_NEAR(length(grid.raster(d) - p), 0, 1e-13);
    const double h = 1e-4;  // dσ of a raster cell by differences
    const Vec3 du = (grid.direction(p.x + h, p.y) - grid.direction(p.x - h, p.y)) / (2 * h);
    const Vec3 dv = (grid.direction(p.x, p.y + h) - grid.direction(p.x, p.y - h)) / (2 * h);
    EXPECT_NEAR(grid.importance(d) * length(cross(du, dv)), 1, 1e-7);
  }
}

}  // namespace
}  // namespace fogbow::testing
