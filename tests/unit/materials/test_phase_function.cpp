// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "media/media.h"
#include "tests/helpers/triples.h"

namespace fogbow {
namespace {

testing::Triple phase_triple(std::shared_ptr<const PhaseFunction> phase, const Vec3& from) {
  return {2, [=](const Vec3& u) -> std::optional<Vec3> { return phase->sample(from, Vec2(u)); },
          [=](const Vec3& to) { return phase->pdf_sigma(from, to); },
          [=](const Vec3& to, const Vec3&) -> std::optional<Vec3> {
            return Vec3(phase->invert(from, to), 0);
          }};
}

const Vec3 kFroms[] = {{0, 0, 1}, {0, 0, -1}, normalize(Vec3(0.3, -0.7, 0.2))};

TEST(PhaseFunction, IsotropicTriple) {
  for (const Vec3& from : kFroms)
    EXPECT_EQ(testing::check_triple("isotropic", phase_triple(make_isotropic_phase(), from),
                                    testing::sphere_chart()),
              "");
}

TEST(PhaseFunction, HenyeyGreensteinTriples) {
  for (const double g : {-0.99, -0.6, -1e-12, 0.0, 1e-8, 0.5, 0.85, 0.99})
    for (const Vec3& from : kFroms) {
      const Frame peak(g < 0 ? from : -from);
      EXPECT_EQ(testing::check_triple("HG " + std::to_string(g),
                                      phase_triple(make_henyey_greenstein(g), from),
                                      testing::lobe_chart(peak, std::pow(1 - std::fabs(g), 1.5))),
                "");
    }
}

/// Moments by quadrature over the engine's own values: norm 1, mean cosine g, second Legendre
/// moment g².
TEST(PhaseFunction, HenyeyGreensteinMoments) {
  for (const double g : {-0.9, -0.3, 1e-10, 0.4, 0.8, 0.95}) {
    const auto phase = make_henyey_greenstein(g);
    const Vec3 from = kFroms[2];
    const testing::Chart chart = testing::lobe_chart(Frame(-from), g > 0 ? 1 - g : 0.9);
    double moment[3] = {0, 0, 0};
    for (int i = 0; i < 32; ++i)
      for (int m = 0; m < 3; ++m)
        moment[m] += testing::integrate(
            [&](const Vec2& c) {
              const Vec3 to = chart.point(c);
              const double mu = -dot(from, to);
              const double legendre = m == 0 ? 1 : (m == 1 ? mu : 0.5 * (3 * mu * mu - 1));
              return phase->f_p(from, to).y * legendre * chart.jacobian(c);
            },
            Vec2(i / 32.0, 0), Vec2((i + 1) / 32.0, 1), 1e-10);
    EXPECT_NEAR(moment[0], 1, 1e-7) << g;
    EXPECT_NEAR(moment[1], g, 1e-7);
    EXPECT_NEAR(moment[2], g * g, 1e-7);
    EXPECT_EQ(phase->mean_cosine(), g);
  }
}

TEST(PhaseFunction, LightGoesOnStraightForPositiveG) {
  const auto forward = make_henyey_greenstein(0.9);
  const Vec3 from = kFroms[2];
  EXPECT_NEAR(forward->f_p(from, -from).x, 1.9 / (4 * kPi * 0.01), 1e-10);
  EXPECT_NEAR(forward->f_p(from, from).x, 0.1 / (4 * kPi * sqr(1.9)), 1e-15);
}

TEST(PhaseFunction, Reciprocity) {
  const auto phase = make_henyey_greenstein(-0.7);
  for (const Vec3& a : kFroms)
    for (const Vec3& b : kFroms) EXPECT_EQ(phase->f_p(a, b), phase->f_p(b, a));
}

TEST(PhaseFunction, RefusesImpossibleMeanCosines) {
  for (const double g : {1.0, -1.0, 2.0, std::nan("")})
    EXPECT_THROW(make_henyey_greenstein(g), std::domain_error);
}

}  // namespace
}  // namespace fogbow
