// SPDX-License-Identifier: GPL-3.0-or-later
// scenes/ against their references by Mitsuba 3, tile by tile (validation 8 of the design). In the
// fast suite a few tiles of three scenes; in the long one all scenes, pssmlt and mlt beside bdpt,
// with the power that the design asks for.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <map>

#include "core/estimators/sampling.h"
#include "core/scene_io/load.h"
#include "media/registry.h"
#include "mlt/registry.h"
#include "tests/statistical/peers_rendering.h"

namespace fogbow {
namespace {

using namespace testing;

constexpr int kMaxDepth = 64;  // as the references
constexpr int kReplicates = 32;
constexpr int kTests = (10 * 4 + 2 * 8) * (256 + 16 + 1);
const double kLevel = sidak(kSuiteFalseAlarm, kTests);
constexpr double kPower = 0.99;

bool is_long() { return std::getenv("FOGBOW_LONG") != nullptr; }

struct Peer {
  std::string name;
  std::array<int, 4> crop;  ///< of the fast suite; width 0: only in the long one
  int fast_rounds, long_rounds;
  int pssmlt, mlt;         ///< mutations a pixel and replicate of the long suite
  bool path_converges;     ///< next-event estimation reaches nearly all of the light
  bool by_mitsuba = true;  ///< the reference; else by our own bdpt
};

const std::vector<Peer>& peers() {
  static const std::vector<Peer> all = {
      {"cornell-fog", {32, 144, 64, 32}, 16, 8, 32, 64, true},
      {"cornell-fog-g07", {0, 0, 0, 0}, 0, 8, 32, 64, true},
      {"glass-sphere-fog", {16, 224, 64, 32}, 16, 48, 96, 256, false},
      {"ring-caustic", {0, 0, 0, 0}, 0, 16, 32, 64, false},
      {"ring-caustic-rough", {32, 208, 64, 32}, 16, 8, 32, 64, true},
      {"pool", {0, 0, 0, 0}, 0, 64, 96, 256, false},
      {"bulb", {0, 0, 0, 0}, 0, 32, 64, 256, false},
      {"door-ajar", {0, 0, 0, 0}, 0, 32, 64, 128, false},
      {"door-ajar-fog", {0, 0, 0, 0}, 0, 32, 64, 256, false},
      {"caustic-beam", {0, 0, 0, 0}, 0, 32, 64, 128, false, false}};
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

std::vector<std::size_t> all_tiles(const Tiles& like) {
  std::vector<std::size_t> tiles(like.count());
  for (std::size_t i = 0; i < tiles.size(); ++i) tiles[i] = i;
  return tiles;
}

/// `theirs` may exceed the truth by anything from nothing to `excess`.
double p_value(Estimate ours, const Estimate& theirs, double excess) {
  ours.mean += std::clamp(theirs.mean - ours.mean, 0.0, excess);
  return welch(ours, theirs);
}

/// Parts of the picture of 4 × 4 tiles.
std::vector<std::vector<std::size_t>> blocks_of(const std::vector<std::size_t>& tiles,
                                                std::size_t across) {
  constexpr std::size_t kBlock = 4;
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> blocks;
  for (const std::size_t i : tiles) blocks[{i / across / kBlock, i % across / kBlock}].push_back(i);
  std::vector<std::vector<std::size_t>> result;
  for (auto& block : blocks) result.push_back(std::move(block.second));
  return result;
}

/// What is to be found with 99% probability, in parts of the value: of the mean, and of a block
/// (0: of no block) that is not dark.
struct Bias {
  double mean, block;
};

/// Each tile, each block of tiles, and all of them together.
template <class Theirs>
void expect_equal(const std::string& name, const Tiles& ours, const Theirs& theirs,
                  const std::vector<std::size_t>& tiles, const Tiles& excess, const Bias& bias) {
  constexpr double kDark = 0.5;  // parts of the mean
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
  for (const auto& block : blocks_of(tiles, static_cast<std::size_t>(ours.across)))
    expect("block of tile " + std::to_string(block.front()), block, bias.block);
  expect("mean", tiles, bias.mean);
  const Estimate a = ours.estimate(tiles), b = theirs(tiles);
  std::printf(
      "%-32s %3zu tiles, least p %.2g; mean ratio %.5f ± %.5f, allowance %.5f; a bias of %g%% of "
      "the mean, %g%% of a block is found with probability %.4f\n",
      name.c_str(), tiles.size(), least, a.mean / b.mean,
      std::hypot(a.standard_error, b.standard_error) / b.mean, excess.mean_excess(tiles) / b.mean,
      100 * bias.mean, 100 * bias.block, least_power);
  std::fflush(stdout);
}

class Peers : public ::testing::TestWithParam<Peer> {};

TEST_P(Peers, PicturesAgreeWithMitsuba) {
  const Peer& peer = GetParam();
  if (!is_long() && peer.crop[2] == 0) GTEST_SKIP() << "in the long suite";
  LoadOptions options;
  if (!is_long()) options.crop = peer.crop;
  std::vector<std::string> warnings;
  const Scene scene(
      load_mitsuba_xml("scenes/" + peer.name + "/scene.xml", builtin_media(), options, warnings));
  const EstimatorSettings settings{.max_depth = kMaxDepth};
  const int rounds = is_long() ? peer.long_rounds : peer.fast_rounds;
  const Bias bias = is_long() ? Bias{0.01, 0.05} : Bias{0.03, 0};

  const auto bdpt = make_bdpt(scene, settings);
  const Tiles ours = render_tiles(scene, *bdpt, true, kReplicates, rounds, suite_seed() + 70);
  const Reference reference = read_reference(peer.name, scene);
  const auto theirs = [&](const std::vector<std::size_t>& tiles) {
    return reference.estimate(tiles, ours);
  };
  const auto tiles = believable_tiles(reference, ours);
  const Tiles none{ours.across, {}, std::vector<double>(ours.count())};
  expect_equal(peer.name + (peer.by_mitsuba ? ": bdpt, Mitsuba" : ": bdpt, reference"), ours,
               theirs, tiles, peer.by_mitsuba ? ours : none, bias);
  if (!is_long()) return;

  if (peer.path_converges) {
    const auto path = make_path_tracer(scene, settings);
    const Tiles by_path = render_tiles(scene, *path, false, kReplicates, rounds, suite_seed() + 80);
    expect_equal(peer.name + ": path, Mitsuba", by_path, theirs, tiles, ours, bias);
  }
  // Whatever the reference cannot tell, two of our own samplers must agree on.
  for (const auto& [integrator, mutations] :
       {std::pair<std::string, int>("pssmlt", peer.pssmlt), {"mlt", peer.mlt}}) {
    const Tiles chains = render_tiles_by_chains(scene, {integrator, kMaxDepth, ""}, kReplicates,
                                                mutations, suite_seed() + 90);
    expect_equal(
        peer.name + ": " + integrator + ", bdpt", chains,
        [&](const std::vector<std::size_t>& part) { return ours.estimate(part); }, all_tiles(ours),
        none, bias);
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
  constexpr int kRounds = 48, kMutations = 256;
  const auto& [scene_name, mutation] = GetParam();
  std::vector<std::string> warnings;
  const Scene scene(
      load_mitsuba_xml("scenes/" + scene_name + "/scene.xml", builtin_media(), {}, warnings));
  static std::map<std::string, Tiles> by_bdpt;
  if (!by_bdpt.contains(scene_name))
    by_bdpt[scene_name] = render_tiles(scene, *make_bdpt(scene, {.max_depth = kMaxDepth}), false,
                                       kReplicates, kRounds, suite_seed() + 110);
  const Tiles& bdpt = by_bdpt[scene_name];
  const std::string mutations = mutation + ":1,large_step:1";
  const Tiles chains = render_tiles_by_chains(scene, {"mlt", kMaxDepth, mutations}, kReplicates,
                                              kMutations, suite_seed() + 120);
  expect_equal(scene_name + ": " + mutation, chains,
               [&](const std::vector<std::size_t>& part) { return bdpt.estimate(part); },
               all_tiles(bdpt), Tiles{bdpt.across, {}, std::vector<double>(bdpt.count())},
               {0.01, 0.05});
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
