// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/film.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>

#include "core/math/random.h"
#include "core/util/error.h"
#include "core/util/parallel.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

const std::vector<double> kEqualGroups(Film::kGroups, 8.0);
const std::vector<double> kNoGroups(Film::kGroups, 0.0);

FilmSettings settings(int width, int height, std::shared_ptr<const ReconstructionFilter> filter) {
  FilmSettings s;
  s.width = width;
  s.height = height;
  s.filter = std::move(filter);
  return s;
}
FilmSettings box_film(int width, int height) { return settings(width, height, make_box_filter()); }

ErrorKind kind_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.kind();
  }
  ADD_FAILURE() << "nothing was thrown";
  return ErrorKind::Usage;
}

struct Splat {
  Vec2 raster;
  RGB value;
  int group;
  Vec2 u;
};

std::vector<Splat> random_splats(int count, std::uint64_t stream) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 400, stream);
  std::vector<Splat> splats(count);
  for (Splat& s : splats) {
    s.raster = uniform2(rng);
    s.value = uniform3(rng) * 3.0 - RGB(0.2);
    s.group = static_cast<int>(rng.uniform() * Film::kGroups);
    s.u = uniform2(rng);
  }
  return splats;
}

std::string bytes(const Film& film) {
  std::ostringstream out;
  film.serialize(out);
  return out.str();
}

TEST(Film, SumsDoNotDependOnOrderOrThreads) {
  const auto splats = random_splats(20000, 0);
  const auto count = static_cast<std::int64_t>(splats.size());
  const auto take = [&](Film& film, std::int64_t i) {
    film.splat(splats[i].raster, splats[i].value, splats[i].group, splats[i].u);
  };
  Film forward(settings(13, 9, make_gaussian_filter()), -40);
  for (std::int64_t i = 0; i < count; ++i) take(forward, i);
  Film backward(forward.settings(), -40);
  for (std::int64_t i = count; i-- > 0;) take(backward, i);
  Film threaded(forward.settings(), -40);
  ThreadLimit limit(3);
  parallel_for(count, [&](std::int64_t i) { take(threaded, i); });
  Film first(forward.settings(), -40), second(forward.settings(), -40);
  for (std::int64_t i = 0; i < count; ++i) take(i % 3 ? first : second, i);
  first.add(second);
  EXPECT_EQ(bytes(forward), bytes(backward));
  EXPECT_EQ(bytes(forward), bytes(threaded));
  EXPECT_EQ(bytes(forward), bytes(first));
}

TEST(Film, ScalesExactlyByPowersOfTwo) {
  const auto splats = random_splats(5000, 1);
  const std::vector<double> groups{8, 8, 9, 7, 8, 8.5, 7.5, 8};
  for (const int k : {-30, -1, 1, 30}) {
    Film a(settings(6, 5, make_tent_filter()), -30), b(a.settings(), -30 + k);
    for (const Splat& s : splats) {
      a.splat(s.raster, s.value, s.group, s.u);
      b.splat(s.raster, std::ldexp(1.0, k) * s.value, s.group, s.u);
    }
    const Image image_a = a.develop(1e-3, groups), image_b = b.develop(1e-3, groups);
    std::vector<double> scaled = groups;
    for (double& g : scaled) g = std::ldexp(g, k);
    const Image image_c = a.develop(std::ldexp(1e-3, k), scaled);
    for (std::size_t i = 0; i < image_a.pixels.size(); ++i) {
      EXPECT_EQ(image_b.pixels[i], std::ldexp(image_a.pixels[i], k));
      EXPECT_EQ(image_c.pixels[i], std::ldexp(image_a.pixels[i], k));
    }
    // The counts themselves: streams differ in the unit and the checksum alone.
    std::string bytes_a = bytes(a), bytes_b = bytes(b);
    ASSERT_EQ(bytes_a.size(), bytes_b.size());
    const std::size_t counts = 8 * 11 * 30 + 8;  // 11 counts a pixel, and the checksum
    EXPECT_EQ(bytes_a.substr(bytes_a.size() - counts, counts - 8),
              bytes_b.substr(bytes_b.size() - counts, counts - 8));
  }
}

