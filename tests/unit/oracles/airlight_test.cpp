// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"

namespace fogbow::testing {
namespace {

const Ray kRay{{0.1, -0.2, 3}, normalize(Vec3(0.1, 0.2, -1))};

TEST(HenyeyGreenstein, IntegratesToOneWithMeanCosineG) {
  for (const double g : {-0.6, 0.0, 0.3, 0.9}) {
    EXPECT_NEAR(integrate([&](double c) { return 2 * kPi * henyey_greenstein(c, g); }, -1, 1), 1,
                1e-10);
    EXPECT_NEAR(integrate([&](double c) { return 2 * kPi * c * henyey_greenstein(c, g); }, -1, 1),
                g, 1e-10);
  }
}

TEST(Airlight, WithoutExtinctionIsAnAngle) {
  // σ_t → 0, isotropic: L = σ_s I/(4π) · (φ₁ − φ₀)/h
  const Airlight fog{0, 0.7, 0, {0.5, 0.4, 0}, 2};
  const double nearest = dot(fog.light - kRay.o, kRay.d);
  const double h = length(cross(fog.light - kRay.o, kRay.d));
  const double angle = std::atan((4 - nearest) / h) - std::atan((0.01 - nearest) / h);
  EXPECT_NEAR(fog.radiance(kRay, 0.01, 4), 0.7 * 2 / (4 * kPi) * angle / h, 1e-12);
}

TEST(Airlight, EqualsTheIntegralAlongTheRay) {
  for (const double g : {0.0, 0.6, -0.4}) {
    const Airlight fog{0.45, 0.3, g, {0.5, 0.4, 0}, 2};
    for (const double t1 : {1.5, 9.0}) {
      // composite Simpson in t, formulas written out anew
      const int n = 20000;
      const double t0 = 0.01, step = (t1 - t0) / n;
      double sum = 0;
      for (int i = 0; i <= n; ++i) {
        const double t = t0 + i * step;
        const Vec3 to_point = kRay(t) - fog.light;
        const double d = length(to_point);
        const double scattering = dot(to_point / d, -kRay.d);
        const double phase =
            (1 - g * g) / (4 * kPi) * std::pow(1 + g * g - 2 * g * scattering, -1.5);
        const double value = std::exp(-0.45 * (d + t - t0)) * phase / (d * d);
        sum += value * (i == 0 || i == n ? 1 : i % 2 ? 4 : 2);
      }
      EXPECT_NEAR(fog.radiance(kRay, t0, t1) / (2 * 0.3 * sum * step / 3), 1, 1e-10) << g;
    }
  }
}

TEST(Airlight, ForwardScatteringIsBrightestTowardsTheLight) {
  // Looking at a light far behind the fog, positive g must give more than negative.
  const Ray towards{{0, 0, 0}, {0, 0, 1}};
  const Airlight forward{0.1, 0.1, 0.7, {0.5, 0, 20}, 1}, backward{0.1, 0.1, -0.7, {0.5, 0, 20}, 1};
  EXPECT_GT(forward.radiance(towards, 0, 10), 10 * backward.radiance(towards, 0, 10));
  EXPECT_NEAR(forward.radiance(towards, 0, kInfinity), forward.radiance(towards, 0, 1000), 1e-15);
}

}  // namespace
}  // namespace fogbow::testing
