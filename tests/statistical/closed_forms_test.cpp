// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>

#include "core/estimators/sampling.h"
#include "core/scene_io/load.h"
#include "media/registry.h"
#include "mlt/render.h"
#include "mlt/render_settings.h"
#include "tests/helpers/statistics.h"
#include "tests/statistical/closed_forms_cases.h"

/// Every closed form of the design (validation, item 7) against every estimator that samples its
/// classes. With FOGBOW_LONG in the environment: as many samples more as tighten the errors to what
/// the power asked for needs.
namespace fogbow::testing {
namespace {

/// Chains take fewer and longer replicates: what their start and normalization have in common dies
/// out with their length.
constexpr int kReplicates = 64, kReplicatesOfChains = 32;
constexpr int kTiles = 2;  ///< a side
constexpr int kRegions = 4 + kTiles * kTiles;

bool is_long() { return std::getenv("FOGBOW_LONG") != nullptr; }

struct Effort {
  double samples;         ///< times those in the table
  double standard_error;  ///< at most, relative, of the picture's mean and of each channel's
  double power;           ///< at least, to detect a bias of the picture's mean by 1%
};
Effort effort(const Sampler& sampler) {
  if (!is_long()) return {1, 0.01, 0};
  if (sampler.price != Sampler::Price::kCheap) return {8, 0.003, 0};
  return {50, 0.003, 0.99};
}

struct Comparison {
  const ClosedForm* form;
  Sampler sampler;
  int index;
};

std::vector<Comparison> comparisons() {
  std::vector<Comparison> result;
  // mlt comes last: it shares out no other's random numbers.
  for (const bool mlt : {false, true})
    for (const ClosedForm& form : closed_forms())
      for (const Sampler& sampler : form.samplers)
        if ((sampler.integrator == "mlt") == mlt &&
            (is_long() || sampler.price != Sampler::Price::kLongOnly))
          result.push_back({&form, sampler, static_cast<int>(result.size())});
  return result;
}
int comparison_count() {
  static const int count = static_cast<int>(comparisons().size());
  return count;
}

std::unique_ptr<Scene> load(const ClosedForm& form) {
  LoadOptions options;
  options.definitions = form.definitions;
  std::vector<std::string> warnings;
  return std::make_unique<Scene>(load_mitsuba_xml("tests/statistical/scenes/" + form.scene + ".xml",
                                                  builtin_media(), options, warnings));
}

/// Independent pictures by one estimator.
class Replicates {
 public:
  Replicates(const Scene& scene, const std::string& integrator)
      : scene_(scene), integrator_(integrator), settings_(settings(scene, integrator)) {
    const EstimatorSettings s{settings_.max_depth, settings_.rr_depth};
    if (integrator == "path") estimator_ = make_path_tracer(scene, s);
    if (integrator == "light") estimator_ = make_light_tracer(scene, s);
    if (integrator == "bdpt") estimator_ = make_bdpt(scene, s);
    constexpr int kFractionBits = 30;
    if (estimator_) exponent_ = luminance_exponent(*estimator_, suite_seed()) - kFractionBits;
  }

  Image picture(std::uint64_t seed, double samples) {
    const double pixels = static_cast<double>(scene_.film().width) * scene_.film().height;
    return estimator_ ? independent(seed, samples) : chains(seed, samples / pixels);
  }
  std::uint64_t samples() const { return samples_; }
  bool uses_chains() const { return settings_.uses_chains(); }
  /// Part of the light in paths as long as max_depth allows.
  double longest_share() const { return longest_ / total_; }

 private:
  static RenderSettings settings(const Scene& scene, const std::string& integrator) {
    RenderOptions options;
    options.integrator = integrator;
    return read_render_settings(scene, options);
  }

  void count(int k, double light) {
    total_ += light;
    if (k == settings_.max_depth + 1) longest_ += light;
  }

  Image independent(std::uint64_t seed, double samples) {
    IndependentSampling sampling(*estimator_, scene_.film(), seed, exponent_);
    do sampling.run_round();
    while (static_cast<double>(sampling.samples()) < samples);
    samples_ += sampling.samples();
    EXPECT_EQ(sampling.refused(), 0u);
    for (const std::vector<double>& sums : sampling.tally())
      for (std::size_t k = 0; k < sums.size(); ++k) count(static_cast<int>(k), sums[k]);
    return sampling.develop();
  }

  Image chains(std::uint64_t seed, double samples_per_pixel) {
    RenderOptions options;
    options.integrator = integrator_;
    options.seed = seed;
    options.samples_per_pixel = samples_per_pixel;
    const double samples = samples_per_pixel * scene_.film().width * scene_.film().height;
    const int bootstrap = static_cast<int>(samples / 4);
    // Chains that share their time as the light is shared know the mean best.
    options.overrides = {
        {"luminance_samples", std::to_string(bootstrap)}, {"chains", "1"}, {"two_stage", "false"}};
    const RenderResult result = render(scene_, options);
    samples_ += result.samples + bootstrap;
    EXPECT_EQ(result.non_finite, 0u);
    for (const ClassShare& c : result.lengths) count(c.k, c.value);
    return result.image;
  }