TEST(Film, OverflowIsAnErrorAndNeverAWrap) {
  const double quarter = 0x1p61;
  for (const double sign : {1.0, -1.0}) {
    Film film(box_film(1, 1), 0);
    // Two channels stay at zero: each channel is watched on its own.
    const auto splat = [&](double v) { film.splat(Vec2(0), RGB(0, sign * v, 0), 0, Vec2(0)); };
    EXPECT_EQ(kind_of([&] { splat(0x1p62); }), ErrorKind::Numerical);
    EXPECT_EQ(kind_of([&] { splat(1e300); }), ErrorKind::Numerical);
    Film half(box_film(1, 1), 0);
    for (int i = 0; i < 3; ++i) {
      splat(quarter);
      half.splat(Vec2(0), RGB(0, sign * quarter, 0), 0, Vec2(0));
    }
    const Image image = film.develop(1, kNoGroups);
    EXPECT_EQ(image.at(0, 0, 1), static_cast<float>(sign * 3 * quarter));
    EXPECT_EQ(kind_of([&] { splat(1.01 * quarter); }), ErrorKind::Numerical);
    Film sum(box_film(1, 1), 0);
    sum.add(half);
    EXPECT_EQ(kind_of([&] { sum.add(half); }), ErrorKind::Numerical);
  }
}

TEST(Film, TinyUnitsMakeLargeSplatsOverflow) {
  Film film(box_film(1, 1), -60);
  film.splat(Vec2(0), RGB(3.9), 0, Vec2(0));
  EXPECT_EQ(kind_of([&] { film.splat(Vec2(0), RGB(4), 0, Vec2(0)); }), ErrorKind::Numerical);
}

TEST(Film, RefusesAndCountsWhatIsNotFinite) {
  Film film(box_film(2, 2), -20);
  const double bad[] = {std::nan(""), kInfinity, -kInfinity};
  std::uint64_t refused = 0;
  for (const double value : bad) {
    for (int c = 0; c < 3; ++c) {
      RGB rgb(1);
      rgb[c] = value;
      film.splat(Vec2(0.5), rgb, 0, Vec2(0));
      EXPECT_EQ(film.refused(), ++refused);
    }
    film.splat(Vec2(value, 0.5), RGB(1), 0, Vec2(0));
    EXPECT_EQ(film.refused(), ++refused);
  }
  for (const float pixel : film.develop(1, kNoGroups).pixels) EXPECT_EQ(pixel, 0);
  Film other(box_film(2, 2), -20);
  other.add(film);
  EXPECT_EQ(other.refused(), refused);
  const Film moved = std::move(other);
  EXPECT_EQ(moved.refused(), refused);
}

/// Sums of one filter are none of another, though it reaches as far.
TEST(Film, AddsOnlyWhatHasItsFilter) {
  Film box(settings(2, 2, make_box_filter(1)), -20);
  const Film same(settings(2, 2, make_box_filter(1)), -20),
      tent(settings(2, 2, make_tent_filter(1)), -20);
  EXPECT_NO_THROW(box.add(same));
  EXPECT_THROW(box.add(tent), Error);
}

TEST(Film, DevelopsMeansAndTheWindowOfACrop) {
  FilmSettings s = box_film(20, 10);
  s.crop_x = 4;
  s.crop_y = 3;
  s.crop_width = 2;
  s.crop_height = 5;
  Film film(s, -30);
  film.splat(Vec2(0.75, 0.9), RGB(1, 2, 3), 5, Vec2(0.5));
  film.splat(Vec2(0.6, 0.85), RGB(1, 0, -1), 1, Vec2(0.5));
  const Image image = film.develop(0.25, kNoGroups);
  EXPECT_EQ(image.x, 4);
  EXPECT_EQ(image.y, 3);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 5);
  EXPECT_EQ(image.full_width, 20);
  EXPECT_EQ(image.full_height, 10);
  EXPECT_EQ(image.at(1, 4, 0), 10 * 0.25 * 2);
  EXPECT_EQ(image.at(1, 4, 1), 10 * 0.25 * 2);
  EXPECT_EQ(image.at(1, 4, 2), 10 * 0.25 * 2);
  EXPECT_EQ(image.at(0, 0, 0), 0);
}

