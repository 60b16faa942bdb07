// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/laws/path_population.h"

#include <algorithm>
#include <map>

#include "core/math/random.h"

namespace fogbow::testing {

namespace {

constexpr std::uint64_t kPilot = 1 << 13;

double total(const std::vector<std::vector<double>>& table) {
  double sum = 0;
  for (const auto& row : table)
    for (const double v : row) sum += v;
  return sum;
}

}  // namespace

PathPopulation::PathPopulation(const Scene& scene, int max_depth, std::uint64_t seed,
                               bool two_stage)
    : scene_(scene),
      max_depth_(max_depth),
      seed_(seed),
      bdpt_(make_bdpt(scene, {.max_depth = max_depth, .seen_light = false})),
      mean_f_star_(0),
      techniques_({}, max_depth + 1) {
  pilot_ = run_pilot(*bdpt_, 1, seed, kPilot);
  if (!two_stage) pilot_.importance = {};
  mean_f_star_ = total(pilot_.techniques) / kPilot;
  techniques_ = TechniqueDistribution(pilot_.techniques, max_depth + 1);
}

void PathPopulation::draw(std::uint64_t sample, double mean_parts,
                          std::vector<PathSample>& parts) const {
  parts.clear();
  Rng rng(seed_, RngDomain::Test, sample, 0);
  PrimarySample x(pilot_.importance);
  x.draw(*bdpt_, rng);
  const double expected = mean_parts * x.f_star() / mean_f_star_;
  const int n = static_cast<int>(expected + rng.uniform());
  for (int i = 0; i < n; ++i)
    if (auto part = PathSample::choose(scene_, max_vertices(), x, (i + rng.uniform()) / n))
      parts.push_back(*std::move(part));
}

std::vector<PathSample> PathPopulation::of_every_configuration(std::uint64_t samples,
                                                               int most) const {
  std::map<std::uint64_t, int> seen;
  std::vector<PathSample> chosen, parts;
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    draw(sample, 1, parts);
    for (const PathSample& x : parts)
      if (++seen[x.selection_key()] <= most) chosen.push_back(x);
  }
  return chosen;
}

std::string test_name(const TestScene& scene) {
  std::string name = scene.name;
  std::ranges::replace(name, '-', '_');
  return name;
}

std::vector<Feature> path_features(const Scene& scene) {
  using P = MeasuredPath;
  std::vector<Feature> features;
  const auto add = [&](std::string name, std::function<double(const P&)> value) {
    features.push_back({std::move(name), std::move(value)});
  };
  const Vec3 center = scene.bounds().center();
  const double radius = scene.radius();
  add("raster x", [](const P& p) { return p.raster().x; });
  add("raster y", [](const P& p) { return p.raster().y; });
  add("raster x fine", [](const P& p) { return std::sin(40 * p.raster().x); });
  add("raster y fine", [](const P& p) { return std::sin(40 * p.raster().y); });
  for (const int end : {0, 1}) {
    const std::string side = end ? "eye" : "light";
    const auto vertex = [end](const P& p, int i) { return end ? p.last() - i : i; };
    for (int i = 0; i < 4; ++i) {
      const std::string place = std::to_string(i) + " from " + side;
      const auto edge = [end](const P& p, int j) -> const Edge& {
        return p.edge(end ? p.last() - 1 - j : j);
      };
      add("depth of edge " + place, [=](const P& p) {
        if (i >= p.last()) return 0.0;
        const double t = edge(p, i).length / radius;
        return std::isfinite(t) ? t / (1 + t) : 1.0;
      });
      add("transmittance of edge " + place,
          [=](const P& p) { return i < p.last() ? mean(edge(p, i).tau) : 0.0; });
      for (int axis = 0; axis < 3; ++axis)
        add("xyz"[axis] + (" of vertex " + place), [=](const P& p) {
          if (i >= p.size()) return 0.0;
          const Vertex& x = p[vertex(p, i)];
          const Vec3 at = x.infinite() ? x.point.n_g : (x.position() - center) / radius;
          return std::tanh(at[axis]);
        });
      add("cosine at vertex " + place, [=](const P& p) {
        const int v = vertex(p, i);
        return v <= 0 || v >= p.last() ? 0.0 : dot(p.to_light(v), p.to_eye(v));
      });
      add("kind of vertex " + place,
          [=](const P& p) { return i < p.size() ? 1.0 * p[vertex(p, i)].in_medium() : 0.0; });
    }
  }
  // Every class: k, c and what is degenerate.
  for (int k = 2; k <= 6; ++k) {
    for (std::uint32_t bits = 0; bits < 1u << (2 * (k - 2)); ++bits) {
      const std::uint32_t c = bits & ((1u << (k - 2)) - 1), degenerate = bits >> (k - 2);
      if (c & degenerate) continue;
      add("class " + std::to_string(k) + " c=" + std::to_string(c) +
              " degenerate=" + std::to_string(degenerate),
          [=](const P& p) {
            if (p.size() != k) return 0.0;
            for (int i = 1; i + 1 < k; ++i)
              if (p[i].in_medium() != (c >> (i - 1) & 1) ||
                  p[i].degenerate != (degenerate >> (i - 1) & 1))
                return 0.0;
            return 1.0;
          });
    }
    add("k = " + std::to_string(k), [k](const P& p) { return p.size() == k ? 1.0 : 0.0; });
  }
  add("emission in a medium", [](const P& p) { return p[0].in_medium() ? 1.0 : 0.0; });
  return features;
}

}  // namespace fogbow::testing
