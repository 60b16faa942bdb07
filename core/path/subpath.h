// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "core/path/measurement.h"

namespace fogbow {

/// Where primary samples come from: a random stream, or the state of a chain.
class SampleStream {
 public:
  virtual ~SampleStream() = default;
  virtual double next() = 0;

  Vec2 next2() {
    const double x = next();
    return {x, next()};
  }
  Vec3 next3() {
    const double x = next(), y = next();
    return {x, y, next()};
  }
};

/// A vertex of a subpath with what came with it from its own end.
struct SubpathVertex {
  Vertex x;
  Edge edge;          ///< from the previous vertex to this
  RGB throughput{0};  ///< factors of f up to the arrival here over their density
  double pdf =
      0;  ///< density in μ of this vertex given the two before it, roulette and distance included
  /// Σ_{j<i} p_j/p_i over the techniques that move the connection towards this subpath's end, i
  /// being this vertex; final once two more vertices follow.
  double other_techniques = 0;
  /// Its factor if the vertex after the next turns out degenerate (light subpaths, see scatter()).
  double if_behind_specular = 1;
  bool connects = false;
};

using Subpath = std::vector<SubpathVertex>;

/// Samples x₁ with its density in μ; false where the emitter gives no point.
bool sample_emitter(const Scene& scene, SampleStream& u, SubpathVertex& start);

/// Light that has come from beyond the scene along an escaped ray: its vertex at infinity; false if
/// nothing shines there.
bool make_infinite_vertex(const Scene& scene, const Edge& edge, Vertex& x);

/// One step of a subpath: where it has come to, by which way and with which density.
struct Step {
  Vertex next;
  Edge edge;             ///< leads to `next`
  double pdf_sigma = 0;  ///< of its direction (across the ray from parallel ends)
};

/// Light leaves x₁. False where it gets nowhere.
bool leave_emitter(const Scene& scene, const Vertex& x, const Vec2& u_direction,
                   const Vec2& u_distance, Step& step);
/// The eye looks from x_k, which is put to where the ray starts; ends also at infinite emitters.
bool leave_sensor(const Scene& scene, Vertex& x, const Vec2& raster, const Vec2& u_distance,
                  Step& step);
/// A subpath goes on from x; `from` is the direction it came from. Says how it was scattered.
std::optional<DirectionSample> leave_vertex(const Scene& scene, const Vertex& x, const Vec3& from,
                                            Side side, bool behind_specular, SampleStream& u,
                                            Step& step);
/// A point of the sensor.
Vertex sample_sensor(const Scene& scene, const Vec2& u);

/// Traces vertices from the emitters until roulette, absorption, escape or `max_vertices` ends the
/// walk. False where that was a throughput that is not finite, which is no absorption.
bool trace_light_subpath(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path);

/// The same from the sensor; `raster` is where the film was sampled. Ends also at infinite
/// emitters, whose vertex is the last.
bool trace_eye_subpath(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path,
                       Vec2& raster);

/// Density of sampling x as the end of an edge that leaves `from` with density pdf_sigma.
inline double pdf_arrival(const Scene& scene, const Vertex& from, const Vertex& x, const Edge& to_x,
                          double pdf_sigma) {
  return to_measure(scene, from, x, to_x, pdf_sigma) * pdf_distance(scene, to_x, x);
}

/// The same edge seen from its other end.
inline Edge reversed(Edge edge) {
  edge.w = -edge.w;
  return edge;
}

/// Σ_{j<i} p_j/p_i for path[i] when the density of its being sampled from the other end has become
/// known.
/// `next_degenerate`: whether path[i + 1] is.
double other_techniques(const Scene& scene, const Subpath& path, std::size_t i, double pdf_reverse,
                        bool next_degenerate, Side side);

/// Whether a path may end at x₁ by running into it.
inline bool hittable(const Scene& scene, const Vertex& x) {
  if (x.emitter < 0 || is_dirac(scene.emitter(x.emitter).kind())) return false;
  // Free flight never stops at what all light passes.
  return passage(scene, x, x.point.n_g) != RGB(1);
}

/// A light with a Dirac position or direction is a point of the picture of a pinhole, or of
/// parallel rays; by convention it is not seen directly.
inline bool is_unseen(const Scene& scene, const Vertex& x) {
  return (scene.sensor().dirac_position() || scene.sensor().parallel()) &&
         is_dirac(scene.emitter(x.emitter).kind());
}

/// Whether a ray joins what was sampled at both ends, of the two of an edge: directions at both
/// have none in common.
inline bool has_ray(const Vertex& x, const Vertex& y) { return !(x.parallel() && y.parallel()); }

}  // namespace fogbow
