// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/statistical/peers_budget.h"

#include <algorithm>
#include <numeric>
#include <ranges>

#include "core/math/vec.h"

namespace fogbow::testing {

namespace {

/// Variance of what a demand gets from each block's pixels, and last from light tracing.
std::vector<double> variances(const Tiles& tiles, const Demand& demand) {
  const std::size_t blocks = tiles.block_count(), replicates = tiles.replicates.size();
  std::vector<std::vector<double>> sources(blocks + 1, std::vector<double>(replicates));
  for (std::size_t r = 0; r < replicates; ++r) {
    if (demand.tiles.empty()) {
      for (std::size_t i = 0; i <= blocks; ++i)
        sources[i][r] = tiles.class_sources.at(demand.name)[r][i];
      continue;
    }
    for (const std::size_t tile : demand.tiles) {
      const double splats = tiles.splats[r][tile];
      sources[blocks][r] += splats / static_cast<double>(demand.tiles.size());
      sources[tiles.block(tile)][r] +=
          (tiles.replicates[r][tile] - splats) / static_cast<double>(demand.tiles.size());
    }
  }
  std::vector<double> result;
  for (const auto& values : sources) result.push_back(sqr(estimate(values).standard_error));
  return result;
}

}  // namespace

std::vector<std::size_t> all_tiles(const Tiles& like) {
  std::vector<std::size_t> tiles(like.count());
  for (std::size_t i = 0; i < tiles.size(); ++i) tiles[i] = i;
  return tiles;
}

std::vector<std::vector<std::size_t>> blocks_of(const Tiles& like,
                                                const std::vector<std::size_t>& tiles) {
  std::vector<std::vector<std::size_t>> blocks(like.block_count());
  for (const std::size_t i : tiles) blocks[like.block(i)].push_back(i);
  std::erase_if(blocks, [](const auto& block) { return block.empty(); });
  return blocks;
}

std::vector<Demand> demands(const Tiles& pilot, const Bias& bias, const Rigour& rigour) {
  std::vector<Demand> result;
  const auto add = [&](const std::string& name, const Estimate& e, double part,
                       const std::vector<std::size_t>& tiles) {
    result.push_back(
        {name, e, samples_needed(e, part * e.mean, rigour.level, rigour.power), tiles});
  };
  const Estimate mean = pilot.estimate(all_tiles(pilot));
  add("mean", mean, bias.mean, all_tiles(pilot));
  for (const auto& block : blocks_of(pilot, all_tiles(pilot)))
    if (const Estimate e = pilot.estimate(block); e.mean > kDark * mean.mean)
      add("block of tile " + std::to_string(block.front()), e, bias.part, block);
  double b = 0;
  for (const auto& [configuration, values] : pilot.classes) b += estimate(values).mean;
  for (const auto& [configuration, values] : pilot.classes)
    if (const Estimate e = estimate(values);
        configuration != kOtherClasses && e.mean > kNotableClass * b)
      add(configuration, e, bias.part, {});
  return result;
}

// Where a demand is not met, the block whose samples lessen its variance most gets more.
std::vector<double> shares(const Tiles& pilot, const std::vector<Demand>& demands) {
  constexpr double kStep = 1.05;
  const std::size_t blocks = pilot.block_count();
  std::vector<double> factor(blocks, 1.0);
  for (const Demand& demand : demands) {
    const auto variance = variances(pilot, demand);
    const double wanted = sqr(demand.pilot.standard_error) / demand.growth;
    for (;;) {
      const double mean = std::accumulate(factor.begin(), factor.end(), 0.0) / blocks;
      double left = variance[blocks] / mean;
      for (std::size_t i = 0; i < blocks; ++i) left += variance[i] / factor[i];
      if (left <= wanted * (1 + 1e-9)) break;
      // Light tracing gains as much by any.
      const auto gain = [&](std::size_t i) {
        return std::pair(variance[i] / sqr(factor[i]), -factor[i]);
      };
      const auto all = std::views::iota(std::size_t{0}, blocks);
      factor[*std::ranges::max_element(all, {}, gain)] *= kStep;
    }
  }
  return factor;
}

}  // namespace fogbow::testing
