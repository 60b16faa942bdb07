// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "core/scene/bsdf/bsdfs.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/materials/bsdf_cases.h"

namespace fogbow {
namespace {

using testing::direction;
using testing::kAnyPoint;

class Random {
 public:
  Random() : engine_(testing::suite_seed()) {}
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Vec3 uniform3() {
    const double x = uniform(), y = uniform();
    return {x, y, uniform()};
  }
  Vec3 any_direction() { return direction(std::acos(1 - 2 * uniform()), 2 * kPi * uniform()); }

 private:
  std::mt19937_64 engine_;
};

double index(const Bsdf& bsdf, const Vec3& w) { return w.z > 0 ? 1 : bsdf.eta(); }

std::vector<std::shared_ptr<const Bsdf>> smooth_bsdfs() {
  const RoughnessSettings ggx{MicrofacetKind::Ggx, 0.3, 0.6};
  const RoughnessSettings beckmann{MicrofacetKind::Beckmann, 0.5, 0.2};
  const RGB eta(0.2, 0.9, 1.1), k(3.9, 2.4, 2.2), tint(1, 0.7, 0.2);
  return {make_diffuse({0.2, 0.5, 0.8}),
          make_rough_conductor(ggx, eta, k, tint),
          make_rough_conductor(beckmann, eta, k),
          make_rough_dielectric(ggx, 1.5, tint, {0.3, 0.9, 1}),
          make_rough_dielectric(beckmann, 0.7),
          make_twosided(make_diffuse({0.2, 0.5, 0.8}), make_rough_conductor(ggx, eta, k))};
}

/// f_s(a → b)/n_b² is symmetric (Veach 1997, sec. 5.2).
TEST(BsdfLaws, Reciprocity) {
  Random random;
  for (const auto& bsdf : smooth_bsdfs()) {
    int positive = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 a = random.any_direction(), b = random.any_direction();
      const RGB there = bsdf->f_s(kAnyPoint, a, b) / sqr(index(*bsdf, b));
      const RGB back = bsdf->f_s(kAnyPoint, b, a) / sqr(index(*bsdf, a));
      EXPECT_LE(length(there - back), 1e-10 * length(there) + 1e-300) << bsdf->name();
      positive += there.y > 0;
    }
    EXPECT_GT(positive, 1000) << bsdf->name();
  }
}

TEST(BsdfLaws, SampleAnswersThePdfOfWhatItSampled) {
  Random random;
  for (const auto& bsdf : smooth_bsdfs())
    for (int i = 0; i < 5000; ++i) {
      const Vec3 from = random.any_direction();
      const auto sample = bsdf->sample(kAnyPoint, from, random.uniform3());
      if (!sample) continue;
      EXPECT_FALSE(sample->dirac);
      EXPECT_EQ(sample->pdf_sigma, bsdf->pdf_sigma(kAnyPoint, from, sample->w)) << bsdf->name();
      EXPECT_NEAR(length(sample->w), 1, 1e-12);
      EXPECT_GT(bsdf->f_s(kAnyPoint, sample->w, from).z, 0) << bsdf->name();
    }
}

/// What is evaluated at once is what is evaluated one by one.
TEST(BsdfLaws, EvaluateAnswersAllThree) {
  Random random;
  auto bsdfs = smooth_bsdfs();
  bsdfs.push_back(make_twosided(make_diffuse({0.2, 0.5, 0.8})));
  for (const auto& bsdf : bsdfs) {
    int bright = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 light = random.any_direction(), eye = random.any_direction();
      const BsdfValue all = bsdf->evaluate(kAnyPoint, light, eye);
      EXPECT_EQ(all.f, bsdf->f_s(kAnyPoint, light, eye)) << bsdf->name();
      if (is_black(all.f)) continue;
      ++bright;
      EXPECT_EQ(all.pdf_to_light, bsdf->pdf_sigma(kAnyPoint, eye, light)) << bsdf->name();
      EXPECT_EQ(all.pdf_to_eye, bsdf->pdf_sigma(kAnyPoint, light, eye)) << bsdf->name();
    }
    EXPECT_GT(bright, 500) << bsdf->name();
  }
}

