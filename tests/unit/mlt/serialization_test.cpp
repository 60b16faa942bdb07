// SPDX-License-Identifier: GPL-3.0-or-later
// What a checkpoint will hold: a run that was written and read back goes on with the same bits.
#include <gtest/gtest.h>

#include <sstream>

#include "mlt/chain_ensemble.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

std::string bytes(const Film& film) {
  std::ostringstream out;
  film.serialize(out);
  return out.str();
}

TEST(Serialization, InterruptedRunEndsOnTheSameBits) {
  const Scene scene(testing::make_test_scene("glass-sphere-fog"));
  const auto estimator = make_bdpt(scene, {.max_depth = 8});
  const auto table = make_primary_sample_mutations(*estimator, 0.3);
  const Bootstrap bootstrap(*estimator, 7, 256);
  const auto start = [&](int group, std::uint64_t chain) { return bootstrap.start(group, chain); };
  const auto steps = [](std::uint64_t n) { return [n](std::size_t) { return n; }; };

  ChainEnsemble<PrimarySample> straight(table, 7, 2, start);
  Film straight_film(scene.film(), -36);
  straight.run(steps(200), straight_film);
  straight.finish(straight_film);

  std::stringstream saved;
  {
    ChainEnsemble<PrimarySample> first(table, 7, 2, start);
    Film film(scene.film(), -36);
    first.run(steps(90), film);
    first.serialize(saved);
    film.serialize(saved);
    bootstrap.normalization().serialize(saved);
  }
  ChainEnsemble<PrimarySample> second(table, 7, 2, start);
  second.deserialize(saved);
  Film film = Film::deserialize(saved, scene.film());
  const Normalization normalization = Normalization::deserialize(saved);
  second.run(steps(200), film);
  second.finish(film);

  EXPECT_EQ(bytes(film), bytes(straight_film));
  EXPECT_EQ(normalization.b(), bootstrap.normalization().b());
  EXPECT_EQ(normalization.standard_error(), bootstrap.normalization().standard_error());
  for (std::size_t i = 0; i < straight.size(); ++i) {
    EXPECT_EQ(second.record(i).independent_f_star, straight.record(i).independent_f_star);
    EXPECT_EQ(second.record(i).length_share, straight.record(i).length_share);
  }
}

TEST(Serialization, TruncatedStateIsAnError) {
  const Scene scene(testing::make_test_scene("floor-fog"));
  const auto estimator = make_bdpt(scene, {.max_depth = 4});
  const Bootstrap bootstrap(*estimator, 7, 64);
  std::ostringstream out;
  bootstrap.start(0, 0).serialize(out);
  const std::string all = out.str();
  for (std::size_t length = 0; length < all.size(); length += 7) {
    std::istringstream in(all.substr(0, length));
    EXPECT_THROW(PrimarySample::deserialize(in), Error);
  }
}

}  // namespace
}  // namespace fogbow
