// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>

#include "media/mie.h"
#include "tests/helpers/quadrature.h"

namespace fogbow {
namespace {

using Complex = std::complex<double>;

constexpr double kDegree = kPi / 180;

/// Wiscombe 1979 (the test cases of MIEV0, revised 1996) prints six decimals of Q and g, and |S₁|
/// in the backward direction; Bohren and Huffman 1983, app. A, the first.
TEST(Mie, PublishedEfficiencies) {
  struct Case {
    double n, k, x, scattering, asymmetry, error;
  };
  const double example = 2 * kPi * 0.525 / 0.6328;
  const Case cases[] = {
      {1.55, 0, example, 3.10543, 0.63314, 5e-6},
      {0.75, 0, 0.099, 0.000007, 0.001448, 5e-7},
      {0.75, 0, 0.101, 0.000008, 0.001507, 5e-7},
      {0.75, 0, 10, 2.232265, 0.896473, 5e-7},
      {0.75, 0, 1000, 1.997908, 0.844944, 5e-7},
      {1.33, 1e-5, 1, 0.093923, 0.184517, 5e-7},
      {1.33, 1e-5, 100, 2.096594, 0.868959, 5e-7},
      {1.33, 1e-5, 10000, 1.723857, 0.907840, 5e-7},
      {1.5, 1, 0.055, 0.000011, 0.000491, 5e-7},
      {1.5, 1, 0.056, 0.000012, 0.000509, 5e-7},
      {1.5, 1, 1, 0.663454, 0.192136, 5e-7},
      {1.5, 1, 100, 1.283697, 0.850252, 5e-7},
      // 1.2365743 and 0.8463100 in arithmetic of 40 digits: the table's last digit is off
      {1.5, 1, 10000, 1.236575, 0.846309, 1e-6},
      {10, 10, 1, 2.049405, -0.110664, 5e-7},
      {10, 10, 100, 1.836785, 0.556215, 5e-7},
      {10, 10, 10000, 1.795393, 0.548194, 5e-7}};
  for (const Case& c : cases) {
    const auto Q = MieSphere(c.x, {c.n, c.k}).efficiencies();
    EXPECT_NEAR(Q.scattering, c.scattering, 1.01 * c.error) << c.n << ' ' << c.x;
    EXPECT_NEAR(Q.asymmetry, c.asymmetry, 1.01 * c.error) << c.n << ' ' << c.x;
    if (c.k == 0) {
      EXPECT_NEAR(Q.extinction, Q.scattering, 1e-12 * Q.scattering);
    }
  }
  EXPECT_NEAR(MieSphere(example, 1.55).efficiencies().extinction, 3.10543, 5e-6);
  EXPECT_NEAR(MieSphere(example, 1.55).efficiencies().backscattering, 2.92534, 5e-6);
  EXPECT_NEAR(MieSphere(100, {1.5, 1}).efficiencies().extinction, 2.097502, 6e-7);
  EXPECT_NEAR(MieSphere(10000, {1.5, 1}).efficiencies().extinction, 2.004368, 6e-7);
  // 4 |S₁(180°)|²/x² of m = 0.75, x = 10 and 1000.
  EXPECT_NEAR(MieSphere(10, 0.75).efficiencies().backscattering,
              0.04 * std::norm(Complex(-1.07857, -3.60881e-2)), 1e-6);
  EXPECT_NEAR(MieSphere(1000, 0.75).efficiencies().backscattering,
              4e-6 * std::norm(Complex(1.70578e1, 4.84251e2)), 1e-5);
}

/// S₁ and S₂ of MIEV0's case m = 1.5 − i, x = 1, in its convention e^{+iωt}: conjugates.
TEST(Mie, PublishedAmplitudes) {
  const Complex S1[] = {{0.584080, 0.190515}, {0.565702, 0.187200}, {0.517525, 0.178443},
                        {0.456340, 0.167167}, {0.400212, 0.156643}, {0.362157, 0.149391},
                        {0.348844, 0.146829}};
  const Complex S2[] = {{0.584080, 0.190515},    {0.500161, 0.145611},   {0.287964, 0.041054},
                        {0.0362285, -0.0618265}, {-0.174875, -0.122959}, {-0.305682, -0.143846},
                        {-0.348844, -0.146829}};
  const MieSphere sphere(1, {1.5, 1});
  for (int i = 0; i < 7; ++i) {
    const auto [a, b] = sphere.amplitudes(std::cos(30 * i * kDegree));
    EXPECT_LT(std::abs(std::conj(a) - S1[i]), 1e-6) << 30 * i;
    EXPECT_LT(std::abs(std::conj(b) - S2[i]), 1e-6) << 30 * i;
  }
}

/// S₁₁ over that ahead, every 9°: Bohren and Huffman 1983, app. A, m = 1.55, x = 5.213.
TEST(Mie, PublishedScatteringMatrix) {
  const double expected[] = {1,          0.785390,   0.356897,   0.0766119,  0.0355355, 0.0701845,
                             0.0574313,  0.0219660,  0.0125959,  0.0173750,  0.0124601, 0.00679093,
                             0.00954239, 0.00863419, 0.00227421, 0.00543998, 0.0160243, 0.0188852,
                             0.0195254,  0.0301676,  0.0383189};
  const MieSphere sphere(2 * kPi * 0.525 / 0.6328, 1.55);
  const auto S11 = [&](double degrees) {
    const auto [S1, S2] = sphere.amplitudes(std::cos(degrees * kDegree));
    return 0.5 * (std::norm(S1) + std::norm(S2));
  };
  for (int i = 0; i <= 20; ++i)
    EXPECT_NEAR(S11(9 * i) / S11(0), expected[i], 6e-6 * expected[i]) << 9 * i;
}

/// Spheres much smaller than the wavelength [Bohren1983, eq. 5.7 and 5.8].
TEST(Mie, RayleighsLimit) {
  const Complex m(1.5, 0.1), K = (m * m - 1.0) / (m * m + 2.0);
  for (const double x : {1e-3, 1e-2}) {
    const MieSphere sphere(x, m);
    const auto Q = sphere.efficiencies();
    EXPECT_NEAR(Q.scattering / (8.0 / 3 * std::pow(x, 4) * std::norm(K)), 1, 2 * x * x);
    EXPECT_NEAR((Q.extinction - Q.scattering) / (4 * x * K.imag()), 1, 2 * x * x);
    EXPECT_NEAR(Q.asymmetry, 0, x * x);
    for (const double mu : {-1.0, -0.4, 0.0, 0.7, 1.0}) {
      const auto [S1, S2] = sphere.amplitudes(mu);
      EXPECT_NEAR(std::abs(S1) / (std::pow(x, 3) * std::abs(K)), 1, 2 * x * x);
      EXPECT_NEAR((S2 / S1).real(), mu, 2 * x * x);
    }
  }
}

/// The optical theorem [Bohren1983, eq. 4.76], and efficiencies as integrals over all directions.
TEST(Mie, LawsOfEnergy) {
  for (const double x : {0.3, 4.0, 31.0})
    for (const Complex m : {Complex(1.33, 0), Complex(1.6, 0.05), Complex(0.8, 0)}) {
      const MieSphere sphere(x, m);
      const auto Q = sphere.efficiencies();
      EXPECT_NEAR(4 / (x * x) * sphere.amplitudes(1).first.real() / Q.extinction, 1, 1e-13);
      const auto moment = [&](int power) {
        return testing::integrate(
            [&](double mu) {
              const auto [S1, S2] = sphere.amplitudes(mu);
              return (std::norm(S1) + std::norm(S2)) / (x * x) * std::pow(mu, power);
            },
            -1, 1);
      };
      EXPECT_NEAR(moment(0) / Q.scattering, 1, 1e-10);
      EXPECT_NEAR(moment(1) / (Q.scattering * Q.asymmetry), 1, 1e-9);
    }
}

TEST(Mie, RefusesWhatItCannotCompute) {
  for (const double x : {0.0, -1.0, 1e7, kInfinity, std::nan("")})
    EXPECT_THROW(MieSphere(x, 1.33), std::domain_error);
  for (const Complex m : {Complex(0, 0), Complex(-1, 0), Complex(1.3, -0.1), Complex(1e9, 0),
                          Complex(std::nan(""), 0)})
    EXPECT_THROW(MieSphere(1, m), std::domain_error);
}

/// Against air at 20 °C, Fraunhofer's lines C, D and F (handbooks' values).
TEST(Mie, WaterIndex) {
  EXPECT_NEAR(water_index(656.28), 1.33115, 5e-5);
  EXPECT_NEAR(water_index(589.29), 1.33299, 5e-5);
  EXPECT_NEAR(water_index(486.13), 1.33712, 5e-5);
}

}  // namespace
}  // namespace fogbow
