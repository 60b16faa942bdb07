// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/materials/bsdf_cases.h"
#include "tests/unit/materials/mitsuba_values.h"

namespace fogbow {
namespace {

using testing::direction;
using testing::kAnyPoint;

bool is_beckmann(const std::string& name) { return name.find("Beckmann") != std::string::npos; }

/// GGX and the rest to single precision. Mitsuba's Beckmann masks by a rational fit with a stated
/// error of 0.35% (twice in f, once in pdf); ours is exact
/// (Microfacet.VisibleAreaIsThatOfThePlane).
TEST(MitsubaValues, EvalAndPdf) {
  int compared = 0;
  for (const auto& group : testing::mitsuba_cases()) {
    const double fit = is_beckmann(group.name) ? 0.0036 : 0.0;
    for (const auto& v : group.values) {
      const Vec3 eye = direction(v.theta_i, v.phi_i), light = direction(v.theta_o, v.phi_o);
      const RGB f = group.bsdf->f_s(kAnyPoint, light, eye) * std::fabs(light.z);
      const double pdf = group.bsdf->pdf_sigma(kAnyPoint, eye, light);
      constexpr double kSingle = 4e-4, kTiny = 1e-9;
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(f[i], v.eval[i], (kSingle + 2 * fit) * v.eval[i] + kTiny)
            << group.name << " at " << v.theta_i << ' ' << v.phi_i << ' ' << v.theta_o;
      EXPECT_NEAR(pdf, v.pdf, (kSingle + fit) * v.pdf + kTiny)
          << group.name << " at " << v.theta_i << ' ' << v.phi_i << ' ' << v.theta_o;
      compared += v.pdf > 0;
    }
  }
  EXPECT_GT(compared, 120) << "pairs where there is something to compare";
}

/// ∫ f_s |cosθ_light| over directions with cosθ in (−1, 0) and (0, 1), cut where refracting facets
/// are vertical: GGX has a jump there.
Vec2 furnace(const Bsdf& bsdf, const Vec3& eye) {
  const testing::Chart chart = testing::sphere_chart();
  const double n_ratio = eye.z > 0 ? 1 / bsdf.eta() : bsdf.eta();
  std::vector<double> cuts{0.5 + 0.5 * std::clamp(n_ratio * eye.z, -1.0, 1.0)};
  for (int i = 0; i <= 16; ++i) cuts.push_back(i / 16.0);
  std::sort(cuts.begin(), cuts.end());
  Vec2 sum(0);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i)
    for (int j = 0; j < 8; ++j)
      sum[cuts[i] < 0.5] += testing::integrate(
          [&](const Vec2& c) {
            const Vec3 light = chart.point(c);
            return bsdf.f_s(kAnyPoint, light, eye).x * std::fabs(light.z) * 4 * kPi;
          },
          Vec2(cuts[i], j / 8.0), Vec2(cuts[i + 1], (j + 1) / 8.0), 1e-8);
  return sum;
}

TEST(MitsubaValues, WhiteFurnace) {
  for (const auto& v : testing::kMitsubaFurnaces) {
    const RoughnessSettings roughness{v.kind, v.alpha_u, v.alpha_v};
    const auto bsdf = v.eta > 0 ? make_rough_dielectric(roughness, v.eta)
                                : make_rough_conductor(roughness, RGB(0), RGB(1));
    const Vec3 eye = direction(v.theta_i, 0.5);
    const Vec2 sum = furnace(*bsdf, eye);
    const double reflected = sum[eye.z > 0], transmitted = sum[eye.z < 0];
    const double fit = v.kind == MicrofacetKind::Beckmann ? 2 * 0.0036 : 0.0;
    constexpr double kMidpoint = 1e-4;  // of the 2048 rows at the jump
    EXPECT_NEAR(reflected, v.reflected, kMidpoint + fit * v.reflected) << v.theta_i;
    EXPECT_NEAR(transmitted, v.transmitted, kMidpoint + fit * v.transmitted) << v.theta_i;
    // Energy: radiance from the other side is scaled by n_eye²/n_light².
    const double n_ratio = v.eta > 0 ? (eye.z > 0 ? 1 / v.eta : v.eta) : 1;
    EXPECT_LE(reflected + transmitted / sqr(n_ratio), 1 + 1e-6);
    EXPECT_GT(reflected + transmitted / sqr(n_ratio), 0.4);
  }
}

}  // namespace
}  // namespace fogbow
