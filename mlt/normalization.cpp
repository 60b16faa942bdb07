// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/normalization.h"

#include <algorithm>

#include "core/math/vec.h"
#include "core/util/binary_io.h"

namespace fogbow {

namespace {

/// Of the mean of independent numbers, from their Σ x and Σ x².
double variance_of_mean(double sum, double squares, std::uint64_t samples) {
  const auto n = static_cast<double>(samples);
  return std::max(squares / n - sqr(sum / n), 0.0) / n;
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
  const double between = replicate_mean(groups).standard_error;
  const BridgeSums sums = all();
  const bool bridged = over_bridge();
  const double sum = bridged ? sums.sampled : sums.f_star;
  const double squares = bridged ? sums.sampled_squares : sums.squares;
  if (!(sum > 0)) return between;
  const double error = std::sqrt(variance_of_mean(sum, squares, sums.samples));
  return std::max(between, error / (sum / static_cast<double>(sums.samples)) * b());
}

double Normalization::disagreement() const {
  const double mean = all().mean();
  double chi2 = 0;
  for (const BridgeSums& g : groups_) {
    const double variance = variance_of_mean(g.f_star, g.squares, g.samples);
    if (variance > 0) chi2 += sqr(g.mean() - mean) / variance;
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
