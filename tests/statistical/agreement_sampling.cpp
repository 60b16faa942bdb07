// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/statistical/agreement_sampling.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "core/estimators/sampling.h"
#include "core/util/parallel.h"
#include "mlt/render.h"

namespace fogbow::testing {

namespace {

constexpr double kPower = 0.99;

bool near_lens(const Scene& scene, const Path& path) {
  const Vertex &last = path.back(), &before = path[path.size() - 2];
  return !before.infinite() &&
         length(last.position() - before.position()) < kNearLens * scene.radius();
}

}  // namespace

Reach reach(const Scene& scene, const Path& path) {
  const int k = static_cast<int>(path.size());
  const auto connects = [&](int s) {
    return !path[s - 1].degenerate && !path[s].degenerate && has_ray(path[s - 1], path[s]);
  };
  Reach r;
  r.path = hittable(scene, path[0]) || (k > 2 && connects(1));
  r.light = connects(k - 1) && !near_lens(scene, path);
  return r;
}

Replicates::Replicates(int replicates, int longest)
    : rows_(replicates, std::vector<double>(kFirstLength + longest + 1)) {}

void Replicates::add_pixel(int replicate, const Vec2& raster, const RGB& value) {
  std::vector<double>& row = rows_[replicate];
  const auto cell = [](double u) {
    return std::min(static_cast<int>(u * kTilesAcross), kTilesAcross - 1);
  };
  const double y = luminance(value);
  for (int c = 0; c < 3; ++c) row[c] += value[c];
  row[kMean] += y;
  row[kFirstTile + cell(raster.y) * kTilesAcross + cell(raster.x)] += y;
}

void Replicates::add_length(int replicate, int k, double value) {
  rows_[replicate][kFirstLength + k] += value;
}

void Replicates::scale(double factor) {
  for (auto& row : rows_)
    for (double& x : row) x *= factor;
}

Estimate Replicates::sum(const std::vector<int>& columns) const {
  std::vector<double> values(rows_.size());
  for (std::size_t r = 0; r < rows_.size(); ++r)
    for (const int c : columns) values[r] += rows_[r][c];
  return estimate(values);
}

std::vector<Replicates::Part> Replicates::parts() const {
  std::vector<Part> result;
  Part lengths{"the other lengths", false, {}}, tiles{"the dark tiles", false, {}};
  const double all = mean().mean;
  for (int c = kFirstTile; c < static_cast<int>(rows_[0].size()); ++c) {
    const bool tile = c < kFirstLength;
    const double value = sum({c}).mean;
    if (value > all * (tile ? kNotableTile / kTiles : kNotableLength))
      result.push_back({tile ? "tile " + std::to_string(c - kFirstTile)
                             : "k = " + std::to_string(c - kFirstLength),
                        true,
                        {c}});
    else
      (tile ? tiles : lengths).columns.push_back(c);
  }
  for (Part* rest : {&lengths, &tiles})
    if (!rest->columns.empty()) result.push_back(std::move(*rest));
  return result;
}

Sampling sample(const Scene& scene, const Estimator& estimator, bool classified, int longest,
                int replicates, std::uint64_t samples, std::uint64_t seed) {
  Sampling result(classified ? 3 : 1, Replicates(replicates, longest));
  parallel_for(replicates, [&](std::int64_t r) {
    Workspace w;
    for (std::uint64_t i = 0; i < samples; ++i) {
      Rng rng(seed, RngDomain::Test, static_cast<std::uint64_t>(r), i);
      RandomStream stream(rng);
      estimator.sample(stream, stream, w);
      for (const Contribution& c : w.contributions) {
        const auto add = [&](Restriction which) {
          Replicates& into = result[static_cast<std::size_t>(which)];
          into.add_pixel(static_cast<int>(r), c.raster, c.value);
          into.add_length(static_cast<int>(r), c.k, luminance(c.value));
        };
        add(Restriction::All);
        if (!classified) continue;
        const Reach can = reach(scene, assemble(scene, w.light, c.s, w.eye, c.t));
        if (can.path) add(Restriction::ByPath);
        if (can.light) add(Restriction::ByLight);
      }
    }
    FOGBOW_CHECK(w.refused == 0);
  });
  for (Replicates& all : result) all.scale(1.0 / static_cast<double>(samples));
  return result;
}

Sampling render_chains(const Scene& scene, const ChainSettings& settings, int replicates,
                       std::uint64_t mutations, std::uint64_t seed) {
  // A short bootstrap's starts are biased as 1/samples, more than the errors here allow where the
  // light is in few paths; one of its samples takes as long as several mutations.
  constexpr std::uint64_t kBootstrap = 1 << 16, kMutationsPerSample = 8;
  Replicates all(replicates, settings.longest);
  const auto [width, height] = rendered_size(scene.film());
  const double pixels = static_cast<double>(width) * height;
  RenderOptions options;
  options.integrator = settings.integrator;
  options.overrides = {
      {"max_depth", std::to_string(settings.longest - 1)},
      {"two_stage", settings.two_stage ? "true" : "false"},
      {"chains", "8"},
      {"luminance_samples", std::to_string(std::max(kBootstrap, mutations / kMutationsPerSample))}};
  options.samples_per_pixel = static_cast<double>(mutations) / pixels;
  for (int r = 0; r < replicates; ++r) {
    options.seed = seed + static_cast<std::uint64_t>(r) * 0x9E3779B97F4A7C15;
    const RenderResult result = render(scene, options);
    FOGBOW_CHECK(result.non_finite == 0);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const RGB value(result.image.at(x, y, 0), result.image.at(x, y, 1),
                        result.image.at(x, y, 2));
        all.add_pixel(r, Vec2((x + 0.5) / width, (y + 0.5) / height), value / pixels);
      }
    for (const ClassShare& c : result.lengths) all.add_length(r, c.k, c.value);
  }
  return {all};
}

