// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/brightness_grid.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace fogbow {
namespace {

constexpr int kCells = 128;    ///< a side
constexpr int kLookups = 4;    ///< a side of a cell
constexpr double kEven = 0.1;  ///< the part of the law that is spread evenly

RGB cell_mean(const std::function<RGB(const Vec2&)>& color, int i, int j) {
  RGB sum(0);
  for (int b = 0; b < kLookups; ++b)
    for (int a = 0; a < kLookups; ++a)
      sum += color((Vec2(i, j) + (Vec2(a, b) + 0.5) / double(kLookups)) / double(kCells));
  return sum / double(kLookups * kLookups);
}

}  // namespace

BrightnessGrid::BrightnessGrid(const std::function<RGB(const Vec2&)>& color) {
  std::vector<double> weights;
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const RGB cell = cell_mean(color, i, j);
      mean_ += cell / double(kCells * kCells);
      weights.push_back((1 - kEven) * luminance(cell));
    }
  for (double& weight : weights) weight += kEven * luminance(mean_);
  grid_ = GridDistribution(kCells, weights);
  if (!(grid_.total() > 0))
    throw std::domain_error("an emitter is black wherever it was looked at");
}

Vec2 BrightnessGrid::sample(const Vec2& u) const {
  const auto [i, j, within] = grid_.sample(u);
  const Vec2 x = (Vec2(i, j) + within) / double(kCells);
  return {warp::clamp_unit(x.x), warp::clamp_unit(x.y)};
}

double BrightnessGrid::pdf(const Vec2& x) const {
  const auto [i, j, within] = place(x);
  return grid_.probability(i, j) * (kCells * kCells);
}

GridDistribution::Place BrightnessGrid::place(const Vec2& x) const {
  const auto cell = [](double c) {
    return static_cast<std::size_t>(std::clamp(static_cast<int>(c * kCells), 0, kCells - 1));
  };
  const std::size_t i = cell(x.x), j = cell(x.y);
  return {i,
          j,
          {warp::clamp_unit(x.x * kCells - double(i)), warp::clamp_unit(x.y * kCells - double(j))}};
}

}  // namespace fogbow
