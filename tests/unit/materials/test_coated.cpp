// SPDX-License-Identifier: GPL-3.0-or-later
// Plastics, blends, masks, panes, and the two BSDFs that only Mitsuba 0.6 has.
#include <gtest/gtest.h>

#include <random>

#include "core/scene/bsdf/fresnel.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/materials/bsdf_cases.h"
#include "tests/unit/materials/mitsuba_values_coated.h"

namespace fogbow {
namespace {

using testing::bsdf_triple;
using testing::check_triple;
using testing::direction;
using testing::kAnyPoint;
using testing::sphere_chart;

const RoughnessSettings kGgx{MicrofacetKind::Ggx, 0.3, 0.3};
const RoughnessSettings kBeckmann{MicrofacetKind::Beckmann, 0.2, 0.2};

struct Named {
  const char* name;
  std::shared_ptr<const Bsdf> bsdf;
};

/// All reflect only.
std::vector<Named> reflecting_bsdfs() {
  const RGB diffuse(0.2, 0.5, 0.8), specular(0.5, 0.4, 0.9);
  return {
      {"plastic", make_plastic(1.5)},
      {"tinted plastic", make_plastic(1.9, true, diffuse, specular)},
      {"rough plastic", make_rough_plastic(kGgx, 1.5, false, diffuse, specular)},
      {"rougher plastic", make_rough_plastic({MicrofacetKind::Beckmann, 0.7, 0.7}, 1.5)},
      {"blend",
       make_blend(make_diffuse(diffuse), make_rough_conductor(kGgx, RGB(0.2), RGB(3)), 0.3)},
      {"blend of plastics", make_blend(make_plastic(1.5), make_rough_plastic(kBeckmann, 1.3), 0.6)},
      {"phong", make_phong(20.0)},
      {"flat phong", make_phong(0.0, diffuse, RGB(0.1, 0.2, 0.15))},
      {"rough diffuse", make_rough_diffuse(diffuse, 0.6)},
      {"rough diffuse, fast", make_rough_diffuse(diffuse, 0.6, true)},
      {"mask", make_mask(make_rough_plastic(kGgx, 1.5), 0.3)}};
}

/// Of mixtures with Dirac parts the smooth part has the mass that is left.
TEST(CoatedTriples, Reflecting) {
  for (const auto& [name, bsdf] : reflecting_bsdfs())
    for (const double theta : {0.1, 0.9, 1.5})
      EXPECT_EQ(
          check_triple(std::string(name) + " from " + std::to_string(theta),
                       bsdf_triple(bsdf, direction(theta, 0.8)), sphere_chart(), {.mass = {}}),
          "");
}

TEST(CoatedTriples, BlendWithGlass) {
  const auto blend = make_blend(make_rough_dielectric(kGgx, 1.5), make_plastic(1.5), 0.4);
  for (const double theta : {0.3, 1.3, 2.0, 2.8})
    EXPECT_EQ(check_triple("blend from " + std::to_string(theta),
                           bsdf_triple(blend, direction(theta, 0.8)), sphere_chart(), {.mass = {}}),
              "");
}

class Random {
 public:
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Vec3 uniform3() {
    const double x = uniform(), y = uniform();
    return {x, y, uniform()};
  }
  Vec3 any_direction() { return direction(std::acos(1 - 2 * uniform()), 2 * kPi * uniform()); }

