// SPDX-License-Identifier: GPL-3.0-or-later
// Independent runs of chains against independent samples: not only near each other, but apart by
// what the runs say that they may be (validation 9 of the design).
#include <gtest/gtest.h>

#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>

#include "mlt/render.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

constexpr int kRuns = 40;
constexpr int kDegreesOfFreedom = Film::kGroups - 1;
constexpr int kTests = 2 * 2 * 5;  // both kinds, two scenes, at most five quantities each

/// The standard normal value as far out as Student's t.
double normal_score(double t) {
  const boost::math::students_t student(kDegreesOfFreedom);
  const boost::math::normal normal;
  const double tail = boost::math::cdf(boost::math::complement(student, std::fabs(t)));
  return std::copysign(boost::math::quantile(boost::math::complement(normal, tail)), t);
}

RenderOptions options(const char* integrator, double samples_per_pixel, std::uint64_t seed) {
  RenderOptions o;
  o.integrator = integrator;
  o.samples_per_pixel = samples_per_pixel;
  o.seed = seed;
  o.overrides = {{"max_depth", "5"}};
  return o;
}

double share(const RenderResult& r, int k) {
  for (const ClassShare& c : r.lengths)
    if (c.k == k) return c.value;
  return 0;
}

class Chains : public ::testing::TestWithParam<const char*> {};

TEST_P(Chains, ScoresOfIndependentRunsAreStandardNormal) {
  const Scene scene(testing::make_test_scene(GetParam()));
  // Its error is the same in all scores: it must be small against that of one run.
  const RenderResult reference = render(scene, options("bdpt", 2000, testing::suite_seed()));
  std::vector<RenderResult> runs;
  for (int i = 0; i < kRuns; ++i) {
    RenderOptions o = options("pssmlt", 100, testing::suite_seed() + 1 + i);
    o.overrides.insert(o.overrides.end(), {{"chains", "4"}, {"luminance_samples", "8192"}});
    runs.push_back(render(scene, o));
    EXPECT_LT(runs.back().diagnostics.at("R_hat"), 1.2);
    EXPECT_GT(runs.back().diagnostics.at("ess"), 100);
  }
  int quantities = 0;
  const auto test = [&](const std::string& what, auto&& value, auto&& error) {
    double chi2 = 0, sum = 0;
    for (const RenderResult& run : runs) {
      const double z =
          normal_score((value(run) - value(reference)) / std::hypot(error(run), error(reference)));
      chi2 += z * z;
      sum += z;
    }
    const double level = testing::sidak(testing::kSuiteFalseAlarm, kTests);
    EXPECT_GT(testing::p_value_normal(sum / std::sqrt(kRuns)), level) << what;
    // Wrong on either side: errors that are stated too small, or too large.
    const double p = testing::p_value_chi2(chi2, kRuns);
    EXPECT_GT(std::min(p, 1 - p), level / 2) << what << ": mean z² is " << chi2 / kRuns;
    std::printf("%s, %s: mean z %.3f, mean z² %.3f over %d runs\n", GetParam(), what.c_str(),
                sum / kRuns, chi2 / kRuns, kRuns);
    ++quantities;
  };
  test(
      "b", [](const RenderResult& r) { return r.b; },
      [](const RenderResult& r) { return r.b_stderr; });
  for (const int k : {3, 4, 5})
    test(
        "k = " + std::to_string(k), [k](const RenderResult& r) { return share(r, k); },
        [k](const RenderResult& r) {
          for (const ClassShare& c : r.lengths)
            if (c.k == k) return c.standard_error;
          return 0.0;
        });
  EXPECT_LE(2 * 2 * quantities, kTests);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Chains, ::testing::Values("floor-fog", "nested-media"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace fogbow
