// SPDX-License-Identifier: GPL-3.0-or-later
// The primary samples that an inverse says are distributed as those by which the technique made
// the path: numbers that the path leaves free are drawn from their law, not put anywhere in it.
#include <gtest/gtest.h>

#include <map>

#include "core/estimators/sampling.h"
#include "mlt/mutations/technique_sample.h"
#include "tests/helpers/statistics.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

constexpr int kMaxDepth = 6, kAttempts = 8000, kLeast = 100;

/// Uniform numbers, and which they were.
class Recorded final : public SampleStream {
 public:
  explicit Recorded(Rng& rng) : rng_(rng) {}
  double next() override { return numbers.emplace_back(rng_.uniform()); }
  std::vector<double> numbers;

 private:
  Rng& rng_;
};

class InverseLaw : public ::testing::TestWithParam<TestScene> {};

TEST_P(InverseLaw, NumbersAreThoseThatTechniquesUse) {
  const Scene scene(GetParam().make());
  const PathPopulation population(scene, kMaxDepth, suite_seed());
  PathSample y = population.blank();
  // By technique and place in the stream: used, and said by the inverse.
  std::map<std::array<int, 3>, std::array<std::vector<double>, 2>> samples;
  std::vector<double> said;
  for (int k = 2; k <= kMaxDepth + 1; ++k)
    for (int s = 0; s < k; ++s)
      for (int i = 0; i < kAttempts; ++i) {
        Rng rng(suite_seed(), RngDomain::Test, static_cast<std::uint64_t>(16 * k + s),
                static_cast<std::uint64_t>(i));
        Recorded used(rng);
        if (sample_technique(s, k - s, used, y)) continue;
        if (!invert_technique(scene, y.path(), s, rng, said)) continue;
        ASSERT_GE(used.numbers.size(), said.size());
        for (std::size_t j = 0; j < said.size(); ++j) {
          auto& [of_use, of_inverse] = samples[{k, s, static_cast<int>(j)}];
          of_use.push_back(used.numbers[j]);
          of_inverse.push_back(said[j]);
        }
      }
  std::erase_if(samples, [](const auto& entry) { return entry.second[0].size() < kLeast; });
  ASSERT_GT(samples.size(), 20u);
  // The two are not independent where the path fixes a number: that makes the test the milder.
  const double level = sidak(kSuiteFalseAlarm, static_cast<int>(16 * samples.size()));
  for (const auto& [place, both] : samples) {
    const auto [k, s, j] = place;
    EXPECT_GT(two_sample_ks_test(both[0], both[1]), level)
        << "k = " << k << ", s = " << s << ", number " << j << " of " << both[0].size() << " paths";
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, InverseLaw, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace fogbow::testing
