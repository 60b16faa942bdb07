// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/scene/bsdf/bsdfs.h"
#include "tests/unit/materials/bsdf_cases.h"

namespace fogbow {
namespace {

using testing::bsdf_triple;
using testing::check_triple;
using testing::direction;
using testing::lobe_chart;
using testing::sphere_chart;

constexpr MicrofacetKind kKinds[] = {MicrofacetKind::Ggx, MicrofacetKind::Beckmann};

std::string label(const char* what, MicrofacetKind kind, double alpha, double theta) {
  return std::string(what) + (kind == MicrofacetKind::Ggx ? " GGX " : " Beckmann ") +
         std::to_string(alpha) + " from " + std::to_string(theta);
}

/// Where a smooth interface would send light that comes from w.
Vec3 refracted(const Vec3& w, double eta) {
  const double n = w.z > 0 ? eta : 1 / eta;
  const Vec2 t = -Vec2(w) / n;
  return {t, -std::copysign(std::sqrt(std::fmax(1 - dot(t, t), 0.0)), w.z)};
}

TEST(BsdfTriples, Diffuse) {
  const auto diffuse = make_diffuse({0.2, 0.5, 0.8});
  for (const double theta : {0.0, 0.7, 1.57})
    EXPECT_EQ(check_triple("diffuse " + std::to_string(theta),
                           bsdf_triple(diffuse, direction(theta, 1)), sphere_chart()),
              "");
  EXPECT_EQ(check_triple("diffuse from behind", bsdf_triple(diffuse, direction(2, 1)),
                         sphere_chart(), {.mass = 0}),
            "");
}

TEST(BsdfTriples, TwoSided) {
  const auto both =
      make_twosided(make_diffuse(RGB(0.5)),
                    make_rough_conductor({MicrofacetKind::Ggx, 0.4, 0.4}, RGB(0), RGB(1)));
  EXPECT_EQ(check_triple("front", bsdf_triple(both, direction(0.7, 1)), sphere_chart()), "");
  EXPECT_EQ(
      check_triple("back", bsdf_triple(both, direction(2.4, 1)), sphere_chart(), {.mass = {}}), "");
}

TEST(BsdfTriples, RoughConductor) {
  for (const MicrofacetKind kind : kKinds)
    for (const double alpha : {0.1, 0.4, 1.0})
      for (const double theta : {0.0, 0.6, 1.3, 1.55}) {
        const auto bsdf =
            make_rough_conductor({kind, alpha, 0.6 * alpha}, {0.2, 0.9, 1.1}, {3.9, 2.4, 2.2});
        EXPECT_EQ(
            check_triple(label("conductor", kind, alpha, theta),
                         bsdf_triple(bsdf, direction(theta, 0.8)), sphere_chart(), {.mass = {}}),
            "");
      }
}

TEST(BsdfTriples, NearlySmoothConductor) {
  for (const MicrofacetKind kind : kKinds)
    for (const double alpha : {1e-4, 1e-2})
      for (const double theta : {0.0, 0.6, 1.4}) {
        const auto bsdf = make_rough_conductor({kind, alpha, alpha}, RGB(0), RGB(1));
        const Vec3 from = direction(theta, 0.8);
        const Frame mirror(Vec3(-from.x, -from.y, from.z));
        EXPECT_EQ(check_triple(label("conductor", kind, alpha, theta), bsdf_triple(bsdf, from),
                               lobe_chart(mirror, 2 * alpha * alpha), {.mass = {}}),
                  "");
      }
}

/// Both lobes at once, from both sides, total reflection included.
TEST(BsdfTriples, RoughDielectric) {
  for (const MicrofacetKind kind : kKinds)
    for (const double alpha : {0.1, 0.4, 1.0})
      for (const double theta : {0.0, 0.8, 1.5, 1.65, 2.2, 2.45, 3.0}) {
        const auto bsdf = make_rough_dielectric({kind, alpha, 0.6 * alpha}, 1.5);
        EXPECT_EQ(
            check_triple(label("dielectric", kind, alpha, theta),
                         bsdf_triple(bsdf, direction(theta, 0.8)), sphere_chart(), {.mass = {}}),
            "");
      }
}

TEST(BsdfTriples, TintedDielectricOfLowerIndex) {
  for (const MicrofacetKind kind : kKinds)
    for (const double theta : {0.3, 1.2, 2.6}) {
      const auto bsdf =
          make_rough_dielectric({kind, 0.3, 0.3}, 0.75, {0.9, 0.2, 0.1}, {0.1, 0.5, 0.2});
      EXPECT_EQ(
          check_triple(label("tinted", kind, 0.3, theta), bsdf_triple(bsdf, direction(theta, 0.8)),
                       sphere_chart(), {.mass = {}}),
          "");
    }
}

/// One lobe at a time, as narrow as it gets.
TEST(BsdfTriples, NearlySmoothDielectric) {
  for (const MicrofacetKind kind : kKinds)
    for (const double alpha : {1e-4, 1e-2})
      for (const double theta : {0.2, 1.3, 2.7}) {
        const Vec3 from = direction(theta, 0.8);
        const double width = 2 * alpha * alpha;
        const auto mirror = make_rough_dielectric({kind, alpha, alpha}, 1.5, RGB(1), RGB(0));
        EXPECT_EQ(
            check_triple(label("reflection", kind, alpha, theta), bsdf_triple(mirror, from),
                         lobe_chart(Frame(Vec3(-from.x, -from.y, from.z)), width), {.mass = {}}),
            "");
        const auto glass = make_rough_dielectric({kind, alpha, alpha}, 1.5, RGB(0), RGB(1));
        EXPECT_EQ(check_triple(label("refraction", kind, alpha, theta), bsdf_triple(glass, from),
                               lobe_chart(Frame(refracted(from, 1.5)), width), {.mass = {}}),
                  "");
      }
}

}  // namespace
}  // namespace fogbow
