// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/retrace.h"

#include <limits>

namespace fogbow {

namespace {

/// Radii of the scene from a point in it to beyond it.
constexpr double kBeyond = 4;

bool transmits(const MeasuredPath& x, int i) {
  const Vec3& n = x[i].point.shading.n;
  return dot(x.to_light(i), n) * dot(x.to_eye(i), n) < 0;
}

/// A vertex of the kind that `next` is, which it replaces.
std::optional<Rejection> follow(const Scene& scene, const Vertex& start, const Vec3& w,
                                Vertex& next, Edge& edge) {
  double near = 0, far = kInfinity;
  if (start.on_sensor()) {
    near = scene.sensor().near_distance(w);
    far = scene.sensor().far_distance(w);
  }
  if (next.in_medium()) {
    const double t = edge.length;
    if (t > far) return Rejection::WrongConfiguration;
    const auto moved = medium_vertex_at(scene, start, w, t, near, edge);
    if (!moved) return Rejection::Occluded;
    next = *moved;
    return std::nullopt;
  }
  // As many passages as before, or the way back would stop elsewhere; all of them to infinity.
  const std::int64_t passages =
      next.infinite() ? std::numeric_limits<std::int64_t>::max() : edge.passages;
  Vertex found;
  const ExtendResult result = extend_to_surface(scene, start, w, found, edge, near, far, passages);
  if (next.infinite()) {
    if (result == ExtendResult::Reached) return Rejection::Occluded;
    found.kind = VertexKind::InfiniteLight;
    found.point.n_g = -w;
    found.emitter = next.emitter;
    edge.length = kInfinity;
  } else if (result != ExtendResult::Reached) {
    return Rejection::MissedScene;
  } else if (edge.passages != passages) {
    return Rejection::WrongConfiguration;
  }
  found.degenerate = next.degenerate;
  next = found;
  return std::nullopt;
}

/// Direction in which a segment arrives at its vertex i.
Vec3 arrival(const MeasuredPath& y, const Segment& s, int i) {
  return s.toward == Side::Eye ? y.edge(i - 1).w : -y.edge(i).w;
}

/// The vertex after i on the segment, along w (an offset where i is parallel).
std::optional<Rejection> trace_vertex(const Scene& scene, MeasuredPath& y, const Segment& s, int i,
                                      const Vec3& w) {
  const int next = i + s.step(), link = std::min(i, next);
  Edge edge = y.edge(link);
  if (y[i].infinite()) {
    const Vertex start = beyond_scene(scene, y[i], y[next].position() + w);
    edge.length = kBeyond * scene.radius();
    if (const auto why = follow(scene, start, y[i].point.n_g, y.vertex(next), edge)) return why;
    edge.length = kInfinity;
  } else if (y[i].parallel()) {
    y.vertex(i).point.position += w;
    if (const auto why = follow(scene, y[i], y[i].point.n_g, y.vertex(next), edge)) return why;
  } else if (const auto why = follow(scene, y[i], w, y.vertex(next), edge)) {
    return why;
  }
  y.set_edge(link, s.toward == Side::Eye ? edge : reversed(edge));
  return std::nullopt;
}

}  // namespace

Vertex beyond_scene(const Scene& scene, const Vertex& light, const Vec3& target) {
  Vertex start = light;
  start.point.position = target - kBeyond * scene.radius() * light.point.n_g;
  start.medium = scene.medium_around_emitter(light.emitter, start.position(), kNoPrimitive);
  return start;
}

std::optional<Segment> segment_from(const MeasuredPath& x, int anchor, Side toward) {
  Segment s{anchor, anchor, toward};
  do {
    s.end += s.step();
    if (s.end < 0 || s.end >= x.size()) return std::nullopt;
  } while (x[s.end].degenerate);
  return s;
}

bool movable(const Scene& scene, const MeasuredPath& x, const Segment& segment) {
  if (segment.end == x.last()) return false;
  if (segment.end == 0) return hittable(scene, x[0]);
  return !x[segment.end + segment.step()].degenerate;
}

Vec3 departure(const MeasuredPath& x, const Segment& s) {
  return s.toward == Side::Eye ? x.to_eye(s.anchor) : x.to_light(s.anchor);
}

std::optional<Rejection> retrace(const Scene& scene, MeasuredPath& y, const Segment& s,
                                 const Vec3& w) {
  Vec3 along = w;
  if (const auto why = retrace_chain(scene, y, s, along)) return why;
  if (const auto why = trace_vertex(scene, y, s, s.end - s.step(), along)) return why;
  const Vertex& end = y[s.end];
  const bool fits = s.end == 0 ? hittable(scene, end) : connectible(scene, end);
  return fits ? std::nullopt : std::optional(Rejection::WrongConfiguration);
}

std::optional<Rejection> retrace_chain(const Scene& scene, MeasuredPath& y, const Segment& s,
                                       Vec3& w, std::span<const Vec3> facets) {
  for (int i = s.anchor; i + s.step() != s.end; i += s.step()) {
    const int next = i + s.step();
    const bool transmit = transmits(y, next);  // before it is overwritten
    if (const auto why = trace_vertex(scene, y, s, i, w)) return why;
    const Vec3 from = -arrival(y, s, next);
    std::optional<Vec3> out;
    if (y[next].degenerate)
      out = specular_direction(scene, y[next], from, transmit);
    else if (is_glossy(scene, y[next]))
      out = facet_direction(scene, y[next], from, transmit, facets[std::abs(i - s.anchor)]);
    if (!out) return Rejection::WrongConfiguration;
    w = *out;
  }
  // Which way the last vertex scatters must be known whoever asks next.
  const int link = last_edge(s);
  Edge last = y.edge(link);
  last.w = s.toward == Side::Eye ? w : -w;
  if (s.length() > 1) y.set_edge(link, last);
  return std::nullopt;
}

double segment_density(const Scene& scene, const MeasuredPath& x, const Segment& s) {
  const bool to_eye = s.toward == Side::Eye;
  double density = 1;
  for (int i = s.anchor; i != s.end; i += s.step()) {
    const int next = i + s.step();
    const Edge edge = to_eye ? x.edge(i) : reversed(x.edge(next));
    // An event that is kept: the formal n_to² |cosθ_to| of bsdf.h with P = 1.
    if (i != s.anchor)
      density *=
          sqr(relative_index(scene, x[i], edge.w)) * std::abs(dot(x[i].point.shading.n, edge.w));
    density = to_measure(scene, x[i], x[next], edge, density);
  }
  return density;
}

std::optional<Rejection> complete(PathSample& sample, int first, int last, int joint) {
  const Scene& scene = sample.scene();
  MeasuredPath& y = sample.path();
  if (joint >= 0) y.aim(scene, joint);
  for (int i = first; i <= last; ++i)
    if (!y.measure_vertex(scene, i)) return Rejection::NoLight;
  if (joint >= 0 && !y.connect(scene, joint)) return Rejection::Occluded;
  for (int i = first; i < last; ++i) y.measure_edge(scene, i);
  if (!sample.settle()) return Rejection::OffFilm;
  return std::nullopt;
}

std::optional<Rejection> complete_segment(PathSample& y, const Segment& s, int origin) {
  if (s.toward == Side::Eye) return complete(y, origin, s.end + 1, s.end);
  return complete(y, std::max(s.end - 1, 0), origin, s.end - 1);
}

}  // namespace fogbow
