// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/light_census.h"

#include <algorithm>
#include <numeric>

#include "core/estimators/sampling.h"
#include "core/path/path.h"
#include "core/util/parallel.h"

namespace fogbow {

namespace {

/// Sums of one group of samples.
struct Tally {
  double luminance = 0, seen_light = 0, seen_glow = 0, by_next_event = 0, surface_caustic = 0,
         volume_caustic = 0, caustic_seen_through = 0, in_media = 0;
  std::uint64_t dirac_lights = 0, dirac_lit_through = 0, seen_through = 0;
  std::vector<double> totals;  ///< luminance of each sample
};

/// Adds a path of this luminance to the sums that it belongs to.
void classify(const Scene& scene, const Path& path, double value, Tally& tally) {
  const std::size_t last = path.size() - 1;
  tally.luminance += value;
  const bool in_media =
      std::any_of(path.begin(), path.end(), [](const Vertex& x) { return x.in_medium(); });
  tally.in_media += in_media ? value : 0;
  std::size_t first_smooth = 1;
  while (first_smooth < last && path[first_smooth].degenerate) ++first_smooth;
  if (first_smooth == last) {
    if (hittable(scene, path[0]))
      (path[0].in_medium() ? tally.seen_glow : tally.seen_light) += value;
    return;
  }
  if (first_smooth == 1) {
    tally.by_next_event += value;
    return;
  }
  (path[first_smooth].in_medium() ? tally.volume_caustic : tally.surface_caustic) += value;
  tally.caustic_seen_through += path[last - 1].degenerate ? value : 0;
}

/// Whether the subpath has to go on by specular scattering from where it first came to, or did.
bool meets_specular(const Scene& scene, const Subpath& path) {
  return path.size() > 1 && (path[1].x.degenerate || !connectible(scene, path[1].x));
}

void count_ends(const Scene& scene, const Workspace& w, Tally& tally) {
  if (!w.light.empty() && is_dirac(scene.emitter(w.light[0].x.emitter).kind())) {
    ++tally.dirac_lights;
    tally.dirac_lit_through += meets_specular(scene, w.light);
  }
  tally.seen_through += meets_specular(scene, w.eye);
}

Tally take_group(const Scene& scene, const Estimator& bdpt, std::uint64_t samples,
                 std::uint64_t seed, int group) {
  Tally tally;
  Workspace w;
  for (std::uint64_t i = 0; i < samples; ++i) {
    Rng rng(seed, RngDomain::Sampling, static_cast<std::uint64_t>(group), i);
    RandomStream stream(rng);
    bdpt.sample(stream, stream, w);
    count_ends(scene, w, tally);
    double total = 0;
    for (const Contribution& c : w.contributions) {
      Path path = assemble(scene, w.light, c.s, w.eye, c.t);
      if (c.infinite_emitter >= 0) path[0].emitter = c.infinite_emitter;
      const double value = luminance(c.value);
      classify(scene, path, value, tally);
      total += value;
    }
    tally.totals.push_back(total);
  }
  return tally;
}

double part_that_holds_half(std::vector<double> totals) {
  std::ranges::sort(totals, std::greater());
  const double half = 0.5 * std::accumulate(totals.begin(), totals.end(), 0.0);
  double sum = 0;
  std::size_t n = 0;
  while (n < totals.size() && sum < half) sum += totals[n++];
  return static_cast<double>(n) / static_cast<double>(totals.size());
}

double ratio(std::uint64_t part, std::uint64_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0;
}

}  // namespace

LightCensus take_light_census(const Scene& scene, const EstimatorSettings& settings,
                              std::uint64_t samples, std::uint64_t seed) {
  const auto bdpt = make_bdpt(scene, settings);
  const std::uint64_t each = std::max<std::uint64_t>(samples / Film::kGroups, 1);
  std::array<Tally, Film::kGroups> groups;
  parallel_for(Film::kGroups, [&](std::int64_t g) {
    groups[g] = take_group(scene, *bdpt, each, seed, static_cast<int>(g));
  });

  const auto mean = [&](double Tally::*part) {
    std::array<double, Film::kGroups> values;
    for (int g = 0; g < Film::kGroups; ++g) values[g] = groups[g].*part / static_cast<double>(each);
    return replicate_mean(values);
  };
  const auto sum = [&](std::uint64_t Tally::*part) {
    return std::accumulate(groups.begin(), groups.end(), std::uint64_t{0},
                           [&](std::uint64_t n, const Tally& t) { return n + t.*part; });
  };
  LightCensus census;
  census.luminance = mean(&Tally::luminance);
  census.seen_light = mean(&Tally::seen_light);
  census.seen_glow = mean(&Tally::seen_glow);
  census.by_next_event = mean(&Tally::by_next_event);
  census.surface_caustic = mean(&Tally::surface_caustic);
  census.volume_caustic = mean(&Tally::volume_caustic);
  census.caustic_seen_through = mean(&Tally::caustic_seen_through);
  census.in_media = mean(&Tally::in_media);
  std::vector<double> totals;
  for (const Tally& t : groups) totals.insert(totals.end(), t.totals.begin(), t.totals.end());
  census.half_in = part_that_holds_half(std::move(totals));
  census.dirac_lit_through = ratio(sum(&Tally::dirac_lit_through), sum(&Tally::dirac_lights));
  census.seen_through = ratio(sum(&Tally::seen_through), each * Film::kGroups);
  return census;
}

}  // namespace fogbow
