// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/compare.h"

#include <gtest/gtest.h>

#include "core/math/random.h"
#include "core/util/error.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

Image constant(int width, int height, const RGB& value,
               std::vector<std::string> names = {"R", "G", "B"}) {
  Image image(width, height, std::move(names));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y, image.channel(std::string(1, "RGB"[c]))) = static_cast<float>(value[c]);
  return image;
}

ErrorKind kind_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorKind::Usage;
}

TEST(Compare, EqualImagesDifferInNothing) {
  const Image image = constant(33, 17, RGB(0.5, 2, 0));
  const auto r = compare_images(image, image);
  EXPECT_EQ(r.pixels, 33 * 17);
  EXPECT_EQ(r.mse, 0);
  EXPECT_EQ(r.rel_mse, 0);
  EXPECT_EQ(r.mean_ratio.x, 1);
  EXPECT_EQ(r.luminance_ratio, 1);
  EXPECT_FALSE(r.has_errors);
  ASSERT_EQ(r.tiles.size(), 6u);
  EXPECT_EQ(r.tiles[5].area.x, 32);
  EXPECT_EQ(r.tiles[5].area.width, 1);
  EXPECT_EQ(r.tiles[5].area.height, 1);
  std::int64_t pixels = 0;
  for (const auto& tile : r.tiles) pixels += tile.pixels;
  EXPECT_EQ(pixels, r.pixels);
}

TEST(Compare, ErrorsOfTwoPixelsByHand) {
  Image reference = constant(2, 1, RGB(1)), image = constant(2, 1, RGB(1.5));
  for (int c = 0; c < 3; ++c) reference.at(1, 0, c) = 3;
  image.at(1, 0, 2) = 7;  // pixels: 1.5 1.5 1.5 against 1, and 1.5 1.5 7 against 3
  const auto r = compare_images(image, reference);
  EXPECT_NEAR(r.mse, (3 * 0.25 + 2 * 2.25 + 16) / 6, 1e-12);
  const double epsilon = 0.01 * 4;  // the reference's mean luminance is 2
  EXPECT_NEAR(r.rel_mse_epsilon, epsilon, 1e-12);
  EXPECT_NEAR(r.rel_mse, (3 * 0.25 / (1 + epsilon) + (2 * 2.25 + 16) / (9 + epsilon)) / 6, 1e-12);
  EXPECT_NEAR(r.mean_ratio.x, 0.75, 1e-12);
  EXPECT_NEAR(r.mean_ratio.z, 4.25 / 2, 1e-12);
  EXPECT_NEAR(r.luminance_ratio, luminance(RGB(1.5, 1.5, 4.25)) / 2, 1e-12);
}

TEST(Compare, ExcludedPixelsDoNotCount) {
  const Image reference = constant(40, 40, RGB(1));
  Image image = reference;
  for (int y = 10; y < 20; ++y)
    for (int x = 3; x < 9; ++x) image.at(x, y, 1) = std::numeric_limits<float>::quiet_NaN();
  ComparisonOptions options;
  options.exclude = {{3, 10, 6, 4}, {-5, 14, 14, 6}};
  const auto r = compare_images(image, reference, options);
  EXPECT_EQ(r.pixels, 1600 - 24 - 54);
  EXPECT_EQ(r.non_finite_image, 0);
  EXPECT_EQ(r.mse, 0);
  options.exclude = {{0, 0, 40, 40}};
  EXPECT_EQ(kind_of([&] { compare_images(image, reference, options); }), ErrorKind::InputOutput);
}

TEST(Compare, PixelsThatAreNotFiniteAreRefusedOrCounted) {
  Image reference = constant(8, 8, RGB(1)), image = reference;
  image.at(2, 3, 0) = std::numeric_limits<float>::infinity();
  image.at(5, 3, 2) = std::numeric_limits<float>::quiet_NaN();
  reference.at(5, 3, 1) = -std::numeric_limits<float>::infinity();
  try {
    compare_images(image, reference);
    ADD_FAILURE() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Numerical);
    EXPECT_NE(std::string(error.what()).find("2,3"), std::string::npos) << error.what();
  }
  ComparisonOptions options;
  options.skip_non_finite = true;
  const auto r = compare_images(image, reference, options);
  EXPECT_EQ(r.non_finite_image, 2);
  EXPECT_EQ(r.non_finite_reference, 1);
  EXPECT_EQ(r.pixels, 62);
  EXPECT_EQ(r.mse, 0);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  const Image image = constant(4, 4, RGB(1));
  EXPECT_EQ(kind_of([&] { compare_images(image, constant(4, 5, RGB(1))); }),
            ErrorKind::InputOutput);
  EXPECT_EQ(kind_of([&] { compare_images(Image(4, 4, {"Y"}), image); }), ErrorKind::InputOutput);
  const Image small = constant(2, 2, RGB(1));
  ComparisonOptions options;
  options.reference_error = &small;
  EXPECT_EQ(kind_of([&] { compare_images(image, image, options); }), ErrorKind::InputOutput);
}

