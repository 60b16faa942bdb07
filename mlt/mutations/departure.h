// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "mlt/mutations/kernels.h"
#include "mlt/mutations/retrace.h"

namespace fogbow {

/// What to retrace() a segment along after a symmetric perturbation at its anchor: of the raster
/// position at the sensor, of the position across infinite light, of the direction elsewhere.
/// Nothing off the film.
std::optional<Vec3> perturb_departure(const PathSample& x, const Segment& segment,
                                      const StepSizes& angles, Rng& rng);

/// Of a measured path, segment_density() with the measure in which perturb_departure() is
/// symmetric.
double departure_density(const Scene& scene, const MeasuredPath& x, const Segment& segment);

/// Moves one segment from an anchor other than the sensor: perturbs, re-traces and joins it.
Proposal perturb_segment(const PathSample& x, PathSample& y, const Segment& segment,
                         const StepSizes& angles, Rng& rng);

}  // namespace fogbow
