// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "media/media.h"
#include "tests/helpers/triples.h"

namespace fogbow {
namespace {

const RGB kSigmaT(0.4, 1.7, 9.0);
const Ray kRay{Vec3(1, 2, 3), Vec3(0, 0, 1)};

std::shared_ptr<const Medium> fog(const RGB& sigma_t = kSigmaT, const RGB& albedo = RGB(0.5),
                                  const RGB& emission = RGB(0)) {
  return make_homogeneous_medium(sigma_t, albedo, make_isotropic_phase(), emission, "fog");
}

TEST(Homogeneous, Coefficients) {
  const auto medium = fog(kSigmaT, {0, 0.5, 1}, {1, 2, 3});
  EXPECT_EQ(medium->sigma_t(kRay.o), kSigmaT);
  EXPECT_EQ(medium->sigma_s(kRay.o), RGB(0, 0.85, 9));
  EXPECT_EQ(medium->emission(kRay.o), RGB(1, 2, 3));
  EXPECT_TRUE(medium->scatters() && medium->emits());
  EXPECT_EQ(medium->id(), "fog");
  const auto smoke = fog(kSigmaT, RGB(0));
  EXPECT_FALSE(smoke->scatters() || smoke->emits());
}

TEST(Homogeneous, OpticalDepth) {
  EXPECT_EQ(fog()->optical_depth(kRay, 1, 3), 2.0 * kSigmaT);
  const auto red_only = fog({0, 1, 0});
  EXPECT_EQ(red_only->optical_depth(kRay, 0, kInfinity), RGB(0, kInfinity, 0));
  EXPECT_TRUE(std::isnan(fog()->optical_depth(kRay, 0, std::nan("")).x)) << "not hidden";
}

TEST(Homogeneous, DistanceInvertsOpticalDepth) {
  const auto medium = fog();
  for (int channel = 0; channel < 3; ++channel)
    for (const double t0 : {0.0, 2.5})
      for (const double t : {1e-12, 0.1, 3.0, 1e6}) {
        const double depth = medium->optical_depth(kRay, t0, t0 + t)[channel];
        const auto found = medium->distance(kRay, t0, kInfinity, channel, depth);
        ASSERT_TRUE(found);
        EXPECT_NEAR(*found, t0 + t, 1e-15 * (t0 + t));
        EXPECT_FALSE(medium->distance(kRay, t0, t0 + 0.999 * t, channel, depth));
      }
  EXPECT_FALSE(fog(RGB(0, 1, 0))->distance(kRay, 0, kInfinity, 0, 0.1));
  EXPECT_FALSE(fog(RGB(0, 1, 0))->distance(kRay, 0, kInfinity, 0, kInfinity));
  EXPECT_FALSE(fog()->distance(kRay, 0, kInfinity, 1, kInfinity));
}

/// Free flight in a channel drawn uniformly: q(t) = mean of σ e^{−σt}, the wall has the mean of
/// e^{−σT}, and the channel has a posterior.
TEST(Homogeneous, ChromaticFreeFlight) {
  const auto medium = fog();
  for (const double wall : {0.05, 0.8, 5.0}) {
    const auto density = [](int channel, double t) {
      return kSigmaT[channel] * std::exp(-kSigmaT[channel] * t);
    };
    const testing::Triple flight{
        2,
        [=](const Vec3& u) -> std::optional<Vec3> {
          const int channel = static_cast<int>(3 * u.x);
          const auto t = medium->distance(kRay, 1, 1 + wall, channel, -std::log1p(-u.y));
          if (!t) return std::nullopt;
          return Vec3(*t, 0, 0);
        },
        [=](const Vec3& x) {
          return (density(0, x.x - 1) + density(1, x.x - 1) + density(2, x.x - 1)) / 3;
        },
        [=](const Vec3& x, const Vec3& auxiliary) -> std::optional<Vec3> {
          const double t = x.x - 1;
          const double total = density(0, t) + density(1, t) + density(2, t);
          double rest = auxiliary.x * total;
          int channel = 0;
          while (channel < 2 && rest >= density(channel, t)) rest -= density(channel++, t);
          const double depth = medium->optical_depth(kRay, 1, x.x)[channel];
          return Vec3(std::fmin((channel + rest / density(channel, t)) / 3, kOneMinusEpsilon),
                      -std::expm1(-depth), 0);
        }};
    const double mass = 1 - (std::exp(-kSigmaT.x * wall) + std::exp(-kSigmaT.y * wall) +
                             std::exp(-kSigmaT.z * wall)) /
                                3;
    EXPECT_EQ(testing::check_triple("chromatic flight to " + std::to_string(wall), flight,
                                    testing::interval_chart(1, 1 + wall), {.mass = mass}),
              "");
  }
}

TEST(Homogeneous, RefusesImpossibleCoefficients) {
  EXPECT_THROW(fog(RGB(-1)), std::domain_error);
  EXPECT_THROW(fog(RGB(kInfinity)), std::domain_error);
  EXPECT_THROW(fog(RGB(1), RGB(1.01)), std::domain_error);
  EXPECT_THROW(fog(RGB(1), RGB(-0.1)), std::domain_error);
  EXPECT_THROW(fog(RGB(1), RGB(0, std::nan(""), 0)), std::domain_error);
  EXPECT_THROW(fog(RGB(0), RGB(0), RGB(1)), std::domain_error) << "emission without extinction";
  EXPECT_THROW(fog(RGB(1), RGB(0), RGB(-1)), std::domain_error);
  EXPECT_NO_THROW(fog(RGB(0), RGB(0.75)));
}

}  // namespace
}  // namespace fogbow
