// SPDX-License-Identifier: GPL-3.0-or-later
// The film's expected picture against direct quadrature of I_j = ∫ h(p − c_j) f(p) dp / Z_j.
#include <gtest/gtest.h>

#include <map>

#include "core/image/film.h"
#include "core/math/random.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/image/reference_filters.h"

namespace fogbow {
namespace {

using testing::filter_cases;
using testing::FilterCase;

constexpr int kWidth = 5, kHeight = 4;
constexpr int kPixels = kWidth * kHeight;

FilmSettings small_film(const FilterCase& c) {
  FilmSettings s;
  s.width = 9;
  s.height = 8;
  s.crop_x = 3;
  s.crop_y = 2;
  s.crop_width = kWidth;
  s.crop_height = kHeight;
  s.filter = c.filter;
  return s;
}

/// Separable, so that its filtered values are products of one-dimensional integrals.
double picture_x(double x) { return 1 + 0.8 * std::sin(1.9 * x + 0.4); }
double picture_y(double y) { return 0.3 + 0.2 * y * y; }

/// ∫ h f / ∫ h over [0, n] for the pixel centred at j + ½.
double filtered(const FilterCase& c, double (*f)(double), int j, int n) {
  const double lo = std::max(0.0, j + 0.5 - c.radius), hi = std::min<double>(n, j + 0.5 + c.radius);
  const auto h = [&](double x) { return c.shape(x - j - 0.5); };
  return testing::quadrature([&](double x) { return h(x) * f(x); }, lo, hi, 20000) /
         testing::quadrature(h, lo, hi, 20000);
}

TEST(FilmLaw, ExpectedPixelsAreFilteredAveragesAlsoAtBorders) {
  constexpr int kReplicates = 24, kSamples = 150000;
  const auto cases = filter_cases();
  const double level =
      testing::sidak(testing::kSuiteFalseAlarm, kPixels * static_cast<int>(cases.size()));
  for (std::size_t k = 0; k < cases.size(); ++k) {
    std::vector<std::vector<double>> values(kPixels);
    for (int r = 0; r < kReplicates; ++r) {
      Film film(small_film(cases[k]), -30);
      Rng rng(testing::suite_seed(), RngDomain::Test, 100 + k, r);
      for (int i = 0; i < kSamples; ++i) {
        const Vec2 raster = uniform2(rng);
        const double f = picture_x(raster.x * kWidth) * picture_y(raster.y * kHeight);
        film.splat(raster, RGB(f), 0, uniform2(rng));
      }
      const Image image = film.develop(1.0 / kSamples, std::vector<double>(Film::kGroups, 0.0));
      for (int p = 0; p < kPixels; ++p) values[p].push_back(image.pixels[3 * p]);
    }
    for (int p = 0; p < kPixels; ++p) {
      const double expected = filtered(cases[k], picture_x, p % kWidth, kWidth) *
                              filtered(cases[k], picture_y, p / kWidth, kHeight);
      const auto estimate = testing::estimate(values[p]);
      EXPECT_LT(estimate.standard_error, 0.006 * expected) << "too weak a test";
      EXPECT_GT(testing::compare(estimate, expected), level)
          << cases[k].name << " pixel " << p << ": " << estimate.mean << " +- "
          << estimate.standard_error << ", expected " << expected;
    }
  }
}

TEST(FilmLaw, APixelIsChosenInProportionToItsFilter) {
  constexpr int kSamples = 20000;
  const std::vector<Vec2> places{{0.48, 0.53}, {0.013, 0.99}, {0.73, 0.04}, {0.43, 0.24}};
  const auto cases = filter_cases();
  const double level =
      testing::sidak(testing::kSuiteFalseAlarm, static_cast<int>(cases.size() * places.size()));
  for (std::size_t k = 0; k < cases.size(); ++k)
    for (std::size_t q = 0; q < places.size(); ++q) {
      Rng rng(testing::suite_seed(), RngDomain::Test, 200 + k, q);
      std::vector<std::uint64_t> observed(kPixels);
      for (int i = 0; i < kSamples; ++i) {
        Film film(small_film(cases[k]), -30);
        film.splat(places[q], RGB(1), 0, uniform2(rng));
        const Image image = film.develop(1, std::vector<double>(Film::kGroups, 0.0));
        for (int p = 0; p < kPixels; ++p) observed[p] += image.pixels[3 * p] != 0;
      }
      std::vector<double> expected(kPixels);
      double sum = 0;
      for (int p = 0; p < kPixels; ++p)
        sum += expected[p] = cases[k].shape(places[q].x * kWidth - p % kWidth - 0.5) *
                             cases[k].shape(places[q].y * kHeight - p / kWidth - 0.5);
      for (int p = 0; p < kPixels; ++p) {
        expected[p] *= kSamples / sum;
        EXPECT_TRUE(expected[p] > 0 || observed[p] == 0) << cases[k].name << " pixel " << p;
      }
      EXPECT_GT(testing::chi2_test(observed, expected), level) << cases[k].name << " place " << q;
    }
}

TEST(FilmLaw, HalfPixelBoxTakesThePixelThatHoldsThePoint) {
  FilmSettings settings;
  settings.width = 7;
  settings.height = 3;
  settings.filter = make_box_filter();
  Rng rng(testing::suite_seed(), RngDomain::Test, 300, 0);
  for (int i = 0; i < 4000; ++i) {
    Vec2 raster = uniform2(rng);
    if (i % 4 == 0) raster.x = (i / 4 % 7) / 7.0;  // on the edge between two pixels
    if (i % 5 == 0) raster.y = kOneMinusEpsilon;
    if (i % 7 == 0) raster = Vec2(kOneMinusEpsilon, 0);
    Film film(settings, -20);
    film.splat(raster, RGB(1, 2, 4), 0, uniform2(rng));
    const Image image = film.develop(1, std::vector<double>(Film::kGroups, 0.0));
    const int x = static_cast<int>(raster.x * 7), y = static_cast<int>(raster.y * 3);
    for (int p = 0; p < 21; ++p)
      for (int c = 0; c < 3; ++c)
        EXPECT_EQ(image.pixels[3 * p + c], p == 7 * y + x ? 21 * (1 << c) : 0) << i;
  }
}

}  // namespace
}  // namespace fogbow
