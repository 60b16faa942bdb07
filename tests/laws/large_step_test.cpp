// SPDX-License-Identifier: GPL-3.0-or-later
// f*/T over large steps integrates f* as BDPT does, for every class of paths and wherever else one
// looks.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

const int kSamples = std::getenv("FOGBOW_LONG") ? 1 << 21 : 1 << 17;
constexpr int kMaxDepth = 7;
/// Below, the mean of so skewed a thing is not normal.
constexpr int kLeastEvents = 50;

/// Σ and Σ² of one feature over independent samples.
struct Moments {
  double sum = 0, squares = 0;
  int events = 0;
  void add(double v) {
    sum += v;
    squares += v * v;
    events += v != 0;
  }
  double mean() const { return sum / kSamples; }
  double variance() const { return (squares / kSamples - sqr(mean())) / kSamples; }
};

class LargeStep : public ::testing::TestWithParam<TestScene> {};

TEST_P(LargeStep, EstimatesWhatBdptEstimates) {
  const Scene scene(GetParam().make());
  const PathPopulation population(scene, kMaxDepth, suite_seed());
  const auto features = path_features(scene);
  const auto table =
      make_path_mutations({{"large_step", 1}}, population.techniques(), population.max_vertices());
  std::vector<Moments> bdpt(features.size()), large(features.size());
  std::vector<PathSample> parts;
  PathSample y = population.blank();
  std::optional<PathSample> x;  // large steps do not depend on it
  for (int sample = 0; sample < kSamples; ++sample) {
    population.draw(static_cast<std::uint64_t>(sample), 1, parts);
    if (!x && !parts.empty()) x = parts.front();
    if (!x) continue;
    Rng rng(suite_seed(), RngDomain::Chain, sample, 0);
    const Proposal proposal = table[0]->propose(*x, y, rng);
    const double weight =
        proposal.rejection ? 0.0 : std::exp(y.log_f_star() - proposal.log_density);
    for (std::size_t i = 0; i < features.size(); ++i) {
      double sum = 0;
      for (const PathSample& part : parts) sum += features[i].value(part.path());
      bdpt[i].add(sum * population.mean_f_star());
      large[i].add(weight > 0 ? weight * features[i].value(y.path()) : 0.0);
    }
  }
  const double level =
      sidak(kSuiteFalseAlarm, static_cast<int>(test_scenes().size() * features.size()));
  for (std::size_t i = 0; i < features.size(); ++i) {
    if (std::min(bdpt[i].events, large[i].events) < kLeastEvents) continue;
    const double z =
        (large[i].mean() - bdpt[i].mean()) / std::sqrt(large[i].variance() + bdpt[i].variance());
    EXPECT_GT(p_value_normal(z), level) << features[i].name << ": large steps " << large[i].mean()
                                        << ", BDPT " << bdpt[i].mean() << ", z = " << z;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, LargeStep, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace fogbow::testing
