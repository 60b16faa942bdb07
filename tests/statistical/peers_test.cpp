// SPDX-License-Identifier: GPL-3.0-or-later
// scenes/ against their references by Mitsuba 3, tile by tile (validation 8 of the design). In the
// fast suite a few tiles of some scenes; in the long one all scenes, pssmlt and mlt beside bdpt,
// with the power that the design asks for.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <numeric>

#include "core/estimators/sampling.h"
#include "core/image/image_io.h"
#include "core/scene_io/load.h"
#include "media/registry.h"
#include "mlt/registry.h"
#include "tests/statistical/peers_budget.h"

namespace fogbow {
namespace {

using namespace testing;

constexpr int kMaxDepth = 64;  // as most references
/// Of renders by chains, of samples. Few would cost power: Student's t at this level is wide.
constexpr int kRenders = 64, kReplicates = 96;
/// A pixel; a replicate's bootstrap takes no less time.
constexpr int kPilotMutations = 4;
constexpr int kMostClasses = 40;
constexpr int kTests = (15 * 7 + 2 * 9) * (256 + 16 + 1 + kMostClasses);
const double kLevel = sidak(kSuiteFalseAlarm, kTests);
constexpr double kPower = 0.99;
const Rigour kRigour{kLevel, kPower};

bool is_long() { return std::getenv("FOGBOW_LONG") != nullptr; }

struct Peer {
  std::string name;
  std::array<int, 4> crop;  ///< of the fast suite; width 0: only in the long one
  bool path_converges;      ///< next-event estimation reaches nearly all of the light
  bool by_mitsuba = true;   ///< the reference; else by one of our own estimators
  int max_depth = kMaxDepth;
};

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all = {{"cornell-fog", {32, 144, 64, 32}, true},
                                        {"cornell-fog-g07", {0, 0, 0, 0}, true},
                                        {"glass-sphere-fog", {16, 224, 64, 32}, false},
                                        {"ring-caustic", {0, 0, 0, 0}, false},
                                        {"ring-caustic-rough", {32, 208, 64, 32}, true},
                                        {"pool", {0, 0, 0, 0}, false},
                                        {"bulb", {0, 0, 0, 0}, false},
                                        {"door-ajar", {0, 0, 0, 0}, false},
                                        {"door-ajar-fog", {0, 0, 0, 0}, false},
                                        {"smoke", {96, 112, 32, 32}, true},
                                        {"caustic-beam", {0, 0, 0, 0}, false, false},
                                        {"sun-and-sky", {64, 144, 64, 32}, true},
                                        {"cloud", {0, 0, 0, 0}, true, true, 256},
                                        {"fogbow", {0, 0, 0, 0}, false, false},
                                        {"milk-glass", {0, 0, 0, 0}, true, false, 256}};
  return all;
}

/// Effective number of pixels that a tile's variance in the reference comes from. Where it is
/// small, a few rare hits are all that is known of the error: there the reference's own error
/// cannot be believed.
double contributing_pixels(const Reference& reference, const Tiles& like, std::size_t tile) {
  const int x0 = static_cast<int>(tile) % like.across * kTile;
  const int y0 = static_cast<int>(tile) / like.across * kTile;
  double squares = 0, fourths = 0;
  for (int y = y0; y < y0 + kTile; ++y)
    for (int x = x0; x < x0 + kTile; ++x) {
      const Image& e = reference.error;
      const double variance = sqr(luminance(RGB(e.at(x, y, 0), e.at(x, y, 1), e.at(x, y, 2))));
      squares += variance;
      fourths += sqr(variance);
    }
  return fourths > 0 ? squares * squares / fourths : kTile * kTile;
}

std::vector<std::size_t> believable_tiles(const Reference& reference, const Tiles& like) {
  constexpr double kLeastPixels = 32;
  std::vector<std::size_t> tiles;
  for (std::size_t i = 0; i < like.count(); ++i)
    if (contributing_pixels(reference, like, i) >= kLeastPixels) tiles.push_back(i);
  return tiles;
}

/// `theirs` may exceed the truth by anything from nothing to `excess`.
double p_value(Estimate ours, const Estimate& theirs, double excess) {
  ours.mean += std::clamp(theirs.mean - ours.mean, 0.0, excess);
  return welch(ours, theirs);
}

/// Each tile, each block of tiles, and all of them together.
template <class Theirs>
void expect_equal(const std::string& name, const Tiles& ours, const Theirs& theirs,
                  const std::vector<std::size_t>& tiles, const Tiles& excess, const Bias& bias) {
  ASSERT_FALSE(tiles.empty()) << name;
  const double brightness = theirs(tiles).mean;
  double least = 1, least_power = 1;
  const auto expect = [&](const std::string& what, const std::vector<std::size_t>& part,
                          double least_bias) {
    const Estimate a = ours.estimate(part), b = theirs(part);
    const double allowance = excess.mean_excess(part), p = p_value(a, b, allowance);
    EXPECT_GT(p, kLevel) << name << ", " << what << ": " << a.mean << " ± " << a.standard_error
                         << " against " << b.mean << " ± " << b.standard_error << ", allowance "
                         << allowance;
    least = std::min(least, p);
    if (!(least_bias > 0) || b.mean < kDark * brightness) return;
    // The allowance may hide its own size of a bias.
    const double seen = power(a, b, least_bias * b.mean - allowance, kLevel);
    EXPECT_GE(seen, kPower) << name << ", " << what << ": a bias of " << least_bias
                            << " would escape; standard errors " << a.standard_error / b.mean
                            << ", " << b.standard_error / b.mean;
    least_power = std::min(least_power, seen);
  };
  for (const std::size_t i : tiles) expect("tile " + std::to_string(i), {i}, 0);
  for (const auto& block : blocks_of(ours, tiles))
    expect("block of tile " + std::to_string(block.front()), block, bias.part);
  expect("mean", tiles, bias.mean);
  const Estimate a = ours.estimate(tiles), b = theirs(tiles);
  std::printf(
      "%-32s %3zu tiles, least p %.2g; mean ratio %.5f ± %.5f, allowance %.5f; a bias of %g%% of "
      "the mean, %g%% of a block is found with probability %.4f\n",
      name.c_str(), tiles.size(), least, a.mean / b.mean,
      std::hypot(a.standard_error, b.standard_error) / b.mean, excess.mean_excess(tiles) / b.mean,
      100 * bias.mean, 100 * bias.part, least_power);
  std::fflush(stdout);
}

/// Each class of paths that notably carries light, and all others together.
void expect_equal_classes(const std::string& name, const Tiles& ours, const Tiles& bdpt,
                          const Bias& bias) {
  double b = 0;
  for (const auto& [configuration, values] : bdpt.classes) b += estimate(values).mean;
  std::map<std::string, std::array<std::vector<double>, 2>> compared;
  const Tiles* sides[] = {&ours, &bdpt};
  for (int side = 0; side < 2; ++side)
    for (const auto& [configuration, values] : sides[side]->classes) {
      const auto known = bdpt.classes.find(configuration);
      const bool alone =
          known != bdpt.classes.end() && estimate(known->second).mean > kComparedClass * b;
      auto& sums = compared[alone ? configuration : kOtherClasses][side];
      sums.resize(values.size());
      for (std::size_t r = 0; r < values.size(); ++r) sums[r] += values[r];
    }
  EXPECT_LE(compared.size(), static_cast<std::size_t>(kMostClasses)) << name;
  double least = 1, least_power = 1;
  for (const auto& [configuration, values] : compared) {
    ASSERT_FALSE(values[0].empty() || values[1].empty()) << name << ", " << configuration;
    const Estimate x = estimate(values[0]), y = estimate(values[1]);
    const double p = welch(x, y);
    EXPECT_GT(p, kLevel) << name << ", " << configuration << ": " << x.mean << " ± "
                         << x.standard_error << " against " << y.mean << " ± " << y.standard_error;
    least = std::min(least, p);
    if (y.mean < kNotableClass * b || configuration == kOtherClasses) continue;
    const double seen = power(x, y, bias.part * y.mean, kLevel);
    EXPECT_GE(seen, kPower) << name << ", " << configuration << ": standard errors "
                            << x.standard_error / y.mean << ", " << y.standard_error / y.mean;
    least_power = std::min(least_power, seen);
  }
  std::printf(
      "%-32s %3zu classes, least p %.2g; a bias of %g%% of a notable one is found with probability "
      "%.4f\n",
      name.c_str(), compared.size(), least, 100 * bias.part, least_power);
}

constexpr double kSafety = 1.5;  // a pilot's own errors are uncertain

/// `render`(mutations a pixel, seed) with as many as `bias` takes, found by an independent pilot.
template <class Render>
Tiles chains_enough(const Render& render, const Bias& bias, std::uint64_t seed) {
  const auto all = demands(render(kPilotMutations, seed), bias, kRigour);
  const auto most = std::ranges::max_element(all, {}, &Demand::growth);
  std::printf("chains: %.1f times the pilot, for %s\n", kSafety * most->growth, most->name.c_str());
  return render(static_cast<int>(std::ceil(kSafety * most->growth * kPilotMutations)), seed + 1);
}

/// `render`(samples a pixel of each block, seed), as chains_enough(), with what its part that is
/// `compared` takes.
template <class Render>
Pictures samples_enough(const Render& render, Tiles Pictures::*compared, const Bias& bias,
                        std::uint64_t seed) {
  const Pictures pilot = render([](std::size_t) { return 1; }, seed);
  const std::vector<double> factor =
      shares(pilot.*compared, demands(pilot.*compared, bias, kRigour));
  std::printf("samples: %.1f times the pilot, %.1f in the hardest block\n",
              kSafety * std::accumulate(factor.begin(), factor.end(), 0.0) /
                  static_cast<double>(factor.size()),
              kSafety * std::ranges::max(factor));
  return render(
      [&](std::size_t block) { return static_cast<int>(std::ceil(kSafety * factor[block])); },
      seed + 1);
}

class Peers : public ::testing::TestWithParam<Peer> {};

TEST_P(Peers, PicturesAgreeWithMitsuba) {
  const Peer& peer = GetParam();
  if (!is_long() && peer.crop[2] == 0) GTEST_SKIP() << "in the long suite";
  LoadOptions options;
  options.read_image = read_image;
  if (!is_long()) options.crop = peer.crop;
  std::vector<std::string> warnings;
  const Scene scene(
      load_mitsuba_xml("scenes/" + peer.name + "/scene.xml", builtin_media(), options, warnings));
  const EstimatorSettings settings{.max_depth = peer.max_depth};
  const Bias bias = is_long() ? Bias{0.01, 0.05} : Bias{0.03, 0};
  const auto independent = [&](const Estimator& estimator, bool classified,
                               Tiles Pictures::*compared, std::uint64_t stream) {
    const auto rendering = [&](const SamplesPerPixel& samples, std::uint64_t seed) {
      return render_tiles(scene, estimator, classified, kReplicates, samples, seed);
    };
    constexpr int kFastSamples = 5;
    return is_long() ? samples_enough(rendering, compared, bias, suite_seed() + stream)
                     : rendering([](std::size_t) { return kFastSamples; }, suite_seed() + stream);
  };

  const Pictures bdpt = independent(*make_bdpt(scene, settings), true, &Pictures::all, 70);
  const Tiles& ours = bdpt.all;
  const Reference reference = read_reference(peer.name, scene);
  const auto theirs = [&](const std::vector<std::size_t>& tiles) {
    return reference.estimate(tiles, ours);
  };
  const auto of = [](const Tiles& tiles) {
    return [&tiles](const std::vector<std::size_t>& part) { return tiles.estimate(part); };
  };
  const auto tiles = believable_tiles(reference, ours);
  const Tiles none{ours.across, {}, std::vector<double>(ours.count())};
  const std::string they = peer.by_mitsuba ? ", Mitsuba" : ", reference";
  const Tiles& excess = peer.by_mitsuba ? ours : none;
  expect_equal(peer.name + ": bdpt" + they, ours, theirs, tiles, excess, bias);
  if (!is_long()) return;

  if (peer.path_converges) {
    const Tiles path =
        independent(*make_path_tracer(scene, settings), false, &Pictures::all, 80).all;
    expect_equal(peer.name + ": path" + they, path, theirs, tiles, excess, bias);
  }
  const Tiles light =
      independent(*make_light_tracer(scene, settings), true, &Pictures::by_light, 100).by_light;
  expect_equal(peer.name + ": light, bdpt", light, of(bdpt.by_light), all_tiles(ours), none, bias);
  // Whatever the reference cannot tell, two of our own samplers must agree on.
  for (const std::string integrator : {"pssmlt", "mlt"}) {
    const Tiles chains = chains_enough(
        [&](int mutations, std::uint64_t seed) {
          return render_tiles_by_chains(scene, {integrator, peer.max_depth, ""}, kRenders,
                                        mutations, seed);
        },
        bias, suite_seed() + 90);
    expect_equal(peer.name + ": " + integrator + ", bdpt", chains, of(ours), all_tiles(ours), none,
                 bias);
    expect_equal(peer.name + ": " + integrator + they, chains, theirs, tiles, excess, bias);
    if (!chains.classes.empty())
      expect_equal_classes(peer.name + ": " + integrator + ", bdpt", chains, ours, bias);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Peers, ::testing::ValuesIn(peers()), [](const auto& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

class MutationAlone : public ::testing::TestWithParam<std::tuple<std::string, std::string>> {};

/// Each mutation together with large steps, which alone make a chain ergodic.
TEST_P(MutationAlone, AgreesWithBdpt) {
  if (!is_long()) GTEST_SKIP() << "in the long suite";
  const Bias bias{0.01, 0.05};
  const auto& [scene_name, mutation] = GetParam();
  std::vector<std::string> warnings;
  const Scene scene(
      load_mitsuba_xml("scenes/" + scene_name + "/scene.xml", builtin_media(), {}, warnings));
  static std::map<std::string, Tiles> by_bdpt;
  if (!by_bdpt.contains(scene_name))
    by_bdpt[scene_name] =
        samples_enough(
            [&](const SamplesPerPixel& samples, std::uint64_t seed) {
              return render_tiles(scene, *make_bdpt(scene, {.max_depth = kMaxDepth}), false,
                                  kReplicates, samples, seed);
            },
            &Pictures::all, bias, suite_seed() + 110)
            .all;
  const Tiles& bdpt = by_bdpt[scene_name];
  const std::string mutations = mutation + ":1,large_step:1";
  const Tiles chains = chains_enough(
      [&](int per_pixel, std::uint64_t seed) {
        return render_tiles_by_chains(scene, {"mlt", kMaxDepth, mutations}, kRenders, per_pixel,
                                      seed);
      },
      bias, suite_seed() + 120);
  expect_equal(
      scene_name + ": " + mutation, chains,
      [&](const std::vector<std::size_t>& part) { return bdpt.estimate(part); }, all_tiles(bdpt),
      Tiles{bdpt.across, {}, std::vector<double>(bdpt.count())}, bias);
}

std::vector<std::string> mutations_but_large_steps() {
  std::vector<std::string> names;
  for (const auto& [name, weight] : default_mutation_weights())
    if (name != "large_step") names.push_back(name);
  return names;
}

INSTANTIATE_TEST_SUITE_P(Scenes, MutationAlone,
                         ::testing::Combine(::testing::Values("glass-sphere-fog", "caustic-beam"),
                                            ::testing::ValuesIn(mutations_but_large_steps())),
                         [](const auto& info) {
                           std::string name =
                               std::get<0>(info.param) + "_" + std::get<1>(info.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace fogbow
