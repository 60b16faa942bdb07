// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"

namespace fogbow::testing {
namespace {

const BallCaustic kBall{0.4, 1.5, 1.7, 0.9, 3};

/// The same light by vectors: light at (0, 0, light_distance), ball about the origin, plane z =
/// −plane_distance.
std::optional<Ray> trace_vectors(const BallCaustic& ball, const Vec3& direction, int order) {
  const Vec3 light(0, 0, ball.light_distance);
  const double b = dot(light, direction);
  const double discriminant = b * b - (sqr(ball.light_distance) - sqr(ball.radius));
  if (discriminant < 0) return std::nullopt;
  Vec3 p = light + direction * (-b - std::sqrt(discriminant));
  if (order == BallCaustic::kOutside) return Ray{p, mirror_direction(direction, normalize(p))};
  Vec3 d = *refract_direction(direction, normalize(p), ball.index);
  p -= d * (2 * dot(p, d));
  for (int bounce = 0; bounce < order; ++bounce) {
    d = mirror_direction(d, normalize(p));
    p -= d * (2 * dot(p, d));
  }
  return Ray{p, *refract_direction(d, normalize(p), 1 / ball.index)};
}

Vec3 leaving(const BallCaustic& ball, double incidence) {
  const double alpha = ball.angle_at_light(incidence);
  return {std::sin(alpha), 0, -std::cos(alpha)};
}

TEST(BallCaustic, AnglesEqualVectorTracing) {
  int landed = 0;
  for (int order = BallCaustic::kOutside; order <= 4; ++order) {
    for (double incidence = 0.01; incidence < 1.57; incidence += 0.05) {
      const Ray ray = *trace_vectors(kBall, leaving(kBall, incidence), order);
      const std::optional<BallCaustic::Landing> landing = kBall.trace(incidence, order);
      ASSERT_EQ(landing.has_value(), ray.d.z < 0) << order << ' ' << incidence;
      if (!landing) continue;
      ++landed;
      const Vec3 hit = ray((-kBall.plane_distance - ray.o.z) / ray.d.z);
      EXPECT_NEAR(landing->r, hit.x, 1e-10 * (1 + std::abs(hit.x)));
      EXPECT_NEAR(landing->cos_landing, -ray.d.z, 1e-12);
    }
  }
  EXPECT_GT(landed, 60);
}

TEST(BallCaustic, WeightsOfAllOrdersSumToOne) {
  // at the limb's side every order lands or not; energy before that question: F + (1−F)² ΣF^m = 1
  const double incidence = 0.2;
  double sum = 0;
  for (int order = BallCaustic::kOutside; order < 40; ++order) {
    const double f = fresnel_dielectric(std::cos(incidence), 1.5);
    const std::optional<BallCaustic::Landing> landing = kBall.trace(incidence, order);
    const double expected = order == BallCaustic::kOutside ? f : sqr(1 - f) * std::pow(f, order);
    if (landing) {
      EXPECT_NEAR(landing->weight, expected, 1e-15);
    }
    sum += expected;
  }
  EXPECT_NEAR(sum, 1, 1e-13);
}

TEST(BallCaustic, IrradianceIsTheJacobianOfTheChain) {
  for (const int order : {BallCaustic::kOutside, 0, 1, 2}) {
    for (const double incidence : {0.3, 0.9, 1.2, 1.4}) {
      const std::optional<BallCaustic::Landing> landing = kBall.trace(incidence, order);
      if (!landing) continue;
      const Vec3 b(landing->r, 0, -kBall.plane_distance);
      const double jacobian =
          jacobian_by_differences([&](const Vec3& d) { return trace_vectors(kBall, d, order); },
                                  leaving(kBall, incidence), b);
      const double alpha = kBall.angle_at_light(incidence);
      const double dalpha =
          kBall.radius * std::cos(incidence) / (kBall.light_distance * std::cos(alpha));
      const double one_chain =
          landing->weight * std::sin(alpha) * dalpha / std::abs(landing->r * landing->dr);
      EXPECT_NEAR(landing->weight * jacobian * landing->cos_landing / one_chain, 1, 1e-6)
          << order << ' ' << incidence;
    }
  }
}

TEST(BallCaustic, IrradianceIsTheDerivativeOfTheFlux) {
  for (const int order : {BallCaustic::kOutside, 0, 1, 2}) {
    for (const double r : {0.02, 0.31, 1.1}) {
      const double h = 1e-4 * r;
      const double flux = kBall.flux_within(r + h, order) - kBall.flux_within(r - h, order);
      const double mean = flux / (4 * kPi * r * h);
      EXPECT_NEAR(kBall.irradiance(r, order), mean, 1e-5 * mean + 1e-9) << order << ' ' << r;
    }
  }
}

TEST(BallCaustic, LightIsNeitherLostNorMade) {
  // Lowering the plane's reach to infinity: what lands of order 0 is all that enters and leaves
  // downwards.
  const double cone =
      2 * kPi * kBall.intensity * (1 - std::cos(std::asin(kBall.radius / kBall.light_distance)));
  double landed = 0;
  for (int order = BallCaustic::kOutside; order <= 8; ++order)
    landed += kBall.flux_within(1e7, order);
  EXPECT_LT(landed, cone);
  EXPECT_GT(landed, 0.8 * cone);
  // an index of almost one: the ball is hardly there
  const BallCaustic empty{0.4, 1 + 1e-9, 1.7, 0.9, 3};
  EXPECT_NEAR(empty.irradiance(0.2, 0), 3 * 2.6 / std::pow(2.6 * 2.6 + 0.04, 1.5), 1e-7);
  EXPECT_NEAR(empty.flux_within(2, 0) + empty.direct_flux_within(2),
              2 * kPi * 3 * (1 - 2.6 / std::hypot(2.6, 2.0)), 1e-7);
}

TEST(BallCaustic, LandingsSumToTheFluxOfAnyDisk) {
  for (const int order : {BallCaustic::kOutside, 0, 1}) {
    for (const double reach : {0.3, 1.1, 3.0}) {
      double sum = 0;
      kBall.visit_landings(order, 20000, 3, [&](double x, double y, double flux) {
        if (std::hypot(x, y) < reach) sum += flux;
      });
      const double exact = kBall.flux_within(reach, order);
      EXPECT_NEAR(sum, exact, 3e-4 * exact + 1e-9) << order << ' ' << reach;
    }
  }
}

TEST(BallCaustic, DirectLightLeavesAShadow) {
  const double limb = std::asin(kBall.radius / kBall.light_distance);
  const double edge = 2.6 * std::tan(limb);
  EXPECT_EQ(kBall.direct_irradiance(0.999 * edge), 0);
  EXPECT_EQ(kBall.direct_flux_within(0.999 * edge), 0);
  const double ring = integrate([&](double r) { return 2 * kPi * r * kBall.direct_irradiance(r); },
                                edge * (1 + 1e-13), 2);
  EXPECT_NEAR(kBall.direct_flux_within(2), ring, 1e-9);
}

}  // namespace
}  // namespace fogbow::testing
