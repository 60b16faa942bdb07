// SPDX-License-Identifier: GPL-3.0-or-later
// A chain in its steady state allocates nothing.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "tests/helpers/statistics.h"
#include "tests/laws/path_population.h"

namespace {
std::size_t allocations = 0;
}

// Not inlined: the compiler would take malloc and delete for a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p) noexcept { std::free(p); }
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace fogbow::testing {
namespace {

class Allocation : public ::testing::TestWithParam<TestScene> {};

TEST_P(Allocation, NoneInTheSteadyState) {
  constexpr int kWarmUp = 60000, kSteps = 20000;  // walks must have been tried
  const Scene scene(GetParam().make());
  const PathPopulation population(scene, 7, suite_seed());
  const auto table = make_path_mutations(default_mutation_weights(), population.techniques(),
                                         population.max_vertices());
  std::vector<PathSample> parts;
  for (std::uint64_t sample = 0; parts.empty(); ++sample) population.draw(sample, 1, parts);
  Chain<PathSample> chain(parts.front(), table);
  const auto run = [&](int first, int steps) {
    for (int i = first; i < first + steps; ++i) {
      Rng rng(suite_seed(), RngDomain::Chain, 0, i);
      chain.step(table, rng, [](const PathSample&, double) {});
    }
  };
  run(0, kWarmUp);
  const std::size_t before = allocations;
  run(kWarmUp, kSteps);
  EXPECT_EQ(allocations, before);
  EXPECT_GT(before, 0u) << "allocations are not counted";
}

INSTANTIATE_TEST_SUITE_P(Scenes, Allocation, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace fogbow::testing
