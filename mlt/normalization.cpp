// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/normalization.h"

#include <algorithm>

#include "core/math/vec.h"
#include "core/util/binary_io.h"

namespace fogbow {

namespace {

/// Standard error of a mean over it, from Σ x and Σ x².
double relative_error(double sum, double squares, std::uint64_t n) {
  if (!(sum > 0)) return 0;
  return std::sqrt(std::max(squares / sqr(sum) - 1 / static_cast<double>(n), 0.0));
}

}  // namespace

void BridgeSums::add(const BridgeSums& other) {
  f_star += other.f_star;
  squares += other.squares;
  sampled += other.sampled;
  sampled_squares += other.sampled_squares;
  samples += other.samples;
  visited += other.visited;
  states += other.states;
}

double BridgeSums::mean() const { return samples == 0 ? 0 : f_star / static_cast<double>(samples); }

double BridgeSums::b() const {
  if (samples == 0 || !(states > 0)) return mean();
  return sampled / static_cast<double>(samples) / (visited / states);
}

BridgeSums Normalization::all() const {
  BridgeSums sums;
  for (const BridgeSums& g : groups_) sums.add(g);
  return sums;
}

std::uint64_t Normalization::samples() const { return all().samples; }

bool Normalization::over_bridge() const {
  std::array<double, Film::kGroups> bridged, alone;
  for (int g = 0; g < Film::kGroups; ++g) {
    bridged[g] = groups_[g].b();
    alone[g] = groups_[g].mean();
  }
  const ReplicateMean by_bridge = replicate_mean(bridged), by_samples = replicate_mean(alone);
  const bool unsure = !(by_bridge.standard_error < kDisagreement * by_bridge.mean);
  return !unsure || by_bridge.standard_error <= by_samples.standard_error;
}

double Normalization::standard_error() const {
  std::array<double, Film::kGroups> groups;
  for (int g = 0; g < Film::kGroups; ++g) groups[g] = b(g);
  const BridgeSums sums = all();
  const double by_samples = over_bridge()
                                ? relative_error(sums.sampled, sums.sampled_squares, sums.samples)
                                : relative_error(sums.f_star, sums.squares, sums.samples);
  return std::max(replicate_mean(groups).standard_error, by_samples * b());
}

double Normalization::disagreement() const {
  const double mean = all().mean();
  double chi2 = 0;
  for (const BridgeSums& g : groups_) {
    const auto n = static_cast<double>(g.samples);
    const double variance = (g.squares / n - sqr(g.f_star / n)) / n;
    if (variance > 0) chi2 += sqr(g.f_star / n - mean) / variance;
  }
  return chi2;
}

void Normalization::serialize(std::ostream& out) const { write_binary(out, groups_); }

Normalization Normalization::deserialize(std::istream& in) {
  Normalization n;
  n.groups_ = read_binary<decltype(n.groups_)>(in);
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

}  // namespace fogbow
