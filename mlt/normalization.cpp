// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/normalization.h"

#include "core/math/discrete_distribution.h"
#include "core/util/binary_io.h"
#include "core/util/parallel.h"

namespace fogbow {

void Normalization::add(int group, double f_star_sum, double square_sum, std::uint64_t samples) {
  sum_[group] += f_star_sum;
  squares_[group] += square_sum;
  samples_[group] += samples;
}

double Normalization::b(int group) const {
  return samples_[group] > 0 ? sum_[group] / static_cast<double>(samples_[group]) : 0;
}

double Normalization::b() const {
  double total = 0;
  for (const double s : sum_) total += s;
  return samples() > 0 ? total / static_cast<double>(samples()) : 0;
}

std::uint64_t Normalization::samples() const {
  std::uint64_t total = 0;
  for (const std::uint64_t n : samples_) total += n;
  return total;
}

double Normalization::standard_error() const {
  std::array<double, Film::kGroups> groups;
  for (int g = 0; g < Film::kGroups; ++g) groups[g] = b(g);
  return replicate_mean(groups).standard_error;
}

double Normalization::disagreement() const {
  double chi2 = 0;
  for (int g = 0; g < Film::kGroups; ++g) {
    const auto n = static_cast<double>(samples_[g]);
    const double variance = (squares_[g] / n - sqr(b(g))) / n;
    if (variance > 0) chi2 += sqr(b(g) - b()) / variance;
  }
  return chi2;
}

void Normalization::serialize(std::ostream& out) const {
  write_binary(out, sum_);
  write_binary(out, squares_);
  write_binary(out, samples_);
}

Normalization Normalization::deserialize(std::istream& in) {
  Normalization n;
  n.sum_ = read_binary<decltype(n.sum_)>(in);
  n.squares_ = read_binary<decltype(n.squares_)>(in);
  n.samples_ = read_binary<decltype(n.samples_)>(in);
  return n;
}

ReplicateMean replicate_mean(const std::array<double, Film::kGroups>& replicates) {
  constexpr double n = Film::kGroups;
  ReplicateMean result;
  for (const double r : replicates) result.mean += r / n;
  double squares = 0;
  for (const double r : replicates) squares += sqr(r - result.mean);
  result.standard_error = std::sqrt(squares / (n * (n - 1)));
  return result;
}

namespace {
constexpr int kMaxDoublings = 6;
constexpr std::uint64_t kBlock = 1024;
}  // namespace

std::uint64_t Bootstrap::stream(int group, std::uint64_t sample) const {
  return sample * Film::kGroups + static_cast<std::uint64_t>(group);
}

Bootstrap::Bootstrap(const Estimator& estimator, std::uint64_t seed, int samples_per_group)
    : estimator_(estimator), seed_(seed) {
  const auto lit = [](const std::vector<double>& f_star) {
    return std::any_of(f_star.begin(), f_star.end(), [](double f) { return f > 0; });
  };
  std::uint64_t size = static_cast<std::uint64_t>(std::max(samples_per_group, 1));
  std::uint64_t done = 0;
  for (int doubling = 0;; ++doubling) {
    for (auto& f_star : f_star_) f_star.resize(size);
    const std::uint64_t blocks = (size - done + kBlock - 1) / kBlock;
    parallel_for(static_cast<std::int64_t>(blocks * Film::kGroups), [&](std::int64_t task) {
      const int group = static_cast<int>(task % Film::kGroups);
      const std::uint64_t first = done + static_cast<std::uint64_t>(task / Film::kGroups) * kBlock;
      PrimarySample x;
      for (std::uint64_t i = first; i < std::min(first + kBlock, size); ++i) {
        Rng rng(seed_, RngDomain::Bootstrap, stream(group, i), 0);
        x.draw(estimator_, rng);
        // A non-finite sample carries nothing; it is counted by whoever replays it.
        f_star_[group][i] = std::isfinite(x.f_star()) ? x.f_star() : 0;
      }
    });
    done = size;
    if (std::all_of(f_star_.begin(), f_star_.end(), lit)) break;
    if (doubling == kMaxDoublings)
      throw Error(ErrorKind::NoLight, "no path that carries light was found in " +
                                          std::to_string(size * Film::kGroups) +
                                          " bootstrap samples of " + estimator.name());
    size *= 2;
  }
  for (int g = 0; g < Film::kGroups; ++g) {
    double sum = 0, squares = 0;
    for (const double f : f_star_[g]) {
      sum += f;
      squares += f * f;
    }
    normalization_.add(g, sum, squares, f_star_[g].size());
  }
}

PrimarySample Bootstrap::start(int group, std::uint64_t chain) const {
  Rng choice(seed_, RngDomain::WarmUp, chain, 0);
  const DiscreteDistribution law(f_star_[group]);
  Rng rng(seed_, RngDomain::Bootstrap, stream(group, law.sample(choice.uniform())), 0);
  PrimarySample x;
  x.draw(estimator_, rng);
  return x;
}

std::vector<std::vector<double>> pilot_techniques(const Estimator& estimator, std::uint64_t seed,
                                                  std::uint64_t samples) {
  using Table = std::vector<std::vector<double>>;
  const std::uint64_t blocks = (samples + kBlock - 1) / kBlock;
  std::vector<Table> tables(blocks);
  const auto entry = [](Table& table, std::size_t k, std::size_t s) -> double& {
    if (table.size() <= k) table.resize(k + 1);
    if (table[k].size() <= s) table[k].resize(s + 1);
    return table[k][s];
  };
  parallel_for(static_cast<std::int64_t>(blocks), [&](std::int64_t block) {
    PrimarySample x;
    for (std::uint64_t i = 0; i < kBlock; ++i) {
      Rng rng(seed, RngDomain::WarmUp, static_cast<std::uint64_t>(block) * kBlock + i, 1);
      x.draw(estimator, rng);
      for (const Contribution& c : x.contributions())
        entry(tables[block], c.k, c.s) += luminance(c.value);
    }
  });
  // Blocks are summed in their order: no number of threads changes the result.
  Table sum;
  for (const Table& table : tables)
    for (std::size_t k = 0; k < table.size(); ++k)
      for (std::size_t s = 0; s < table[k].size(); ++s) entry(sum, k, s) += table[k][s];
  return sum;
}

}  // namespace fogbow