TEST(BsdfLaws, ReflectingBsdfsAreBlackFromBehind) {
  const auto bsdfs = smooth_bsdfs();
  for (int i = 0; i < 3; ++i)
    for (const auto& [a, b] : {std::pair(direction(2, 0), direction(2.5, 3)),
                               std::pair(direction(1, 0), direction(2.5, 3)),
                               std::pair(direction(2, 0), direction(1, 3))}) {
      EXPECT_TRUE(is_black(bsdfs[i]->f_s(kAnyPoint, a, b)));
      EXPECT_EQ(bsdfs[i]->pdf_sigma(kAnyPoint, a, b), 0);
      EXPECT_FALSE(bsdfs[i]->invert(kAnyPoint, a, b, false, Vec3(0.5)));
    }
  EXPECT_FALSE(bsdfs[0]->sample(kAnyPoint, direction(2, 0), Vec3(0.5)));
}

// --- The Dirac part
// --------------------------------------------------------------------------------------------------

/// The law of bsdf.h from both ends: traced from the eye a specular vertex weighs C/P ·
/// n_eye²/n_light², traced from the light C/P.
TEST(BsdfLaws, DiracWeights) {
  const double R = 0.8, T = 0.6;
  Random random;
  for (const double eta : {1.5, 0.7, 1.0, 2.4}) {
    const auto glass = make_dielectric(eta, RGB(R), RGB(T));
    int reflections = 0, refractions = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 from = random.any_direction();
      const auto sample = glass->sample(kAnyPoint, from, random.uniform3());
      ASSERT_TRUE(sample && sample->dirac);
      const Vec3 to = sample->w;
      const double n_from = from.z > 0 ? 1 : eta, n_to = to.z > 0 ? 1 : eta;
      const bool reflected = from.z * to.z > 0;
      ++(reflected ? reflections : refractions);
      // Snell, in the plane of incidence, and unit length.
      EXPECT_NEAR(n_from * from.x, -n_to * to.x, 1e-14 * eta);
      EXPECT_NEAR(n_from * from.y, -n_to * to.y, 1e-14 * eta);
      EXPECT_NEAR(length(to), 1, 1e-12);

      const double F = testing::textbook_fresnel(from.z, n_from, n_from == 1 ? eta : 1);
      const double C = reflected ? F * R : (1 - F) * T;
      const double P = C / (F * R + (1 - F) * T);
      EXPECT_EQ(sample->pdf_sigma, glass->pdf_dirac(kAnyPoint, from, to));
      const double weight = std::fabs(to.z) / sample->pdf_sigma;
      const double from_eye = glass->f_dirac(kAnyPoint, to, from).x * weight;
      const double from_light = glass->f_dirac(kAnyPoint, from, to).x * weight;
      const double tolerance = 1e-6 * C / P;  // F has an infinite slope at the critical angle
      EXPECT_NEAR(from_eye, C / P * sqr(n_from / n_to), tolerance * sqr(n_from / n_to));
      EXPECT_NEAR(from_light, C / P, tolerance);
    }
    EXPECT_GT(refractions, 5000);
    if (eta != 1)
      EXPECT_GT(reflections, 500);
    else
      EXPECT_EQ(reflections, 0);
  }
}