Sampling sample_until(const Sampler& sampler, std::uint64_t pilot_samples, Precision precision,
                      double level, std::uint64_t seed) {
  constexpr double kSafety = 2;  // the pilot's own errors are uncertain
  const auto growth = [&](const Estimate& e, double bias) {
    return samples_needed(e, bias * e.mean, level, kPower);
  };
  const Sampling pilot = sampler(pilot_samples, seed);
  double most = 1;
  for (const Replicates& r : pilot) {
    most = std::max(most, growth(r.mean(), precision.mean));
    for (const auto& part : r.parts())
      if (part.notable) most = std::max(most, growth(r.sum(part.columns), precision.part));
  }
  return sampler(static_cast<std::uint64_t>(kSafety * most * static_cast<double>(pilot_samples)),
                 seed + 1);
}

int expect_agreement(const std::string& name, const Replicates& a, const Replicates& b,
                     Precision precision, double level) {
  int tests = 0;
  double least_p = 1, least_power = 1;
  const auto expect = [&](const std::string& what, const Estimate& x, const Estimate& y,
                          double bias) {
    const double p = welch(x, y);
    EXPECT_GT(p, level) << name << ", " << what << ": " << x.mean << " ± " << x.standard_error
                        << " against " << y.mean << " ± " << y.standard_error;
    least_p = std::min(least_p, p);
    ++tests;
    if (!(bias > 0)) return;
    const double detected = power(x, y, bias * x.mean, level);
    EXPECT_GE(detected, kPower) << name << ", " << what << ": a bias of " << bias
                                << " would escape; standard errors " << x.standard_error / x.mean
                                << " and " << y.standard_error / x.mean << " of the value";
    least_power = std::min(least_power, detected);
  };
  expect("image mean", a.mean(), b.mean(), precision.mean);
  for (int c = 0; c < 3; ++c) expect("channel", a.channel(c), b.channel(c), 0);
  for (const auto& part : a.parts())
    expect(part.name, a.sum(part.columns), b.sum(part.columns), part.notable ? precision.part : 0);
  std::printf(
      "%-44s %3d tests, least p %.2g; ratio of means %.4f; a bias of %g%% of the mean, %g%% "
      "of a part is found with probability %.4f\n",
      name.c_str(), tests, least_p, b.mean().mean / a.mean().mean, 100 * precision.mean,
      100 * precision.part, least_power);
  std::fflush(stdout);
  return tests;
}

}  // namespace fogbow::testing
