// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/bootstrap.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

TEST(Bootstrap, StartsAreInProportionToLightAndInOrder) {
  constexpr int kSamples = 1100, kStarts = 1 << 15;  // more than a block of samples
  const Scene scene(testing::make_test_scene("glass-sphere-fog"));
  const auto bdpt = make_bdpt(scene, {.max_depth = 6, .seen_light = false});
  const Bootstrap bootstrap(*bdpt, testing::suite_seed(), kSamples);
  for (const int group : {0, Film::kGroups - 1}) {
    struct Start {
      double f_star;
      int k, count;
    };
    std::vector<Start> starts;
    for (int i = 0; i < kStarts; ++i) {
      const PrimarySample x = bootstrap.start(group, (i + 0.5) / kStarts);
      const Contribution& brightest = *std::ranges::max_element(
          x.contributions(), {}, [](const Contribution& c) { return luminance(c.value); });
      if (starts.empty() || x.f_star() != starts.back().f_star)
        starts.push_back({x.f_star(), brightest.k, 0});
      ++starts.back().count;
    }
    const double sum = bootstrap.normalization().b(group) * kSamples;
    for (const Start& s : starts)
      EXPECT_NEAR(s.count, s.f_star / sum * kStarts, 1 + 1e-9) << "f* " << s.f_star;
    EXPECT_TRUE(std::ranges::is_sorted(starts, {}, &Start::k));
    EXPECT_LT(starts.front().k, starts.back().k);
    EXPECT_GT(starts.size(), 100u);
  }
}

TEST(Bootstrap, GoesOnUntilItKnowsEnough) {
  constexpr std::uint64_t kSamples = 64;
  const Scene scene(testing::make_test_scene("glass-sphere-fog"));
  const auto bdpt = make_bdpt(scene, {.max_depth = 6, .seen_light = false});
  const auto run = [&](double least_effective) {
    return Bootstrap(
               *bdpt, 1, kSamples, kUniformImportance,
               [](const PrimarySample&, double) { return 1.0; }, least_effective)
        .normalization();
  };
  EXPECT_EQ(run(0).samples(), kSamples * Film::kGroups);
  const double least = 3 * run(0).effective_samples();
  const Normalization enough = run(least);
  EXPECT_GE(enough.effective_samples(), least);
  EXPECT_LE(enough.samples(), 16 * kSamples * Film::kGroups);
  // Not for ever.
  EXPECT_EQ(run(1e30).samples(), 64 * kSamples * Film::kGroups);
}

}  // namespace
}  // namespace fogbow
