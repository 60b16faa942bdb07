// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <optional>
#include <span>

#include "core/path/techniques.h"
#include "mlt/mutation.h"
#include "mlt/path_sample.h"

namespace fogbow {

/// A stretch of a path from a vertex that stays, the anchor, through degenerate vertices to the
/// first that is not: what a change of direction at the anchor moves.
struct Segment {
  int anchor, end;
  Side toward;

  int step() const { return toward == Side::Eye ? 1 : -1; }
  int length() const { return toward == Side::Eye ? end - anchor : anchor - end; }
};

/// Index of the edge that leads to the segment's end.
inline int last_edge(const Segment& s) { return std::min(s.end, s.end - s.step()); }

/// From `anchor`; nothing where only degenerate vertices follow or none at all.
std::optional<Segment> segment_from(const MeasuredPath& x, int anchor, Side toward);

/// Whether the segment can be moved: its end is joined to a vertex beyond it that scatters smoothly
/// and stays, or is where the eye's subpath runs into the light.
bool movable(const Scene& scene, const MeasuredPath& x, const Segment& segment);

/// Direction at the anchor along the segment.
Vec3 departure(const MeasuredPath& x, const Segment& segment);

/// Traces y's vertices of the segment from y's anchor along w: the kinds and events of those that y
/// holds there, which they replace; medium vertices keep their distance. From parallel ends w is an
/// offset across the rays.
std::optional<Rejection> retrace(const Scene& scene, MeasuredPath& y, const Segment& segment,
                                 const Vec3& w);

/// The same without the segment's end: `w` becomes the direction in which the last vertex between
/// sends it on. Glossy vertices scatter by `facets`, one for each vertex between.
std::optional<Rejection> retrace_chain(const Scene& scene, MeasuredPath& y, const Segment& segment,
                                       Vec3& w, std::span<const Vec3> facets = {});

/// Density in μ of the segment's vertices when its direction at the anchor has density one in solid
/// angle (across the rays of parallel ends) and distances and events are kept.
double segment_density(const Scene& scene, const MeasuredPath& x, const Segment& segment);

/// Where light of an infinite emitter's vertex starts that is to reach `target`.
Vertex beyond_scene(const Scene& scene, const Vertex& light, const Vec3& target);

/// Measures what changed, vertices first … last of y and the edges between them, and joins what
/// moved to the vertex beyond: `joint` is the edge to be connected, −1 for none.
std::optional<Rejection> complete(PathSample& y, int first, int last, int joint);

/// complete() after the segment, and all between it and `origin`, has moved.
std::optional<Rejection> complete_segment(PathSample& y, const Segment& segment, int origin);

}  // namespace fogbow