/// Noise of known standard deviation, different on both sides, claimed correctly: z-scores must be
/// standard normal.
struct Noisy {
  Image image, reference, reference_error;
};
Noisy noisy_pair(std::uint64_t stream, double claimed) {
  constexpr int kSide = 160;
  Noisy n{constant(kSide, kSide, RGB(1), {"R", "G", "B", "Error.R", "Error.G", "Error.B"}),
          constant(kSide, kSide, RGB(1)), constant(kSide, kSide, RGB(0.05 * claimed))};
  Rng rng(testing::suite_seed(), RngDomain::Test, 600, stream);
  const auto noise = [&](double sigma) {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += rng.uniform();
    return sigma * sum;
  };
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double a = noise(0.1), b = noise(0.05);
      for (int c = 0; c < 3; ++c) {
        n.image.at(x, y, c) += static_cast<float>(a);
        n.image.at(x, y, 3 + c) = static_cast<float>(0.1 * claimed);
        n.reference.at(x, y, c) += static_cast<float>(b);
      }
    }
  return n;
}

TEST(Compare, TileScoresAreStandardNormalWhereErrorsAreTrue) {
  const Noisy n = noisy_pair(0, 1);
  ComparisonOptions options;
  options.tile_size = 5;
  options.reference_error = &n.reference_error;
  const auto r = compare_images(n.image, n.reference, options);
  EXPECT_TRUE(r.has_errors);
  ASSERT_EQ(r.tested_tiles, 1024);
  EXPECT_NEAR(r.tiles[7].standard_error, std::hypot(0.1, 0.05) / 5, 1e-6);
  const double level = testing::sidak(testing::kSuiteFalseAlarm, 3);
  EXPECT_GT(testing::p_value_chi2(r.chi2, 1024), level);
  EXPECT_GT(1 - testing::p_value_chi2(r.chi2, 1024), level);
  const double sigma_2 = std::sqrt(0.0455 * 0.9545 / 1024);
  EXPECT_GT(testing::p_value_normal((r.fraction_above_2 - 0.0455) / sigma_2), level);
  EXPECT_LT(r.fraction_above_3, 0.02);
  EXPECT_NEAR(r.luminance_ratio_error, std::hypot(0.1, 0.05) / 160, 1e-5);
  EXPECT_LT(std::fabs(r.luminance_ratio - 1) / r.luminance_ratio_error, 5);
}

/// Pixels by chains share the error of b, which the render knows and no pixel's error tells.
TEST(Compare, MeansAreNoSurerThanB) {
  Noisy n = noisy_pair(0, 1);
  ComparisonOptions options;
  options.reference_error = &n.reference_error;
  const double mean = compare_images(n.image, n.reference, options).luminance_ratio;
  const double of_pixels = compare_images(n.image, n.reference, options).luminance_ratio_error;
  n.image.metadata["b"] = 5.0f;
  n.image.metadata["bStandardError"] = 0.1f;
  const double with_b = compare_images(n.image, n.reference, options).luminance_ratio_error;
  EXPECT_NEAR(with_b, std::hypot(0.02 * mean, of_pixels * 0.05 / std::hypot(0.1, 0.05)), 2e-5);
  n.image.metadata["bStandardError"] = 1e-9f;
  EXPECT_EQ(compare_images(n.image, n.reference, options).luminance_ratio_error, of_pixels);
}

/// 2 ± 0.3 against 1 ± 0.1 in five pixels of a tile of six.
TEST(Compare, StandardErrorsByHand) {
  const std::vector<std::string> names{"R", "G", "B", "Error.R", "Error.G", "Error.B"};
  Image image = constant(3, 2, RGB(2), names), reference = constant(3, 2, RGB(1), names);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 3; ++x)
      for (int c = 3; c < 6; ++c) {
        image.at(x, y, c) = 0.3f;
        reference.at(x, y, c) = 0.1f;
      }
  ComparisonOptions options;
  options.exclude = {{1, 1, 1, 1}};
  const auto r = compare_images(image, reference, options);
  ASSERT_EQ(r.tiles.size(), 1u);
  EXPECT_NEAR(r.tiles[0].standard_error, std::sqrt(5 * (0.09 + 0.01)) / 5, 1e-7);
  EXPECT_NEAR(r.tiles[0].z, 1 / r.tiles[0].standard_error, 1e-6);
  EXPECT_NEAR(r.luminance_ratio_error, std::sqrt((0.09 + 4 * 0.01) / 5), 1e-7);
}

