// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <span>

#include "core/path/measured_path.h"

namespace fogbow {

/// The vertices x[first] … x[end − 1] of a path, all that lies outside being given.
struct Range {
  int first, end;
  int size() const { return end - first; }
};

/// Whether vertices below `split` can come from the light and the others from the eye: the two ends
/// that are joined there must scatter smoothly; with split 0 the eye must be able to run into the
/// light.
bool joinable(const Scene& scene, const MeasuredPath& path, int split);

/// Which of several infinite emitters an escaped eye subpath ends on, uniformly; takes one number
/// if x is at infinity.
void choose_infinite_emitter(const Scene& scene, Vertex& x, SampleStream& u);

/// log Σ_l weights[l] p_l: p_l is the density in μ with which l vertices of the range are sampled
/// from the light's side and the rest from the eye's, roulette included. weights has size() + 1
/// entries; −∞ where no l can sample the range. With the whole path as range, l = s. Eye subpaths
/// choose_infinite_emitter().
double log_range_density(const Scene& scene, const MeasuredPath& path, Range range,
                         std::span<const double> weights);

/// One l in proportion to weights[l] p_l, and log_range_density(), which must not be −∞.
struct SplitChoice {
  int l;
  double log_density;
};
SplitChoice choose_split(const Scene& scene, const MeasuredPath& path, Range range,
                         std::span<const double> weights, double u);

/// The number with which choose_infinite_emitter() takes x's, uniform on its interval by
/// `auxiliary`.
double invert_infinite_emitter(const Scene& scene, const Vertex& x, double auxiliary);

}  // namespace fogbow