  const Scene& scene_;
  std::string integrator_;
  RenderSettings settings_;
  std::unique_ptr<Estimator> estimator_;
  int exponent_ = 0;
  std::uint64_t samples_ = 0;
  double total_ = 0, longest_ = 0;
};

/// Sums over the parts of the picture that are compared, relative to what is expected: R, G, B, all
/// channels, and tiles. Nothing where no pixel is known.
class Regions {
 public:
  Regions(const ExpectedPixels& pixels, int width) : pixels_(pixels), width_(width) {
    each([&](int region, std::size_t pixel, int channel) {
      expected_[region] += (*pixels_[pixel])[channel];
    });
  }

  bool known(int region) const { return expected_[region] > 0; }
  std::array<double, kRegions> relative(const Image& image) const {
    std::array<double, kRegions> sums{};
    each([&](int region, std::size_t pixel, int channel) {
      sums[region] += image.pixels[pixel * image.channels.size() + channel];
    });
    for (int r = 0; r < kRegions; ++r)
      if (known(r)) sums[r] /= expected_[r];
    return sums;
  }

  static constexpr int kAll = 3;
  static std::string name(int region) {
    constexpr const char* kNames[] = {"R", "G", "B", "picture"};
    return region < 4 ? kNames[region] : "tile " + std::to_string(region - 4);
  }

 private:
  template <class Visit>
  void each(Visit&& visit) const {
    const int height = static_cast<int>(pixels_.size()) / width_;
    for (std::size_t i = 0; i < pixels_.size(); ++i) {
      if (!pixels_[i]) continue;
      const int column = static_cast<int>(i) % width_, row = static_cast<int>(i) / width_;
      const int tile = row * kTiles / height * kTiles + column * kTiles / width_;
      for (int c = 0; c < 3; ++c)
        for (const int region : {c, kAll, 4 + tile}) visit(region, i, c);
    }
  }

  const ExpectedPixels& pixels_;
  int width_;
  std::array<double, kRegions> expected_{};
};

class ClosedForms : public ::testing::TestWithParam<Comparison> {};

/// Relative values of all regions, replicate by replicate.
std::array<std::vector<double>, kRegions> measure(const Comparison& comparison, double samples,
                                                  const Regions& regions, Replicates& replicates) {
  const int n = replicates.uses_chains() ? kReplicatesOfChains : kReplicates;
  std::array<std::vector<double>, kRegions> values;
  for (int r = 0; r < n; ++r) {
    const auto stream = static_cast<std::uint64_t>(comparison.index) * kReplicates + r + 1;
    constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15;  // no overlap between nearby suite seeds
    const auto relative =
        regions.relative(replicates.picture(suite_seed() + kGolden * stream, samples / n));
    for (int i = 0; i < kRegions; ++i) values[i].push_back(relative[i]);
  }
  return values;
}

void print(const Comparison& c, const Estimate& picture, double worst, double detects,
           std::uint64_t samples, double seconds) {
  const double to_goal = sqr(worst / 0.003);
  std::printf(
      "%-34s %-7s %.5f +- %.5f, worst channel +- %.5f, power(1%%) %.3f: %9llu samples %6.1f s; for "
      "0.3%%: %9.0f samples %7.2f s\n",
      c.form->name.c_str(), c.sampler.integrator.c_str(), picture.mean, picture.standard_error,
      worst, detects, static_cast<unsigned long long>(samples), seconds,
      to_goal * static_cast<double>(samples), to_goal * seconds);
}

TEST_P(ClosedForms, IsRendered) {
  const Comparison& c = GetParam();
  const Effort e = effort(c.sampler);
  const double level = sidak(kSuiteFalseAlarm, comparison_count() * kRegions);
  const auto scene = load(*c.form);
  const FilmSettings& film = scene->film();
  const ExpectedPixels expected = c.form->expected(film.width, film.height);
  const Regions regions(expected, film.width);
  Replicates replicates(*scene, c.sampler.integrator);
  const std::clock_t start = std::clock();
  const auto values = measure(c, 1000 * c.sampler.samples * e.samples, regions, replicates);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;

  double worst = 0;
  for (int i = 0; i < kRegions; ++i) {
    if (!regions.known(i)) continue;
    const Estimate ratio = estimate(values[i]);
    EXPECT_GT(compare(ratio, 1), level)
        << Regions::name(i) << ": " << ratio.mean << " +- " << ratio.standard_error;
    if (i <= Regions::kAll) worst = std::fmax(worst, ratio.standard_error);
  }
  EXPECT_LT(worst, e.standard_error);
  const Estimate picture = estimate(values[Regions::kAll]);
  const double detects = power(picture, {1, 0, picture.degrees_of_freedom}, 0.01, level);
  EXPECT_GE(detects, e.power);
  if (c.form->all_lengths) {
    EXPECT_LT(replicates.longest_share(), 1e-5);
  }
  print(c, picture, worst, detects, replicates.samples(), seconds);
}

std::string test_name(const ::testing::TestParamInfo<Comparison>& info) {
  std::string name = info.param.form->name + " by " + info.param.sampler.integrator;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(All, ClosedForms, ::testing::ValuesIn(comparisons()), test_name);

TEST(ClosedForms, WhatIsLeftOut) {
  for (const ClosedForm& form : closed_forms()) {
    // mlt comes beside the four whose absence has to be explained.
    const auto references = std::ranges::count_if(
        form.samplers, [](const Sampler& sampler) { return sampler.integrator != "mlt"; });
    EXPECT_TRUE(references == 4 || !form.not_sampled.empty()) << form.name;
    if (!form.not_sampled.empty())
      std::printf("%-34s without %s\n", form.name.c_str(), form.not_sampled.c_str());
  }
}

}  // namespace
}  // namespace fogbow::testing