TEST(Compare, UnderstatedErrorsAreFound) {
  const Noisy n = noisy_pair(1, 0.7);
  ComparisonOptions options;
  options.tile_size = 5;
  options.reference_error = &n.reference_error;
  const auto r = compare_images(n.image, n.reference, options);
  EXPECT_LT(testing::p_value_chi2(r.chi2, 1024), 1e-12);
  EXPECT_GT(r.fraction_above_2, 0.1);
}

TEST(Compare, AFivePercentTileIsTheWorst) {
  Noisy n = noisy_pair(2, 1);
  for (int y = 20; y < 40; ++y)
    for (int x = 60; x < 80; ++x)
      for (int c = 0; c < 3; ++c) n.image.at(x, y, c) *= 1.05f;
  ComparisonOptions options;
  options.tile_size = 20;
  options.reference_error = &n.reference_error;
  const auto r = compare_images(n.image, n.reference, options);
  const auto worst = worst_tiles(r, 3);
  ASSERT_EQ(worst.size(), 3u);
  EXPECT_EQ(worst[0], 8u + 3u);
  EXPECT_GT(r.tiles[worst[0]].z, 5);
  EXPECT_EQ(r.max_abs_z, r.tiles[worst[0]].z);
  EXPECT_GE(std::fabs(r.tiles[worst[1]].z), std::fabs(r.tiles[worst[2]].z));
}

TEST(Compare, DifferencesWithoutAnyErrorAreUnexplained) {
  const Image reference =
      constant(16, 16, RGB(1), {"R", "G", "B", "Error.R", "Error.G", "Error.B"});
  Image image = reference;
  image.at(9, 9, 0) = 2;
  ComparisonOptions options;
  options.tile_size = 8;
  const auto r = compare_images(image, reference, options);
  EXPECT_TRUE(r.has_errors);
  EXPECT_EQ(r.tested_tiles, 0);
  EXPECT_EQ(r.unexplained_tiles, 1);
  EXPECT_EQ(worst_tiles(r, 1).at(0), 3u);
}

TEST(Compare, DifferenceImages) {
  Image reference = constant(3, 1, RGB(1)), image = reference;
  image.at(0, 0, 0) = 3;
  for (int c = 0; c < 3; ++c) image.at(2, 0, c) = 0.5f;
  image.x = 5;
  image.y = 7;
  image.full_width = 20;
  image.full_height = 30;
  const Image raw = difference_image(image, reference, DifferenceStyle::Signed);
  EXPECT_EQ((std::array{raw.x, raw.y, raw.full_width, raw.full_height}),
            (std::array{5, 7, 20, 30}));
  EXPECT_EQ(raw.at(0, 0, 0), 2);
  EXPECT_EQ(raw.at(0, 0, 1), 0);
  EXPECT_EQ(raw.at(2, 0, 2), -0.5f);
  const Image color = difference_image(image, reference, DifferenceStyle::FalseColor, 0.25);
  EXPECT_EQ(color.at(0, 0, 0), 1);
  EXPECT_LT(color.at(0, 0, 1), 1);
  EXPECT_EQ(color.at(1, 0, 0), 1);
  EXPECT_EQ(color.at(1, 0, 2), 1);
  EXPECT_EQ(color.at(2, 0, 0), 0);
  EXPECT_EQ(color.at(2, 0, 2), 1);
  image.at(1, 0, 1) = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(
      std::isnan(difference_image(image, reference, DifferenceStyle::FalseColor).at(1, 0, 0)));
}

/// Without errors the worst tile is that of the largest difference in parts of the reference, and
/// in the dark of a tenth of the mean, which is also the floor of false colours.
TEST(Compare, DifferencesAreRelativeToThePicture) {
  Image reference(3, 1, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) {
    reference.at(0, 0, c) = 10;
    reference.at(1, 0, c) = 2;
  }
  Image image = reference;  // off by 0.6/10.08, by 0.3/2.04 and by 0.1/0.4
  for (int c = 0; c < 3; ++c) {
    image.at(0, 0, c) += 0.6f;
    image.at(1, 0, c) += 0.3f;
    image.at(2, 0, c) += 0.1f;
  }
  ComparisonOptions options;
  options.tile_size = 1;
  EXPECT_EQ(worst_tiles(compare_images(image, reference, options), 3),
            (std::vector<std::size_t>{2, 1, 0}));
  const Image color = difference_image(image, reference, DifferenceStyle::FalseColor, 1);
  EXPECT_NEAR(color.at(2, 0, 1), 1 - 0.1 / 0.4, 1e-5);
  EXPECT_NEAR(color.at(1, 0, 1), 1 - 0.3 / std::hypot(2, 0.4), 1e-5);
}

}  // namespace
}  // namespace fogbow