/// With one δ on both sides f/p of a path does not depend on the side from which it was sampled:
/// pdf(a→b) |cos a| n_a² = pdf's mirror up to P.
TEST(BsdfLaws, DiracReciprocity) {
  const auto glass = make_dielectric(1.5);
  for (const double theta : {0.1, 0.8, 1.4}) {
    const Vec3 a = direction(theta, 0.3);
    const double s = std::sin(theta) / 1.5;
    const Vec3 b(-a.x / 1.5, -a.y / 1.5, -std::sqrt(1 - s * s));
    const double there = glass->f_dirac(kAnyPoint, a, b).x / sqr(1.5);
    EXPECT_NEAR(there, glass->f_dirac(kAnyPoint, b, a).x, 1e-13);
    EXPECT_NEAR(there, 1 - testing::textbook_fresnel(a.z, 1, 1.5), 1e-13);
    // |cosθ| n² dσ is the same on both sides of the interface.
    EXPECT_NEAR(glass->pdf_dirac(kAnyPoint, a, b) / (sqr(1.5) * -b.z),
                glass->pdf_dirac(kAnyPoint, b, a) / a.z, 1e-13);
  }
}

TEST(BsdfLaws, DiracInverseFindsTheEvent) {
  Random random;
  const std::shared_ptr<const Bsdf> bsdfs[] = {make_dielectric(1.5),
                                               make_dielectric(0.7, RGB(0.2), RGB(1)),
                                               make_conductor({0.2, 0.9, 1.1}, {3.9, 2.4, 2.2}),
                                               make_twosided(make_conductor(RGB(0), RGB(1)))};
  for (const auto& bsdf : bsdfs) {
    std::vector<double> u_again;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 from = random.any_direction();
      const auto sample = bsdf->sample(kAnyPoint, from, random.uniform3());
      if (!sample) continue;
      EXPECT_FALSE(bsdf->invert(kAnyPoint, from, sample->w, false, Vec3(0.5)));
      const auto u = bsdf->invert(kAnyPoint, from, sample->w, true, random.uniform3());
      ASSERT_TRUE(u);
      const auto again = bsdf->sample(kAnyPoint, from, *u);
      ASSERT_TRUE(again);
      EXPECT_EQ(again->w, sample->w) << bsdf->name();
      u_again.push_back(u->x);
    }
    EXPECT_GT(testing::uniform_ks_test(u_again), testing::sidak(testing::kSuiteFalseAlarm, 100))
        << bsdf->name();
  }
}

TEST(BsdfLaws, ConductorReflectsByFresnel) {
  const auto mirror = make_conductor(RGB(0), RGB(1));
  const Vec3 w = direction(0.9, 0.4), r(-w.x, -w.y, w.z);
  EXPECT_EQ(mirror->f_dirac(kAnyPoint, w, r), RGB(1));
  EXPECT_EQ(mirror->pdf_dirac(kAnyPoint, w, r), w.z);
  EXPECT_FALSE(mirror->sample(kAnyPoint, -w, Vec3(0.5))) << "black from behind";
  EXPECT_TRUE(make_twosided(mirror)->sample(kAnyPoint, -w, Vec3(0.5)));
  EXPECT_EQ(make_twosided(mirror)->f_dirac(kAnyPoint, -w, -r), RGB(1));
}

/// As roughness vanishes, the integrals over each lobe become the Dirac weights: the one law tested
/// against the other.
TEST(BsdfLaws, RoughBecomesSmooth) {
  Random random;
  for (const MicrofacetKind kind : {MicrofacetKind::Ggx, MicrofacetKind::Beckmann})
    for (const double theta : {0.3, 1.0, 2.0, 2.7}) {
      const auto rough = make_rough_dielectric({kind, 1e-4, 1e-4}, 1.5);
      const Vec3 eye = direction(theta, 1);
      const double n_eye = eye.z > 0 ? 1 : 1.5, n_other = 2.5 - n_eye;
      double reflected = 0, transmitted = 0;
      constexpr int kSamples = 20000;
      for (int i = 0; i < kSamples; ++i) {
        // Stratified in the choice of lobe, the only source of noise left.
        Vec3 u = random.uniform3();
        u.x = (i + u.x) / kSamples;
        const auto sample = rough->sample(kAnyPoint, eye, u);
        if (!sample) continue;
        const double weight = rough->f_s(kAnyPoint, sample->w, eye).x * std::fabs(sample->w.z) /
                              sample->pdf_sigma / kSamples;
        (sample->w.z * eye.z > 0 ? reflected : transmitted) += weight;
      }
      const double F = testing::textbook_fresnel(eye.z, n_eye, n_other);
      EXPECT_NEAR(reflected, F, 3e-4);
      EXPECT_NEAR(transmitted, (1 - F) * sqr(n_eye / n_other), 6e-4);
    }
}

