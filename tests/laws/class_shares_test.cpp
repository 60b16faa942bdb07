// SPDX-License-Identifier: GPL-3.0-or-later
// b_k^c by the time that chains spend in each class equals what BDPT finds there.
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "core/util/parallel.h"
#include "mlt/render.h"
#include "tests/helpers/statistics.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

const bool kLong = std::getenv("FOGBOW_LONG") != nullptr;
const int kSamples = kLong ? 1 << 18 : 1 << 14;        // of BDPT, each replicate
const double kMutationsPerPixel = kLong ? 6400 : 400;  // each replicate; 16 × 16 pixels
constexpr int kReplicates = 16, kMaxDepth = 6;
/// Classes with less of the light are compared as one.
constexpr double kNotable = 0.02;

/// By configuration, replicate by replicate.
using Shares = std::map<std::string, std::vector<double>>;

void add(Shares& shares, const std::string& configuration, int replicate, double value) {
  auto& values = shares[configuration];
  values.resize(kReplicates);
  values[replicate] += value;
}

Shares by_bdpt(const Scene& scene) {
  const auto bdpt = make_bdpt(scene, {.max_depth = kMaxDepth});
  std::vector<Shares> parts(kReplicates);
  parallel_for(kReplicates, [&](std::int64_t r) {
    PrimarySample x;
    for (int i = 0; i < kSamples; ++i) {
      Rng rng(suite_seed(), RngDomain::Test, static_cast<std::uint64_t>(r), i);
      x.draw(*bdpt, rng);
      for (const Contribution& c : x.contributions()) {
        std::string text;
        for (const Vertex& v : assemble(scene, x.workspace().light, c.s, x.workspace().eye, c.t))
          text += v.in_medium() ? 'M' : 'S';
        add(parts[r], text, static_cast<int>(r), luminance(c.value) / kSamples);
      }
    }
  });
  Shares all;
  for (const Shares& part : parts)
    for (const auto& [configuration, values] : part)
      for (int r = 0; r < kReplicates; ++r) add(all, configuration, r, values[r]);
  return all;
}

Shares by_chains(const Scene& scene) {
  Shares all;
  RenderOptions options;
  options.integrator = "mlt";
  options.samples_per_pixel = kMutationsPerPixel;
  options.overrides = {{"max_depth", std::to_string(kMaxDepth)},
                       {"chains", "8"},
                       {"luminance_samples", std::to_string(kSamples)}};
  for (int r = 0; r < kReplicates; ++r) {
    options.seed = suite_seed() + 0x9E3779B97F4A7C15 * static_cast<std::uint64_t>(r + 1);
    for (const ClassShare& c : render(scene, options).classes)
      add(all, c.configuration, r, c.value);
  }
  return all;
}

class ClassShares : public ::testing::TestWithParam<TestScene> {};

TEST_P(ClassShares, ChainsSpendTheirTimeAsTheLightIsShared) {
  const Scene scene(GetParam().make());
  const Shares bdpt = by_bdpt(scene), chains = by_chains(scene);
  double b = 0;
  for (const auto& [configuration, values] : bdpt) b += estimate(values).mean;

  std::map<std::string, std::array<std::vector<double>, 2>> compared;
  const auto gather = [&](const Shares& shares, int side) {
    for (const auto& [configuration, values] : shares) {
      const auto known = bdpt.find(configuration);
      const bool notable = known != bdpt.end() && estimate(known->second).mean > kNotable * b;
      for (const std::string& name : {notable ? configuration : "the others", std::string("all")}) {
        auto& sums = compared[name][side];
        sums.resize(kReplicates);
        for (int r = 0; r < kReplicates; ++r) sums[r] += values[r];
      }
    }
  };
  gather(bdpt, 0);
  gather(chains, 1);
  const double level = sidak(kSuiteFalseAlarm, static_cast<int>(20 * test_scenes().size()));
  ASSERT_LE(compared.size(), 20u);
  for (const auto& [name, sides] : compared) {
    ASSERT_FALSE(sides[1].empty()) << name << " was never visited";
    const Estimate a = estimate(sides[0]), c = estimate(sides[1]);
    EXPECT_GT(welch(a, c), level) << name << ": BDPT " << a.mean << " ± " << a.standard_error
                                  << ", chains " << c.mean << " ± " << c.standard_error;
    std::printf("%-20s %-12s bdpt %.5g ± %.1g, ratio %.4f ± %.4f; finds a bias of 5%%: %.3f\n",
                GetParam().name.c_str(), name.c_str(), a.mean, a.standard_error, c.mean / a.mean,
                c.standard_error / a.mean, power(a, c, 0.05 * a.mean, level));
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, ClassShares, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace fogbow::testing