TEST(Film, ErrorLayerIsTheStandardErrorBetweenGroups) {
  Film film(box_film(1, 1), -40);
  const std::array<double, Film::kGroups> values{1, 2, 4, 3, 2.5, 1.5, 3.5, 2};
  double mean = 0, squares = 0;
  for (int g = 0; g < Film::kGroups; ++g) {
    film.splat(Vec2(0.5), values[g] * RGB(2, 1, 0.5), g, Vec2(0));
    mean += values[g] / Film::kGroups;
  }
  for (const double v : values) squares += sqr(v - mean);
  const double error = std::sqrt(squares / (8 * 7)) * luminance(RGB(2, 1, 0.5));
  const Image image = film.develop(1.0 / 8, std::vector<double>(Film::kGroups, 1.0));
  ASSERT_EQ(image.channels.size(), 6u);
  const int r = image.channel("Error.R"), b = image.channel("Error.B");
  const double y = luminance(RGB(2, 1, 0.5));
  EXPECT_NEAR(image.at(0, 0, r), error * 2 / y, 1e-6);
  EXPECT_NEAR(image.at(0, 0, b), error * 0.5 / y, 1e-6);
  EXPECT_EQ(film.develop(1, kNoGroups).channels.size(), 3u);
  std::vector<double> one = kNoGroups;
  one[3] = 1;
  EXPECT_EQ(film.develop(1, one).channels.size(), 3u);
}

/// Groups of unequal size: the squared error layer is, on average over pixels, the true squared
/// deviation.
TEST(Film, ErrorLayerIsCalibratedForUnequalGroups) {
  constexpr int kSide = 48, kReplicates = 16;
  const std::array<int, Film::kGroups> samples{10, 20, 30, 10, 20, 30, 40, 0};
  int total = 0;
  for (const int n : samples) total += n;
  std::vector<double> difference;
  for (int r = 0; r < kReplicates; ++r) {
    Film film(box_film(kSide, kSide), -40);
    Rng rng(testing::suite_seed(), RngDomain::Test, 401, r);
    std::vector<double> group_scale(Film::kGroups);
    for (int g = 0; g < Film::kGroups; ++g) {
      if (samples[g] > 0) group_scale[g] = 1.0 / (kSide * kSide * samples[g]);
      for (int i = 0; i < samples[g] * kSide * kSide; ++i) {
        const int p = i % (kSide * kSide);
        const Vec2 raster((p % kSide + 0.5) / kSide, (p / kSide + 0.5) / kSide);
        film.splat(raster, RGB(2 * rng.uniform()), g, Vec2(0));
      }
    }
    const Image image = film.develop(1.0 / (kSide * kSide * total), group_scale);
    const int e = image.channel("Error.G");
    double claimed = 0;
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) claimed += sqr(image.at(x, y, e));
    // The variance of a uniform value on [0, 2] is 1/3.
    difference.push_back(claimed / (kSide * kSide) * 3 * total - 1);
  }
  const auto estimate = testing::estimate(difference);
  EXPECT_LT(estimate.standard_error, 0.005);
  EXPECT_GT(testing::compare(estimate, 0), testing::kSuiteFalseAlarm)
      << estimate.mean << " +- " << estimate.standard_error;
}

TEST(Film, RefusesImpossibleSettingsAndSums) {
  for (FilmSettings s : {box_film(0, 4), box_film(4, -1), box_film(1 << 30, 2)})
    EXPECT_EQ(kind_of([&] { Film(s, 0); }), ErrorKind::Usage);
  FilmSettings outside = box_film(8, 8);
  outside.crop_x = 5;
  outside.crop_width = 4;
  outside.crop_height = 2;
  EXPECT_EQ(kind_of([&] { Film(outside, 0); }), ErrorKind::Usage);
  EXPECT_EQ(kind_of([&] { Film(box_film(2, 2), 5000); }), ErrorKind::Usage);
  EXPECT_EQ(kind_of([&] { Film(settings(4, 4, make_box_filter(1000)), 0); }), ErrorKind::Usage);
  Film film(box_film(4, 4), -20);
  EXPECT_EQ(kind_of([&] { film.add(Film(box_film(4, 5), -20)); }), ErrorKind::Usage);
  EXPECT_EQ(kind_of([&] { film.add(Film(box_film(4, 4), -21)); }), ErrorKind::Usage);
  EXPECT_EQ(kind_of([&] { film.add(Film(settings(4, 4, make_tent_filter()), -20)); }),
            ErrorKind::Usage);
}

TEST(Film, PixelsBeyondSinglePrecisionAreAnError) {
  Film film(box_film(1, 1), 0);
  film.splat(Vec2(0), RGB(0x1p61), 0, Vec2(0));
  EXPECT_EQ(kind_of([&] { film.develop(1e30, kNoGroups); }), ErrorKind::Numerical);
}

TEST(Film, TellsItsMemory) {
  const Film film(box_film(300, 200), -20);
  EXPECT_GE(Film::memory_bytes(film.settings()), 300u * 200 * 11 * 8);
  EXPECT_LE(Film::memory_bytes(film.settings()), 300u * 200 * 11 * 8 + 500 * 8 + 1024);
}

}  // namespace
}  // namespace fogbow
