// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/util/parallel.h"
#include "mlt/normalization.h"
#include "mlt/primary_sample.h"

namespace fogbow {

namespace {

constexpr std::uint64_t kBlock = 1024;
constexpr int kMaxDoublings = 6;
/// Cells of the longer side of the picture; standard deviation of the blur, in cells.
constexpr int kCells = 64;
constexpr double kBlur = 2.5;

using Techniques = std::vector<std::vector<double>>;
using Cells = std::vector<double>;

/// Pictures of so many parts of the samples; their median knows no single firefly.
constexpr std::size_t kParts = 5;

PictureGrid grid_of(double aspect) {
  const auto cells = [](double part) {
    return std::max(1, static_cast<int>(std::lround(kCells * std::min(1.0, part))));
  };
  return {cells(aspect), cells(1 / aspect)};
}

/// Normal, of all cells there are.
void blur(Cells& cells, std::size_t first, std::size_t step, int n) {
  constexpr int kReach = static_cast<int>(4 * kBlur);
  const Cells from = [&] {
    Cells line;
    for (int i = 0; i < n; ++i) line.push_back(cells[first + i * step]);
    return line;
  }();
  for (int i = 0; i < n; ++i) {
    double sum = 0, weights = 0;
    for (int j = std::max(0, i - kReach); j <= std::min(n - 1, i + kReach); ++j) {
      const double weight = std::exp(-0.5 * (i - j) * (i - j) / (kBlur * kBlur));
      sum += weight * from[j];
      weights += weight;
    }
    cells[first + i * step] = sum / weights;
  }
}

void blur(Cells& cells, const PictureGrid& grid) {
  for (int y = 0; y < grid.down; ++y)
    blur(cells, static_cast<std::size_t>(y) * grid.across, 1, grid.across);
  for (int x = 0; x < grid.across; ++x) blur(cells, x, grid.across, grid.down);
}

}  // namespace

Pilot run_pilot(const Estimator& estimator, double aspect, std::uint64_t seed,
                std::uint64_t samples, double least_effective) {
  struct Block {
    BridgeSums sums;
    Techniques techniques;
    std::vector<std::pair<std::size_t, double>> lit;  // cell, luminance
  };
  const PictureGrid grid = grid_of(aspect);
  const auto entry = [](Techniques& table, std::size_t k, std::size_t s) -> double& {
    if (table.size() <= k) table.resize(k + 1);
    if (table[k].size() <= s) table[k].resize(s + 1);
    return table[k][s];
  };
  std::vector<Block> blocks;
  const auto draw = [&](std::uint64_t first, std::uint64_t last) {
    blocks.resize(last);
    parallel_for(static_cast<std::int64_t>(last - first), [&](std::int64_t task) {
      const std::uint64_t b = first + static_cast<std::uint64_t>(task);
      PrimarySample x;
      for (std::uint64_t i = 0; i < kBlock; ++i) {
        Rng rng(seed, RngDomain::WarmUp, b * kBlock + i, 1);
        x.draw(estimator, rng);
        blocks[b].sums.add_sample(x.f_star(), 1);
        for (const Contribution& c : x.contributions()) {
          entry(blocks[b].techniques, c.k, c.s) += luminance(c.value);
          blocks[b].lit.emplace_back(grid.cell(c.raster), luminance(c.value));
        }
      }
    });
  };
  const auto effective = [&] {
    BridgeSums all;
    for (const Block& block : blocks) all.add(block.sums);
    return all.effective_samples();
  };
  draw(0, std::max<std::uint64_t>(1, (samples + kBlock - 1) / kBlock));
  for (int doubling = 0; doubling < kMaxDoublings && effective() < least_effective; ++doubling)
    draw(blocks.size(), 2 * blocks.size());

  // Blocks are summed in their order: no number of threads changes the result.
  Pilot pilot;
  std::array<Cells, kParts> parts;
  parts.fill(Cells(grid.size()));
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Techniques& table = blocks[b].techniques;
    for (std::size_t k = 0; k < table.size(); ++k)
      for (std::size_t s = 0; s < table[k].size(); ++s)
        entry(pilot.techniques, k, s) += table[k][s];
    for (const auto& [cell, value] : blocks[b].lit) parts[b % kParts][cell] += value;
  }
  for (Cells& part : parts) blur(part, grid);
  Cells median;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::array<double, kParts> values;
    for (std::size_t p = 0; p < kParts; ++p) values[p] = parts[p][i];
    std::ranges::nth_element(values, values.begin() + kParts / 2);
    median.push_back(values[kParts / 2]);
  }
  pilot.importance = PictureImportance(grid, median);
  for (const Block& block : blocks)
    for (const auto& [cell, value] : block.lit)
      pilot.f_star += value * pilot.importance(grid.center(cell));
  pilot.f_star /= static_cast<double>(blocks.size() * kBlock);
  return pilot;
}

}  // namespace fogbow
