// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/scene/bsdf/microfacet.h"
#include "tests/unit/materials/bsdf_cases.h"

namespace fogbow {
namespace {

using testing::direction;

struct Case {
  MicrofacetKind kind;
  double alpha_u, alpha_v;
};
constexpr Case kCases[] = {{MicrofacetKind::Ggx, 0.05, 0.05},
                           {MicrofacetKind::Ggx, 0.2, 0.6},
                           {MicrofacetKind::Ggx, 1, 1},
                           {MicrofacetKind::Beckmann, 0.05, 0.05},
                           {MicrofacetKind::Beckmann, 0.2, 0.6},
                           {MicrofacetKind::Beckmann, 1, 1},
                           {MicrofacetKind::Beckmann, 1e-3, 2e-3},
                           {MicrofacetKind::Ggx, 1e-3, 2e-3}};

std::string describe(const Case& c, double theta) {
  return std::string(c.kind == MicrofacetKind::Ggx ? "GGX " : "Beckmann ") +
         std::to_string(c.alpha_u) + " x " + std::to_string(c.alpha_v) + " at " +
         std::to_string(theta);
}

/// Normals above the horizon by slope: tan²θ = κ(1 − v²)/v², v = 1 − c. The horizon is a side of
/// the square, whatever the roughness.
testing::Chart normals_chart(const Case& c) {
  const double k = c.alpha_u * c.alpha_v;
  const auto Q = [k](double v) { return v * v + k * (1 - v * v); };
  testing::Chart chart;
  chart.point = [=](const Vec2& x) {
    const double v = 1 - x.x, z = v / std::sqrt(Q(v)), phi = 2 * kPi * x.y;
    const double sin_theta = std::sqrt(k * (1 - v * v) / Q(v));
    return Vec3(sin_theta * std::cos(phi), sin_theta * std::sin(phi), z);
  };
  chart.coordinates = [=](const Vec3& h) {
    const double slope2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
    const double turn = std::atan2(h.y, h.x) / (2 * kPi);
    return Vec2(1 - std::sqrt(k / (k + slope2)), turn < 0 ? turn + 1 : turn);
  };
  chart.jacobian = [=](const Vec2& x) { return 2 * kPi * k / std::pow(Q(1 - x.x), 1.5); };
  return chart;
}

double integrate_normals(const Case& c, const std::function<double(const Vec3&)>& f) {
  const testing::Chart chart = normals_chart(c);
  double sum = 0;
  for (int i = 0; i < 64; ++i)
    sum += testing::integrate([&](const Vec2& x) { return f(chart.point(x)) * chart.jacobian(x); },
                              Vec2(i % 8, i / 8) / 8.0, Vec2(i % 8 + 1, i / 8 + 1) / 8.0, 1e-9);
  return sum;
}

TEST(Microfacet, AreaProjectsToOne) {
  for (const Case& c : kCases) {
    const MicrofacetDistribution facets({c.kind, c.alpha_u, c.alpha_v});
    EXPECT_NEAR(integrate_normals(c, [&](const Vec3& h) { return facets.D(h) * h.z; }), 1, 1e-6)
        << describe(c, 0);
  }
}

/// Masking makes the visible area that of the plane: ∫ G₁ D (w·h)₊ dσ(h) = w_z (Walter et al.
/// 2007).
TEST(Microfacet, VisibleAreaIsThatOfThePlane) {
  for (const Case& c : kCases)
    for (const double theta : {0.0, 0.4, 1.0, 1.4, 1.56}) {
      const MicrofacetDistribution facets({c.kind, c.alpha_u, c.alpha_v});
      const Vec3 w = direction(theta, 0.7);
      const double visible = integrate_normals(
          c, [&](const Vec3& h) { return facets.D(h) * std::fmax(dot(w, h), 0.0); });
      EXPECT_NEAR(facets.G1(w) * visible / w.z, 1, 2e-5) << describe(c, theta);
      EXPECT_EQ(facets.G1(w), facets.G1(-w));
    }
}

TEST(Microfacet, VisibleNormals) {
  for (const Case& c : kCases)
    for (const double theta : {0.0, 1e-5, 0.4, 1.0, 1.4, 1.5707}) {
      const MicrofacetDistribution facets({c.kind, c.alpha_u, c.alpha_v});
      const Vec3 w = direction(theta, 2.0);
      const testing::Triple triple{
          2,
          [&](const Vec3& u) -> std::optional<Vec3> { return facets.sample_visible(w, Vec2(u)); },
          [&](const Vec3& h) { return facets.pdf_visible(w, h); },
          [&](const Vec3& h, const Vec3&) -> std::optional<Vec3> {
            if (!(facets.pdf_visible(w, h) > 0)) return std::nullopt;
            return Vec3(facets.invert_visible(w, h), 0);
          }};
      EXPECT_EQ(testing::check_triple(describe(c, theta), triple, normals_chart(c)), "");
    }
}

TEST(Microfacet, TinyRoughnessIsRaised) {
  const MicrofacetDistribution smooth({MicrofacetKind::Ggx, 0, 1e-6});
  const MicrofacetDistribution least({MicrofacetKind::Ggx, 1e-4, 1e-4});
  EXPECT_EQ(smooth.D({0, 0, 1}), least.D({0, 0, 1}));
  EXPECT_THROW(MicrofacetDistribution({MicrofacetKind::Ggx, -0.1, 0.1}), std::domain_error);
  EXPECT_THROW(MicrofacetDistribution({MicrofacetKind::Ggx, 0.1, std::nan("")}), std::domain_error);
}

/// The corners of the square give finite normals.
TEST(Microfacet, ExtremeSamplesAreFinite) {
  for (const Case& c : kCases)
    for (const double theta : {0.0, 1.0, 1.5707963})
      for (const double x : {0.0, 0x1p-53, 0.5, kOneMinusEpsilon})
        for (const double y : {0.0, 0x1p-53, 0.5, kOneMinusEpsilon}) {
          const MicrofacetDistribution facets({c.kind, c.alpha_u, c.alpha_v});
          const Vec3 h = facets.sample_visible(direction(theta, 0.3), {x, y});
          EXPECT_TRUE(is_finite(h)) << describe(c, theta) << ' ' << x << ' ' << y;
          EXPECT_NEAR(length(h), 1, 1e-14);
        }
}

}  // namespace
}  // namespace fogbow
