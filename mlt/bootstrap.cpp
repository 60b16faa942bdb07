// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/bootstrap.h"

#include <algorithm>

#include "core/util/parallel.h"

namespace fogbow {

namespace {
constexpr int kMaxDoublings = 6;
constexpr std::uint64_t kBlock = 1024;

/// Of the brightest contribution: its length, then its cell of the picture in Morton's order, in
/// which neighbours mostly are neighbours.
std::uint32_t place(const PrimarySample& x) {
  constexpr int kBits = 6;  // of a coordinate
  const Contribution& c =
      *std::ranges::max_element(x.contributions(), {}, [&](const Contribution& other) {
        return luminance(other.value) * x.importance()(other.raster);
      });
  auto result = static_cast<std::uint32_t>(c.k);
  for (int bit = 1; bit <= kBits; ++bit)
    for (const double coordinate : {c.raster.y, c.raster.x})
      result = 2 * result + static_cast<std::uint32_t>(std::ldexp(coordinate, bit)) % 2;
  return result;
}
}  // namespace

std::uint64_t Bootstrap::stream(int group, std::uint64_t sample) const {
  return sample * Film::kGroups + static_cast<std::uint64_t>(group);
}

Bootstrap::Sample Bootstrap::draw(int group, std::uint64_t i, const BridgeWeight& g,
                                  PrimarySample& x) const {
  Rng rng(seed_, RngDomain::Bootstrap, stream(group, i), 0);
  x.draw(estimator_, rng);
  // A non-finite sample carries nothing; it is counted by whoever replays it.
  if (!std::isfinite(x.f_star()) || !(x.f_star() > 0)) return {};
  Rng choice(seed_, RngDomain::Bootstrap, stream(group, i), 1);
  return {x.f_star(), g(x, choice.uniform()), place(x)};
}

Bootstrap::Bootstrap(const Estimator& estimator, std::uint64_t seed, int samples_per_group,
                     const PictureImportance& importance, const BridgeWeight& g,
                     double least_effective)
    : estimator_(estimator), importance_(importance), seed_(seed) {
  std::array<std::vector<Sample>, Film::kGroups> samples;
  const auto lit = [](const std::vector<Sample>& group) {
    return std::ranges::any_of(group, [](const Sample& s) { return s.f_star > 0; });
  };
  std::uint64_t size = static_cast<std::uint64_t>(std::max(samples_per_group, 1));
  std::uint64_t done = 0;
  for (int doubling = 0;; ++doubling) {
    for (auto& group : samples) group.resize(size);
    const std::uint64_t blocks = (size - done + kBlock - 1) / kBlock;
    std::vector<BridgeSums> sums(blocks * Film::kGroups);
    parallel_for(static_cast<std::int64_t>(sums.size()), [&](std::int64_t task) {
      const int group = static_cast<int>(task % Film::kGroups);
      const std::uint64_t first = done + static_cast<std::uint64_t>(task / Film::kGroups) * kBlock;
      PrimarySample x(importance_);
      for (std::uint64_t i = first; i < std::min(first + kBlock, size); ++i) {
        const Sample sample = draw(group, i, g, x);
        samples[group][i] = sample;
        sums[task].add_sample(sample.f_star, sample.g);
      }
    });
    // In their order: no number of threads changes the result.
    for (std::size_t task = 0; task < sums.size(); ++task)
      normalization_.add(static_cast<int>(task % Film::kGroups), sums[task]);
    done = size;
    const bool all_lit = std::ranges::all_of(samples, lit);
    if (all_lit &&
        (doubling == kMaxDoublings || normalization_.effective_samples() >= least_effective))
      break;
    if (doubling == kMaxDoublings)
      throw Error(ErrorKind::NoLight, "no path that carries light was found in " +
                                          std::to_string(size * Film::kGroups) +
                                          " bootstrap samples of " + estimator.name());
    size *= 2;
  }
  for (int group = 0; group < Film::kGroups; ++group) {
    auto& [order, law] = starts_[group];
    const std::vector<Sample>& all = samples[group];
    for (std::uint64_t i = 0; i < size; ++i)
      if (all[i].f_star > 0) order.push_back(i);
    std::ranges::stable_sort(order, {}, [&](std::uint64_t i) { return all[i].place; });
    std::vector<double> f_star;
    for (const std::uint64_t i : order) f_star.push_back(all[i].f_star);
    law = DiscreteDistribution(f_star);
  }
}

PrimarySample Bootstrap::start(int group, double u) const {
  const Starts& starts = starts_[group];
  Rng rng(seed_, RngDomain::Bootstrap, stream(group, starts.samples[starts.law.sample(u)]), 0);
  PrimarySample x(importance_);
  x.draw(estimator_, rng);
  return x;
}

}  // namespace fogbow