 private:
  std::mt19937_64 engine_{testing::suite_seed()};
};

TEST(CoatedLaws, Reciprocity) {
  Random random;
  for (const auto& [name, bsdf] : reflecting_bsdfs()) {
    int positive = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 a = random.any_direction(), b = random.any_direction();
      const RGB there = bsdf->f_s(kAnyPoint, a, b), back = bsdf->f_s(kAnyPoint, b, a);
      EXPECT_LE(length(there - back), 1e-10 * length(there) + 1e-300) << name;
      positive += there.y > 0;
    }
    EXPECT_GT(positive, 500) << name;
  }
}

TEST(CoatedLaws, BothPartsAreSampledAsTheirDensitiesSay) {
  Random random;
  const Named bsdfs[] = {
      {"plastic", make_plastic(1.5, true, {0.2, 0.5, 0.8}, {0.5, 0.4, 0.9})},
      {"blend", make_blend(make_plastic(1.5), make_conductor(RGB(0.2), RGB(3)), 0.3)},
      {"blend with glass", make_blend(make_dielectric(1.5), make_diffuse(RGB(0.5)), 0.3)},
      {"masked", make_mask(make_plastic(1.5), 0.3)}};
  for (const auto& [name, bsdf] : bsdfs)
    for (const double theta : {0.2, 1.2}) {
      const Vec3 from = direction(theta, 1);
      constexpr int kSamples = 100000;
      int dirac = 0;
      double expected = 0;
      std::vector<double> u_again;
      for (int i = 0; i < kSamples; ++i) {
        const auto s = bsdf->sample(kAnyPoint, from, random.uniform3());
        ASSERT_TRUE(s) << name;
        const auto density = s->dirac ? bsdf->pdf_dirac(kAnyPoint, from, s->w)
                                      : bsdf->pdf_sigma(kAnyPoint, from, s->w);
        EXPECT_EQ(s->pdf_sigma, density) << name;
        const auto u = bsdf->invert(kAnyPoint, from, s->w, s->dirac, random.uniform3());
        ASSERT_TRUE(u) << name;
        const auto again = bsdf->sample(kAnyPoint, from, *u);
        ASSERT_TRUE(again) << name;
        EXPECT_EQ(again->dirac, s->dirac);
        EXPECT_NEAR(length(again->w - s->w), 0, 1e-9) << name;
        u_again.push_back(u->x);
        dirac += s->dirac;
      }
      // The events of the Dirac part, by their formal density over n²|cosθ|.
      const Vec3 mirror(-from.x, -from.y, from.z);
      expected += bsdf->pdf_dirac(kAnyPoint, from, mirror) / from.z;
      if (bsdf->eta() != 1) {
        const double s = std::sin(theta) / bsdf->eta();
        const Vec3 through(-from.x / bsdf->eta(), -from.y / bsdf->eta(), -std::sqrt(1 - s * s));
        expected += bsdf->pdf_dirac(kAnyPoint, from, through) / (sqr(bsdf->eta()) * -through.z);
      }
      const double deviation = std::sqrt(expected * (1 - expected) / kSamples);
      EXPECT_NEAR(static_cast<double>(dirac) / kSamples, expected, 5 * deviation) << name;
      EXPECT_GT(testing::uniform_ks_test(u_again), testing::sidak(testing::kSuiteFalseAlarm, 100))
          << name;
    }
}

/// Mitsuba takes the coat's hemispherical reflectances from a fit (plastic: 0.590479 for 0.589994
/// of Fresnel's formulas at η = 1.48959) and from a coarse quadrature (roughplastic: 0.58806 for
/// the 0.59634 of Fresnel's at η = 1.5 as α vanishes, 2% of the diffuse part). The next test has
/// the rest of that part alone.
TEST(CoatedValues, AreMitsubas) {
  for (const auto& group : testing::mitsuba_coated_cases()) {
    const std::string name = group.name;
    const bool beckmann = name.find("Beckmann") != std::string::npos;
    const double tables = name.find("rough_plastic") != std::string::npos ? 2.2e-2 : 3e-3;
    const double fit = tables + (beckmann ? 0.0072 : 0.0);
    for (const auto& v : group.values) {
      const Vec3 eye = direction(v.theta_i, v.phi_i), light = direction(v.theta_o, v.phi_o);
      const RGB f = group.bsdf->f_s(kAnyPoint, light, eye) * light.z;
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(f[i], v.eval[i], fit * v.eval[i] + 1e-9) << name << v.theta_i;
      EXPECT_NEAR(group.bsdf->pdf_sigma(kAnyPoint, eye, light), v.pdf, fit * v.pdf + 1e-9) << name;
    }
  }
}

/// √(f π η²/ρ) as ρ vanishes, of eval() of Mitsuba's with GGX α = 0.25, η = 1.5, at equal angles.
TEST(CoatedValues, TransmittanceOfARoughCoatIsMitsubas) {
  constexpr double rho = 1e-4;
  const auto bsdf =
      make_rough_plastic({MicrofacetKind::Ggx, 0.25, 0.25}, 1.5, true, RGB(rho), RGB(0));
  for (const auto& [theta, T] : {std::pair(0.3, 0.95386645), std::pair(0.641, 0.94398592),
                                 std::pair(0.906, 0.91964383), std::pair(1.3, 0.80682365)}) {
    const double f = bsdf->f_s(kAnyPoint, direction(theta, 1), direction(theta, 0)).x;
    EXPECT_NEAR(std::sqrt(f * kPi * sqr(1.5) / rho), T, 5e-4) << theta;
  }
}

/// Probability and weight of Mitsuba's specular sample, and what passes its panes and masks.
TEST(CoatedValues, DiracPartsAreMitsubas) {
  const auto plastic = make_plastic(1.9, false, {0.2, 0.5, 0.8}, {0.5, 0.4, 0.9});
  const auto pane = make_thin_dielectric(1.5046 / 1.000277);
  struct Row {
    double theta, probability;
    RGB weight;
    double reflected;
  };
  const Row rows[] = {{0.3, 0.11360001, {0.4247078, 0.3397662, 0.764474}, 0.07817758},
                      {0.9, 0.14006644, {0.426626, 0.3413008, 0.7679267}, 0.11580376},
                      {1.4, 0.47566020, {0.4525428, 0.3620342, 0.814577}, 0.56715447}};
  for (const Row& row : rows) {
    const Vec3 w = direction(row.theta, 2), mirror(-w.x, -w.y, w.z);
    const double probability = plastic->pdf_dirac(kAnyPoint, w, mirror) / w.z;
    EXPECT_NEAR(probability, row.probability, 1e-5);
    const RGB weight = plastic->f_dirac(kAnyPoint, mirror, w) / probability;
    EXPECT_NEAR(length(weight - row.weight), 0, 1e-5);
    for (const double side : {1.0, -1.0}) {
      EXPECT_NEAR(pane->f_dirac(kAnyPoint, side * mirror, side * w).x, row.reflected, 1e-6);
      EXPECT_NEAR(pane->passage(kAnyPoint, side * w).x, 1 - row.reflected, 1e-6);
    }
  }
  const auto mask = make_mask(make_diffuse({0.2, 0.5, 0.8}), 0.3);
  const RGB f = mask->f_s(kAnyPoint, direction(0.3, 1), direction(0.9, 2)) * std::cos(0.3);
  EXPECT_NEAR(f.y, 0.045614, 1e-6);
  EXPECT_NEAR(mask->passage(kAnyPoint, direction(0.9, 2)).x, 0.7, 1e-12);
}

/// What passes of parts that do not all pass light, by what each passes alone: with Fresnel's
/// R = ((η − 1)/(η + 1))² a pane passes 1 − 2R/(1 + R) of what falls on it straight.
TEST(CoatedValues, PassageIsThatOfTheParts) {
  const RGB tint(0.9, 0.6, 0.3), mirror(0.2, 0.4, 0.8);
  const double R = sqr(0.5 / 2.5), through = 1 - 2 * R / (1 + R);
  const auto pane = make_thin_dielectric(1.5, mirror, tint), wall = make_diffuse(RGB(0.5));
  const auto passage = [](const Bsdf& bsdf) { return bsdf.passage(kAnyPoint, Vec3(0, 0, 1)); };
  EXPECT_NEAR(length(passage(*pane) - through * tint), 0, 1e-12);
  const auto sieve = make_mask(pane, 0.3);
  EXPECT_NEAR(length(passage(*sieve) - (0.3 * through * tint + RGB(0.7))), 0, 1e-12);
  for (const bool first : {false, true}) {
    const auto blend = first ? make_blend(pane, wall, 0.4) : make_blend(wall, pane, 0.6);
    EXPECT_TRUE(blend->has_passage());
    EXPECT_NEAR(length(passage(*blend) - 0.6 * through * tint), 0, 1e-12);
  }
}

/// ∫ f_s cosθ plus the Dirac part's weight.
RGB albedo(const Bsdf& bsdf, const Vec3& eye) {
  RGB sum(0);
  constexpr int kRows = 400, kColumns = 200;
  for (int i = 0; i < kRows; ++i)
    for (int j = 0; j < kColumns; ++j) {
      const double z = (i + 0.5) / kRows;
      const Vec3 light = direction(std::acos(z), 2 * kPi * (j + 0.5) / kColumns);
      sum += bsdf.f_s(kAnyPoint, light, eye) * z * (2 * kPi / (kRows * kColumns));
    }
  return sum + bsdf.f_dirac(kAnyPoint, Vec3(-eye.x, -eye.y, eye.z), eye);
}

/// A white base under a clear coat loses nothing, whatever the angle and the index.
TEST(CoatedFurnace, PlasticIsLossless) {
  for (const double eta : {1.2, 1.5, 2.4, 0.8})
    for (const bool nonlinear : {false, true})
      for (const double theta : {0.0, 0.7, 1.5})
        EXPECT_NEAR(albedo(*make_plastic(eta, nonlinear, RGB(1)), direction(theta, 0.5)).x, 1, 3e-4)
            << eta << ' ' << theta;
  EXPECT_NEAR(diffuse_fresnel(1.48959), 0.09024573579, 1e-9) << "Gauss-Legendre, 200 points";
  EXPECT_NEAR(diffuse_fresnel(1 / 1.48959), 0.58999363044, 1e-9);
}

TEST(CoatedFurnace, NothingGainsEnergy) {
  const Named white[] = {
      {"rough plastic", make_rough_plastic({MicrofacetKind::Ggx, 0.3, 0.3}, 1.5, true, RGB(1))},
      {"rougher", make_rough_plastic({MicrofacetKind::Beckmann, 0.6, 0.6}, 1.5, false, RGB(1))},
      {"blend", make_blend(make_plastic(1.5, false, RGB(1)), make_diffuse(RGB(1)), 0.7)},
      {"phong", make_phong(8.0, RGB(0.6), RGB(0.4))},
      {"phong with more than all", make_phong(8.0, RGB(0.8), RGB(0.8))}};
  for (const auto& [name, bsdf] : white)
    for (const double theta : {0.05, 0.8, 1.3}) {
      const double a = albedo(*bsdf, direction(theta, 0.5)).x;
      EXPECT_LE(a, 1 + 2e-3) << name << ' ' << theta;
      EXPECT_GT(a, 0.5) << name << ' ' << theta;
    }
  EXPECT_NEAR(albedo(*make_phong(8.0, RGB(0.6), RGB(0.4)), direction(0, 0)).x, 1, 1e-3)
      << "along the normal no part of the lobe is cut off";
}

/// The smooth interface is the limit.
TEST(CoatedFurnace, RoughPlasticBecomesPlastic) {
  const auto rough = make_rough_plastic({MicrofacetKind::Ggx, 1e-3, 1e-3}, 1.5);
  const auto smooth = make_plastic(1.5);
  for (const double theta : {0.2, 0.9, 1.3}) {
    const Vec3 a = direction(theta, 0), b = direction(0.5, 1);
    EXPECT_NEAR(rough->f_s(kAnyPoint, a, b).x, smooth->f_s(kAnyPoint, a, b).x,
                4e-3 * smooth->f_s(kAnyPoint, a, b).x);
  }
}

/// The published model: Lambertian without roughness; at normal incidence and exit C₁ and the
/// interreflections alone; and retroreflection at grazing angles.
TEST(RoughDiffuse, IsOrenAndNayars) {
  const RGB rho(0.2, 0.5, 0.8);
  const Vec3 a = direction(1.1, 0.3), b = direction(0.6, 2);
  for (const bool fast : {false, true})
    EXPECT_NEAR(length(make_rough_diffuse(rho, 0.0, fast)->f_s(kAnyPoint, a, b) - rho * kInvPi), 0,
                1e-14);
  const double alpha = 0.5, s2 = alpha * alpha / 2;
  const Vec3 n(0, 0, 1);
  const double C1 = 1 - 0.5 * s2 / (s2 + 0.33), twice = 0.17 * s2 / (s2 + 0.13);
  const RGB at_normal = make_rough_diffuse(rho, alpha)->f_s(kAnyPoint, n, n);
  EXPECT_NEAR(length(at_normal - kInvPi * (C1 * rho + twice * rho * rho)), 0, 1e-14);
  // θ_i = θ_r = 1, φ = 0, written out with the numbers of eq. 27 to 29.
  const double theta = 1, C2 = 0.45 * s2 / (s2 + 0.09) * std::sin(theta);
  const double expected = C1 + C2 * std::tan(theta) + twice * 0.5 * (1 - sqr(2 * theta / kPi));
  const Vec3 w = direction(theta, 0.7);
  EXPECT_NEAR(make_rough_diffuse(rho, alpha)->f_s(kAnyPoint, w, w).y, 0.5 * kInvPi * expected,
              1e-14);
  const Vec3 across = direction(theta, 0.7 + kPi);
  EXPECT_GT(make_rough_diffuse(rho, alpha)->f_s(kAnyPoint, w, w).y,
            1.3 * make_rough_diffuse(rho, alpha)->f_s(kAnyPoint, w, across).y);
  EXPECT_NEAR(make_rough_diffuse(rho, alpha, true)->f_s(kAnyPoint, w, w).y,
              0.5 * kInvPi * (C1 + C2 * std::tan(theta)), 1e-14);
  // max(0, cosφ): across, only A is left.
  EXPECT_NEAR(make_rough_diffuse(rho, alpha, true)->f_s(kAnyPoint, w, across).y, 0.5 * kInvPi * C1,
              1e-14);
}

TEST(CoatedLaws, RefuseWhatMakesNoSense) {
  EXPECT_THROW(make_plastic(0), std::domain_error);
  EXPECT_THROW(make_plastic(1.5, false, RGB(1.5)), std::domain_error);
  EXPECT_THROW(make_rough_plastic({MicrofacetKind::Ggx, 0.1, 0.2}, 1.5), std::domain_error);
  EXPECT_THROW(make_thin_dielectric(-1), std::domain_error);
  EXPECT_THROW(make_mask(nullptr), std::domain_error);
  EXPECT_THROW(make_mask(make_diffuse(RGB(1)), 1.5), std::domain_error);
  EXPECT_THROW(make_blend(make_diffuse(RGB(1)), nullptr), std::domain_error);
  EXPECT_THROW(make_blend(make_dielectric(1.5), make_dielectric(1.4)), std::domain_error);
  EXPECT_THROW(make_blend(make_dielectric(1.5), make_thin_dielectric(1.5)), std::domain_error);
  EXPECT_THROW(make_phong(-1.0), std::domain_error);
  EXPECT_THROW(make_rough_diffuse(RGB(1), -1.0), std::domain_error);
  EXPECT_THROW(make_twosided(make_mask(make_diffuse(RGB(1)))), std::domain_error);
  EXPECT_NO_THROW(make_twosided(make_blend(make_plastic(1.5), make_diffuse(RGB(1)))));
}

}  // namespace
}  // namespace fogbow
