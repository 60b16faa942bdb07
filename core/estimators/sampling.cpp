// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/estimators/sampling.h"

#include "core/math/random.h"
#include "core/util/parallel.h"

namespace fogbow {

namespace {

void add_at(std::vector<double>& sums, int k, double value) {
  if (sums.size() <= static_cast<std::size_t>(k)) sums.resize(k + 1);
  sums[k] += value;
}

void add_to(LengthTally& sums, const LengthTally& more) {
  for (int g = 0; g < Film::kGroups; ++g)
    for (std::size_t k = 0; k < more[g].size(); ++k)
      add_at(sums[g], static_cast<int>(k), more[g][k]);
}

}  // namespace

struct IndependentSampling::Row {
  std::array<LengthTally, 2> tallies;
  std::uint64_t refused = 0;
};

std::pair<int, int> rendered_size(const FilmSettings& s) {
  return s.crop_width > 0 ? std::pair(s.crop_width, s.crop_height) : std::pair(s.width, s.height);
}

IndependentSampling::IndependentSampling(const Estimator& estimator, const FilmSettings& settings,
                                         std::uint64_t seed, int unit_exponent, int only_length)
    : estimator_(estimator),
      film_(settings, unit_exponent),
      seed_(seed),
      only_length_(only_length) {
  std::tie(width_, height_) = rendered_size(settings);
}

void IndependentSampling::run_row(int row, Row& result) {
  Workspace w;
  const Vec2 size(1.0 / width_, 1.0 / height_);
  for (int column = 0; column < width_; ++column) {
    const auto pixel = static_cast<std::uint64_t>(row) * width_ + column;
    const int group = static_cast<int>((pixel + round_) % Film::kGroups);
    Rng rng(seed_, RngDomain::Sampling, pixel, round_);
    Rng offsets(seed_, RngDomain::Film, pixel, round_);
    PixelStream eye(rng, Vec2(column, row) * size, size);
    RandomStream light(rng);
    estimator_.sample(light, eye, w);
    for (const Contribution& c : w.contributions) {
      add_at(result.tallies[c.glow][group], c.k, luminance(c.value));
      if (only_length_ > 0 && c.k != only_length_) continue;
      film_.splat(c.raster, c.value, group, uniform2(offsets));
    }
  }
  result.refused = w.refused;
}

void IndependentSampling::run_round() {
  std::vector<Row> rows(height_);
  parallel_for(height_, [&](std::int64_t row) { run_row(static_cast<int>(row), rows[row]); });
  // Rows are summed in their order: the tally does not depend on threads either.
  for (const Row& row : rows) {
    refused_ += row.refused;
    for (const bool glow : {false, true}) add_to(tallies_[glow], row.tallies[glow]);
  }
  samples_ += static_cast<std::uint64_t>(width_) * height_;
  ++round_;
}

LengthTally IndependentSampling::tally() const {
  LengthTally sum = tallies_[false];
  add_to(sum, tallies_[true]);
  return sum;
}

Image IndependentSampling::develop() const {
  const double scale = 1 / static_cast<double>(samples_);
  return film_.develop(scale, std::vector<double>(Film::kGroups, scale * Film::kGroups));
}

double mean_luminance(const Estimator& estimator, std::uint64_t seed, std::uint64_t most) {
  Workspace w;
  double sum = 0;
  std::uint64_t n = 0;
  while (n < kLuminancePilot || (sum == 0 && n < most)) {
    Rng rng(seed, RngDomain::Bootstrap, n++, 0);
    RandomStream stream(rng);
    estimator.sample(stream, stream, w);
    for (const Contribution& c : w.contributions) sum += luminance(c.value);
  }
  return sum / static_cast<double>(n);
}

int luminance_exponent(const Estimator& estimator, std::uint64_t seed) {
  constexpr std::uint64_t kMost = kLuminancePilot << 8;
  const double mean = mean_luminance(estimator, seed, kMost);
  if (!(mean > 0))
    throw Error(ErrorKind::NoLight, "no path that carries light was found in " +
                                        std::to_string(kMost) + " samples of " + estimator.name());
  return std::ilogb(mean) + 1;
}

}  // namespace fogbow
