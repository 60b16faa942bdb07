// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <complex>

#include "core/scene/bsdf/fresnel.h"
#include "tests/unit/materials/bsdf_cases.h"

namespace fogbow {
namespace {

TEST(Fresnel, DielectricAgreesWithTheAmplitudes) {
  for (const double eta : {0.4, 1 / 1.5, 0.99, 1.01, 1.33, 1.5, 2.4})
    for (const double theta : {0.0, 0.1, 0.5, 0.7, 1.0, 1.3, 1.5, 1.57}) {
      const double cos_i = std::cos(theta);
      EXPECT_NEAR(fresnel_dielectric(cos_i, eta).F, testing::textbook_fresnel(cos_i, 1, eta), 1e-12)
          << eta << ' ' << theta;
    }
}

TEST(Fresnel, DielectricSpecialAngles) {
  EXPECT_NEAR(fresnel_dielectric(1, 1.5).F, 0.04, 1e-15);
  EXPECT_EQ(fresnel_dielectric(0, 1.5).F, 1);
  const double brewster = std::atan(1.5);  // the reflected light is all s-polarized
  EXPECT_NEAR(fresnel_dielectric(std::cos(brewster), 1.5).F, 0.5 * sqr(std::cos(2 * brewster)),
              1e-15);
  const double critical = std::sqrt(1 - sqr(1 / 1.5));
  EXPECT_EQ(fresnel_dielectric(critical - 1e-9, 1 / 1.5).F, 1);
  EXPECT_EQ(fresnel_dielectric(critical - 1e-9, 1 / 1.5).cos_t, 0);
  EXPECT_LT(fresnel_dielectric(critical + 1e-9, 1 / 1.5).F, 1);
}

TEST(Fresnel, EqualIndicesAreInvisible) {
  for (const double cos_i : {1.0, 0.3, 1e-3, 1e-8, 1e-12}) {
    EXPECT_EQ(fresnel_dielectric(cos_i, 1).F, 0);
    EXPECT_EQ(fresnel_dielectric(cos_i, 1).cos_t, cos_i);
  }
}

TEST(Fresnel, DielectricIsTheSameFromBothSides) {
  for (const double eta : {0.5, 1.1, 1.5})
    for (const double cos_i : {0.9, 0.95, 0.999}) {
      const auto there = fresnel_dielectric(cos_i, eta);
      const auto back = fresnel_dielectric(there.cos_t, 1 / eta);
      EXPECT_NEAR(back.F, there.F, 1e-13);
      EXPECT_NEAR(back.cos_t, cos_i, 1e-14);
    }
}

double complex_fresnel(double cos_i, double eta, double k) {
  const std::complex<double> n(eta, k);
  const std::complex<double> cos_t = std::sqrt(1.0 - (1 - cos_i * cos_i) / (n * n));
  const auto r_s = (cos_i - n * cos_t) / (cos_i + n * cos_t);
  const auto r_p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
  return 0.5 * (std::norm(r_s) + std::norm(r_p));
}

TEST(Fresnel, ConductorAgreesWithComplexAmplitudes) {
  for (const double eta : {1e-6, 0.2, 0.9, 1.5, 3.0})
    for (const double k : {1e-3, 0.5, 2.2, 6.0})
      for (const double cos_i : {1.0, 0.9, 0.5, 0.1, 1e-3})
        EXPECT_NEAR(fresnel_conductor(cos_i, eta, k), complex_fresnel(cos_i, eta, k), 1e-11)
            << eta << ' ' << k << ' ' << cos_i;
  // Without absorption it is a dielectric.
  EXPECT_NEAR(fresnel_conductor(0.6, 1.5, 0), fresnel_dielectric(0.6, 1.5).F, 1e-14);
}

TEST(Fresnel, PurelyImaginaryIndexIsAPerfectMirror) {
  for (const double cos_i : {1.0, 0.7, 0.1, 1e-9}) EXPECT_EQ(fresnel_conductor(cos_i, 0, 1), 1);
}

TEST(Fresnel, TransmittanceIsTheRest) {
  for (const double eta : {0.7, 1.0, 1.5})
    for (const double cos_i : {1.0, 0.8, 0.4, 1e-2}) {
      const Refraction r = fresnel_dielectric(cos_i, eta);
      EXPECT_NEAR(r.F + r.T, 1, 1e-15);
    }
  // Grazing: T → 4 cosθ (1/√(η²−1) + η²/√(η²−1))/2.
  EXPECT_NEAR(fresnel_dielectric(1e-12, 1.5).T, 2e-12 * (1 + 2.25) / std::sqrt(1.25), 1e-22);
}

TEST(Fresnel, EventProbabilitiesWeighTheTints) {
  const auto probabilities = [](double F, double reflectance, double transmittance) {
    const auto p = event_probabilities({F, 1 - F, 1}, reflectance, transmittance);
    return Vec2(p.reflection, p.transmission);
  };
  EXPECT_EQ(probabilities(0.3, 1, 1), Vec2(0.3, 0.7));
  EXPECT_NEAR(probabilities(0.3, 0.5, 0.25).x, 0.15 / (0.15 + 0.175), 1e-15);
  EXPECT_EQ(probabilities(0.3, 0, 1), Vec2(0, 1));
  EXPECT_EQ(probabilities(0.3, 1, 0), Vec2(1, 0));
  EXPECT_EQ(probabilities(0.3, 0, 0), Vec2(0, 0));
  EXPECT_EQ(probabilities(0, 1, 0), Vec2(0, 0));
}

TEST(Fresnel, RefusesImpossibleIndices) {
  EXPECT_THROW(ComplexIndex(RGB(-1), RGB(1)), std::domain_error);
  EXPECT_THROW(ComplexIndex(RGB(0), RGB(0)), std::domain_error);
  EXPECT_THROW(ComplexIndex(RGB(1), RGB(kInfinity)), std::domain_error);
  EXPECT_THROW(ComplexIndex(RGB(std::nan("")), RGB(1)), std::domain_error);
}

}  // namespace
}  // namespace fogbow
