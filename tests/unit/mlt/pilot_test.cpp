// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/pilot.h"

#include <gtest/gtest.h>

#include <tuple>

#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

TEST(PictureImportance, SpreadsSamplesForTheLeastRelativeError) {
  const std::vector<double> luminance{8, 4, 2, 1, 0.5, 0};
  const PictureGrid grid{3, 2};
  const PictureImportance w(grid, luminance);
  double mean = 0;
  for (const double l : luminance) mean += l / 6;
  // Σ variance / (L² + d²), the variance of a pixel being L / w with Σ L w samples in all; d is
  // read off the black cell, which has w = 1/d in units of the mean.
  const double d = mean / w(grid.center(5));
  const auto error = [&](const auto& importance) {
    double samples = 0, sum = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      samples += luminance[i] * importance(i);
      sum += luminance[i] / importance(i) / (sqr(luminance[i]) + d * d);
    }
    return samples * sum;
  };
  const double best = error([&](std::size_t i) { return w(grid.center(i)); });
  for (std::size_t changed = 0; changed < 5; ++changed)
    for (const double factor : {0.9, 1.1})
      EXPECT_LT(best, error([&](std::size_t i) {
                  return w(grid.center(i)) * (i == changed ? factor : 1.0);
                }));
}

TEST(PictureImportance, HasNoUnitAndNoEdges) {
  const std::vector<double> luminance{8, 4, 2, 1, 0.5, 0};
  std::vector<double> brighter = luminance;
  for (double& l : brighter) l = std::ldexp(l, 40);
  const PictureGrid grid{3, 2};
  const PictureImportance a(grid, luminance), b(grid, brighter);
  for (const Vec2 raster : {Vec2(0, 0), Vec2(1, 1), Vec2(0.5, 0.2), Vec2(1, 0)})
    EXPECT_EQ(a(raster), b(raster));
  EXPECT_EQ(a(Vec2(1, 1)), a(grid.center(5)));
  EXPECT_EQ(PictureImportance(grid, std::vector<double>(6))(Vec2(0.3)), 1);
  EXPECT_EQ(kUniformImportance(Vec2(0.3)), 1);
}

/// A sample in the upper left quarter has luminance 3, one elsewhere 1; one in ten thousand
/// is a firefly in the lower right corner.
class KnownPicture final : public Estimator {
 public:
  const char* name() const override { return "known picture"; }
  void sample(SampleStream& light, SampleStream& eye, Workspace& w) const override {
    const double x = eye.next(), y = eye.next();
    w.contributions.clear();
    w.add({{x, y}, RGB(x < 0.5 && y < 0.5 ? 3 : 1), 3, 1, 2});
    if (light.next() < 1e-4) w.add({{0.97, 0.97}, RGB(1e6), 4, 3, 1});
  }
};

TEST(Pilot, LearnsThePictureAndNotItsFireflies) {
  const Pilot pilot = run_pilot(KnownPicture(), 2, 7, 1 << 14);
  const auto dark = pilot.importance(Vec2(0.75, 0.25)), lit = pilot.importance(Vec2(0.25, 0.25));
  // 1/√(1 + d²) to 1/√(9 + d²) with d some tenths.
  EXPECT_NEAR(dark / lit, 2.9, 0.45);
  EXPECT_GT(pilot.importance(Vec2(0.97, 0.97)), dark / 50);
  EXPECT_NEAR(pilot.techniques.at(3).at(1) / (1 << 14), 1.5, 0.05);
  EXPECT_GT(pilot.techniques.at(4).at(3), 0);
  EXPECT_GT(pilot.f_star, 0);
}

/// Of two halves, each as bright everywhere, to the rim.
class HalvedPicture final : public Estimator {
 public:
  HalvedPicture(double left, double right) : left_(left), right_(right) {}
  const char* name() const override { return "halved picture"; }
  void sample(SampleStream&, SampleStream& eye, Workspace& w) const override {
    const Vec2 raster = eye.next2();
    w.contributions.clear();
    w.add({raster, RGB(raster.x < 0.5 ? left_ : right_), 3, 1, 2});
  }

 private:
  double left_, right_;
};
const HalvedPicture kEven(2, 2);

TEST(Pilot, SeesNoRimInAnEvenPicture) {
  const Pilot pilot = run_pilot(kEven, 1, 7, 1 << 18);
  const double middle = pilot.importance(Vec2(0.5));
  for (const Vec2 raster : {Vec2(0, 0), Vec2(1, 1), Vec2(0, 0.5), Vec2(0.5, 1)})
    EXPECT_NEAR(pilot.importance(raster) / middle, 1, 0.05);
}

/// f* of a sample is its luminance times the importance of its place.
TEST(Pilot, KnowsTheMeanOfTheWeightedPicture) {
  const Pilot pilot = run_pilot(HalvedPicture(3, 1), 1, 7, 1 << 16);
  double expected = 0;
  constexpr int n = 256;
  for (int i = 0; i < n * n; ++i) {
    const Vec2 raster = (Vec2(i % n, i / n) + 0.5) / double(n);
    expected += (raster.x < 0.5 ? 3 : 1) * pilot.importance(raster) / (n * n);
  }
  EXPECT_NEAR(pilot.f_star / expected, 1, 0.02);
  EXPECT_LT(expected, 1.96);  // without the weights it were 2
}

/// Cells are squares, 64 along the longer side.
TEST(Pilot, HasAsManyCellsAcrossAsThePictureIsWide) {
  const auto steps = [](const PictureImportance& w, const Vec2& direction) {
    int n = 1;
    for (int i = 1; i < 4096; ++i)
      n += w(0.001 + (i + 0.5) / 4096 * direction) != w(0.001 + (i - 0.5) / 4096 * direction);
    return n;
  };
  for (const auto& [aspect, across, down] : {std::tuple(4.0, 64, 16), {0.5, 32, 64}}) {
    const PictureImportance w = run_pilot(kEven, aspect, 7, 1 << 14).importance;
    EXPECT_EQ(steps(w, {1, 0}), across);
    EXPECT_EQ(steps(w, {0, 1}), down);
  }
}

/// A picture that few samples know is looked at for longer.
TEST(Pilot, GoesOnUntilItKnowsEnough) {
  const auto samples = [](double least_effective) {
    double sum = 0;
    for (const auto& row : run_pilot(kEven, 1, 7, 1, least_effective).techniques)
      for (const double value : row) sum += value / 2;
    return sum;
  };
  EXPECT_DOUBLE_EQ(samples(0), 1024);
  EXPECT_DOUBLE_EQ(samples(1024), 1024);
  EXPECT_DOUBLE_EQ(samples(1025), 2048);
  EXPECT_DOUBLE_EQ(samples(1e9), 64 * 1024);
}

}  // namespace
}  // namespace fogbow