// --- What cannot be made
// ---------------------------------------------------------------------------------------------

/// The interface with other things on its sides: all else stays.
TEST(BsdfLaws, InterfacesBetweenOthers) {
  const RGB reflectance(0.9, 0.5, 0.3), transmittance(0.2, 0.8, 1);
  const RoughnessSettings rough{MicrofacetKind::Beckmann, 0.3, 0.2};
  const double n_interior = 1.31, n_exterior = 1.33, eta = n_interior / n_exterior;
  const std::pair<std::shared_ptr<const Bsdf>, std::shared_ptr<const Bsdf>> cases[] = {
      {make_dielectric(1.5, reflectance, transmittance, 1.2),
       make_dielectric(eta, reflectance, transmittance, n_exterior)},
      {make_rough_dielectric(rough, 1.5, reflectance, transmittance, 1.2),
       make_rough_dielectric(rough, eta, reflectance, transmittance, n_exterior)}};
  const Vec3 light = direction(0.4, 0), eyes[] = {direction(0.5, 3), direction(2.7, 3)};
  for (const auto& [other, expected] : cases) {
    EXPECT_EQ(other->n_exterior(), 1.2);
    const auto found = other->between(n_interior, n_exterior);
    EXPECT_EQ(found->eta(), eta);
    EXPECT_EQ(found->n_exterior(), n_exterior);
    for (const Vec3& eye : eyes) {
      EXPECT_EQ(found->f_s(kAnyPoint, light, eye), expected->f_s(kAnyPoint, light, eye));
      EXPECT_EQ(found->f_dirac(kAnyPoint, light, eye), expected->f_dirac(kAnyPoint, light, eye));
    }
  }
}

TEST(BsdfLaws, NullPassesEverything) {
  const auto null = make_null();
  EXPECT_FALSE(null->has_smooth() || null->has_dirac());
  EXPECT_EQ(null->passage(kAnyPoint, direction(1, 0)), RGB(1));
  EXPECT_EQ(make_diffuse(RGB(0.5))->passage(kAnyPoint, direction(1, 0)), RGB(0));
}

TEST(BsdfLaws, RefusesWhatMakesNoSense) {
  const RoughnessSettings rough{MicrofacetKind::Ggx, 0.1, 0.1};
  EXPECT_THROW(make_twosided(make_dielectric(1.5)), std::domain_error);
  EXPECT_THROW(make_twosided(make_diffuse(RGB(1)), make_null()), std::domain_error);
  EXPECT_THROW(make_twosided(nullptr), std::domain_error);
  EXPECT_NO_THROW(make_twosided(make_twosided(make_diffuse(RGB(1)))));
  EXPECT_THROW(make_diffuse(RGB(1.1)), std::domain_error);
  EXPECT_THROW(make_diffuse(RGB(0, std::nan(""), 0)), std::domain_error);
  EXPECT_THROW(make_dielectric(0), std::domain_error);
  EXPECT_THROW(make_dielectric(kInfinity), std::domain_error);
  EXPECT_THROW(make_dielectric(1.5, RGB(-1)), std::domain_error);
  EXPECT_THROW(make_rough_dielectric(rough, 1), std::domain_error);
  EXPECT_THROW(make_rough_conductor({MicrofacetKind::Ggx, -1, 1}, RGB(0), RGB(1)),
               std::domain_error);
  EXPECT_THROW(make_conductor(RGB(0), RGB(0)), std::domain_error);
}

}  // namespace
}  // namespace fogbow
