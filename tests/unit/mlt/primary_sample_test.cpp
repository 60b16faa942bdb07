// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/primary_sample.h"

#include <gtest/gtest.h>

#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

/// The kernel as published: |offset| between 1/1024 and 1/64 with density ∝ 1/|offset|.
double kernel_density(double from, double to) {
  double offset = std::abs(to - from);
  offset = std::min(offset, 1 - offset);
  if (offset < 1.0 / 1024 || offset > 1.0 / 64) return 0;
  return 1 / (2 * offset * std::log(16.0));
}

TEST(PrimarySample, SmallStepsFollowTheSymmetricKernel) {
  constexpr int kSamples = 400000, kCells = 256;
  const double starts[] = {0.5, 0.003, 0.999};
  for (const double start : starts) {
    std::vector<std::uint64_t> counts(kCells);
    std::vector<double> expected(kCells);
    const auto cell_of = [&](double value) {
      double offset = value - start;
      offset -= std::round(offset);
      return std::clamp(static_cast<int>((offset * 32 + 1) * 0.5 * kCells), 0, kCells - 1);
    };
    Rng rng(testing::suite_seed(), RngDomain::Test, 6, 0);
    for (int i = 0; i < kSamples; ++i) {
      const double moved = perturb_primary_sample(start, rng.uniform());
      ASSERT_TRUE(moved >= 0 && moved < 1);
      ++counts[cell_of(moved)];
    }
    constexpr int kPoints = 2000;
    for (int cell = 0; cell < kCells; ++cell)
      for (int j = 0; j < kPoints; ++j) {
        const double offset = (2 * (cell + (j + 0.5) / kPoints) / kCells - 1) / 32;
        const double to = start + offset - std::floor(start + offset);
        expected[cell] += kSamples * kernel_density(start, to) / 16 / kCells / kPoints;
      }
    EXPECT_GT(testing::chi2_test(counts, expected), testing::sidak(testing::kSuiteFalseAlarm, 3));
  }
}

}  // namespace
}  // namespace fogbow
