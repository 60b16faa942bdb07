// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/departure.h"

#include <algorithm>

#include "core/estimators/sampling.h"

namespace fogbow {

namespace {

const StepSizes kOffsets(1e-4, 0.3);  ///< of parallel light, in radii of the scene

/// Between a pixel and a tenth of the picture's size.
std::optional<Vec3> step_on_film(const PathSample& x, Rng& rng) {
  const auto [width, height] = rendered_size(x.scene().film());
  const double size = std::sqrt(static_cast<double>(width) * height);
  const StepSizes pixels(1, std::max(0.1 * size, 2.0));
  const Vec2 raster = x.raster() + planar_step(pixels, rng) / Vec2(width, height);
  if (!(raster.x >= 0 && raster.x < 1 && raster.y >= 0 && raster.y < 1)) return std::nullopt;
  const Vertex& eye = x.path()[x.path().last()];
  const SensorRay ray = x.scene().sensor().sample_direction(eye.position(), raster);
  return eye.parallel() ? ray.origin - eye.position() : ray.w;
}

}  // namespace

std::optional<Vec3> perturb_departure(const PathSample& x, const Segment& segment,
                                      const StepSizes& angles, Rng& rng) {
  const MeasuredPath& path = x.path();
  if (segment.anchor == path.last()) return step_on_film(x, rng);
  const Vec3 w = departure(path, segment);
  if (!path[segment.anchor].infinite()) return perturb_direction(w, angles, rng);
  const Vec2 step = x.scene().radius() * planar_step(kOffsets, rng);
  const Frame across(w);
  return step.x * across.s + step.y * across.t;
}

double departure_density(const Scene& scene, const MeasuredPath& x, const Segment& segment) {
  const double density = segment_density(scene, x, segment);
  const int i = segment.anchor;
  return i == x.last() ? density * x.scattering(i).pdf_to_light : density;
}

Proposal perturb_segment(const PathSample& x, PathSample& y, const Segment& segment,
                         const StepSizes& angles, Rng& rng) {
  const Scene& scene = x.scene();
  y = x;
  const Vec3 w = *perturb_departure(x, segment, angles, rng);
  if (const auto why = retrace(scene, y.path(), segment, w)) return refuse(*why);
  if (const auto why = complete_segment(y, segment, segment.anchor)) return refuse(*why);
  return {std::log(segment_density(scene, x.path(), segment) /
                   segment_density(scene, y.path(), segment)),
          std::nullopt};
}

}  // namespace fogbow
