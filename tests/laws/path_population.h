// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mlt/path_sample.h"
#include "mlt/pilot.h"
#include "mlt/registry.h"
#include "mlt/technique_distribution.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow::testing {

/// Paths distributed like f*, drawn by BDPT: every sample is split into as many equal parts as its
/// luminance asks for, so that all paths weigh the same. Parts of one sample stay together, for
/// they are not independent.
class PathPopulation {
 public:
  /// Not `two_stage`: f* is luminance alone.
  PathPopulation(const Scene& scene, int max_depth, std::uint64_t seed, bool two_stage = true);

  int max_vertices() const { return max_depth_ + 1; }
  /// To be written, with the same target.
  PathSample blank() const { return {scene_, max_vertices(), pilot_.importance}; }
  const TechniqueDistribution& techniques() const { return techniques_; }
  /// b, as the pilot knows it: what one part stands for where mean_parts is one.
  double mean_f_star() const { return mean_f_star_; }
  /// One BDPT sample's paths, on average `mean_parts` of them.
  void draw(std::uint64_t sample, double mean_parts, std::vector<PathSample>& parts) const;
  /// Up to `most` paths of every configuration that so many samples hold.
  std::vector<PathSample> of_every_configuration(std::uint64_t samples, int most) const;

 private:
  const Scene& scene_;
  int max_depth_;
  std::uint64_t seed_;
  std::unique_ptr<Estimator> bdpt_;
  double mean_f_star_;
  Pilot pilot_;
  TechniqueDistribution techniques_;
};

/// Numbers that tell paths apart: class, raster position, lengths, places, angles.
struct Feature {
  std::string name;
  std::function<double(const MeasuredPath&)> value;
};
std::vector<Feature> path_features(const Scene& scene);

/// As GoogleTest wants it.
std::string test_name(const TestScene& scene);

}  // namespace fogbow::testing
