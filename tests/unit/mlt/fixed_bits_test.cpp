// SPDX-License-Identifier: GPL-3.0-or-later
// One seed, one picture: for any number of threads, and for a run that time has ended and one of
// the same count.
#include <gtest/gtest.h>

#include "mlt/render.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

class FixedBits : public ::testing::TestWithParam<const char*> {
 protected:
  RenderOptions options() const {
    RenderOptions o;
    o.integrator = GetParam();
    o.seed = 11;
    o.overrides = {{"max_depth", "6"}};
    if (o.integrator == "pssmlt" || o.integrator == "mlt")
      o.overrides.insert(o.overrides.end(), {{"chains", "2"}, {"luminance_samples", "1024"}});
    return o;
  }
  static void expect_equal(const RenderResult& a, const RenderResult& b) {
    EXPECT_EQ(a.image.pixels, b.image.pixels);
    EXPECT_EQ(a.b, b.b);
    EXPECT_EQ(a.b_stderr, b.b_stderr);
    EXPECT_EQ(a.samples, b.samples);
    ASSERT_EQ(a.lengths.size(), b.lengths.size());
    for (std::size_t i = 0; i < a.lengths.size(); ++i)
      EXPECT_EQ(a.lengths[i].value, b.lengths[i].value);
  }
  Scene scene_{testing::make_test_scene("sky-lens")};
};

TEST_P(FixedBits, SamePictureForAnyNumberOfThreads) {
  RenderOptions o = options();
  o.samples_per_pixel = 16;
  o.threads = 1;
  const RenderResult one = render(scene_, o);
  EXPECT_GT(one.b, 0);
  for (const int threads : {2, 3}) {
    o.threads = threads;
    expect_equal(render(scene_, o), one);
  }
  o.seed = 12;
  EXPECT_NE(render(scene_, o).image.pixels, one.image.pixels);
}

TEST_P(FixedBits, RunEndedByTimeEqualsTheRunOfItsCount) {
  RenderOptions by_time = options();
  by_time.seconds = 0.05;
  by_time.threads = 2;
  const RenderResult timed = render(scene_, by_time);
  RenderOptions by_count = options();
  by_count.samples_per_pixel =
      static_cast<double>(timed.samples) / (timed.image.width * timed.image.height);
  by_count.threads = 1;
  expect_equal(render(scene_, by_count), timed);
}

INSTANTIATE_TEST_SUITE_P(Integrators, FixedBits,
                         ::testing::Values("path", "light", "bdpt", "pssmlt", "mlt"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace fogbow
