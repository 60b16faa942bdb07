// SPDX-License-Identifier: GPL-3.0-or-later
// What a checkpoint will hold: a run that was written and read back goes on with the same bits.
#include <gtest/gtest.h>

#include <sstream>

#include "mlt/bootstrap.h"
#include "mlt/chain_ensemble.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "mlt/registry.h"
#include "mlt/technique_distribution.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

std::string bytes(const Film& film) {
  std::ostringstream out;
  film.serialize(out);
  return out.str();
}

/// What chains of one kind of State are made of.
template <class State>
struct Parts {
  MutationTable<State> table;
  typename ChainEnsemble<State>::Start start;
  std::function<State(std::istream&)> read;
};

template <class State>
void expect_same_bits_after_interruption(const Scene& scene, const Bootstrap& bootstrap,
                                         const Parts<State>& parts) {
  const auto steps = [](std::uint64_t n) { return [n](std::size_t) { return n; }; };
  ChainEnsemble<State> straight(parts.table, 7, 2, parts.start);
  Film straight_film(scene.film(), -36);
  straight.run(steps(200), straight_film);
  straight.finish(straight_film);

  std::stringstream saved;
  {
    ChainEnsemble<State> first(parts.table, 7, 2, parts.start);
    Film film(scene.film(), -36);
    first.run(steps(90), film);
    first.serialize(saved);
    film.serialize(saved);
    bootstrap.normalization().serialize(saved);
  }
  ChainEnsemble<State> second(parts.table, 7, 2, parts.start);
  second.deserialize(saved, parts.read);
  Film film = Film::deserialize(saved, scene.film());
  const Normalization normalization = Normalization::deserialize(saved);
  second.run(steps(200), film);
  second.finish(film);

  EXPECT_TRUE(bytes(film) == bytes(straight_film));
  EXPECT_EQ(normalization.b(), bootstrap.normalization().b());
  for (int g = 0; g < Film::kGroups; ++g)
    EXPECT_EQ(normalization.b(g), bootstrap.normalization().b(g));
  for (std::size_t i = 0; i < straight.size(); ++i) {
    EXPECT_EQ(second.record(i).bridge.b(), straight.record(i).bridge.b());
    EXPECT_EQ(second.record(i).length_share, straight.record(i).length_share);
    std::map<PathClass, double> a, b;
    second.record(i).classes.add_to(a);
    straight.record(i).classes.add_to(b);
    EXPECT_EQ(a, b);
  }
}

TEST(Serialization, InterruptedRunEndsOnTheSameBits) {
  const Scene scene(testing::make_test_scene("glass-sphere-fog"));
  const auto estimator = make_bdpt(scene, {.max_depth = 8, .seen_light = false});
  const Bootstrap bootstrap(*estimator, 7, 256);
  expect_same_bits_after_interruption<PrimarySample>(
      scene, bootstrap,
      {make_primary_sample_mutations(*estimator, 0.3),
       [&](int group, std::uint64_t chain) {
         return bootstrap.start(group, (static_cast<double>(chain) + 0.5) / 16);
       },
       [](std::istream& in) { return PrimarySample::deserialize(in); }});
  const TechniqueDistribution techniques({}, 9);
  expect_same_bits_after_interruption<PathSample>(
      scene, bootstrap,
      {make_path_mutations(default_mutation_weights(), techniques, 9),
       [&](int group, std::uint64_t chain) {
         return PathSample::choose(
                    scene, 9, bootstrap.start(group, (static_cast<double>(chain) + 0.5) / 16), 0.5)
             .value();
       },
       [&](std::istream& in) { return PathSample::deserialize(in, scene, 9); }});
}

TEST(Serialization, TruncatedStateIsAnError) {
  const Scene scene(testing::make_test_scene("floor-fog"));
  const auto estimator = make_bdpt(scene, {.max_depth = 4, .seen_light = false});
  const Bootstrap bootstrap(*estimator, 7, 64);
  std::ostringstream out;
  bootstrap.start(0, 0.5).serialize(out);
  const std::string all = out.str();
  for (std::size_t length = 0; length < all.size(); length += 7) {
    std::istringstream in(all.substr(0, length));
    EXPECT_THROW(PrimarySample::deserialize(in), Error);
  }
  std::ostringstream path_out;
  PathSample::choose(scene, 5, bootstrap.start(0, 0.5), 0.5).value().serialize(path_out);
  const std::string path = path_out.str();
  for (std::size_t length = 0; length < path.size(); length += 7) {
    std::istringstream in(path.substr(0, length));
    EXPECT_THROW(PathSample::deserialize(in, scene, 5), Error);
  }
}

}  // namespace
}  // namespace fogbow
