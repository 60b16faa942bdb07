// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/bootstrap.h"

#include <algorithm>

#include "core/math/discrete_distribution.h"
#include "core/util/parallel.h"

namespace fogbow {

namespace {
constexpr int kMaxDoublings = 6;
constexpr std::uint64_t kBlock = 1024;
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
  return {x.f_star(), g(x, choice.uniform())};
}

Bootstrap::Bootstrap(const Estimator& estimator, std::uint64_t seed, int samples_per_group,
                     const PictureImportance& importance, const BridgeWeight& g)
    : estimator_(estimator), importance_(importance), seed_(seed) {
  const auto lit = [](const std::vector<double>& f_star) {
    return std::any_of(f_star.begin(), f_star.end(), [](double f) { return f > 0; });
  };
  std::uint64_t size = static_cast<std::uint64_t>(std::max(samples_per_group, 1));
  std::uint64_t done = 0;
  for (int doubling = 0;; ++doubling) {
    for (auto& f_star : f_star_) f_star.resize(size);
    const std::uint64_t blocks = (size - done + kBlock - 1) / kBlock;
    std::vector<BridgeSums> sums(blocks * Film::kGroups);
    parallel_for(static_cast<std::int64_t>(sums.size()), [&](std::int64_t task) {
      const int group = static_cast<int>(task % Film::kGroups);
      const std::uint64_t first = done + static_cast<std::uint64_t>(task / Film::kGroups) * kBlock;
      PrimarySample x(importance_);
      for (std::uint64_t i = first; i < std::min(first + kBlock, size); ++i) {
        const Sample sample = draw(group, i, g, x);
        f_star_[group][i] = sample.f_star;
        sums[task].add_sample(sample.f_star, sample.g);
      }
    });
    // In their order: no number of threads changes the result.
    for (std::size_t task = 0; task < sums.size(); ++task)
      normalization_.add(static_cast<int>(task % Film::kGroups), sums[task]);
    done = size;
    if (std::all_of(f_star_.begin(), f_star_.end(), lit)) break;
    if (doubling == kMaxDoublings)
      throw Error(ErrorKind::NoLight, "no path that carries light was found in " +
                                          std::to_string(size * Film::kGroups) +
                                          " bootstrap samples of " + estimator.name());
    size *= 2;
  }
}

PrimarySample Bootstrap::start(int group, std::uint64_t chain, std::uint64_t attempt) const {
  Rng choice(seed_, RngDomain::WarmUp, chain, 4 * attempt);
  const DiscreteDistribution law(f_star_[group]);
  Rng rng(seed_, RngDomain::Bootstrap, stream(group, law.sample(choice.uniform())), 0);
  PrimarySample x(importance_);
  x.draw(estimator_, rng);
  return x;
}

}  // namespace fogbow
