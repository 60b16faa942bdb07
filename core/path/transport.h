// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "core/path/vertex.h"

namespace fogbow {

/// Whether free flight makes vertices in this medium (null: vacuum).
inline bool is_sampled(const Medium* medium) {
  return medium && (medium->scatters() || medium->emits());
}

enum class ExtendResult { Reached, Escaped, Lost };

/// By what a surface vertex dims light that passes straight through it along w; 0 elsewhere.
inline RGB passage(const Scene& scene, const Vertex& x, const Vec3& w) {
  if (!scene.has_null_surfaces() || !x.on_surface() || x.id == kNoPrimitive) return RGB(0);
  return scene.surface(x.id.shape).bsdf->passage(x.point, x.point.shading.to_local(w));
}

/// Density of where free flight along `edge` ends: q(t) [1/length] at a medium vertex, the mass Q_M
/// elsewhere: of stopping at a surface that may be passed through, too. Channels are chosen
/// uniformly.
inline double pdf_distance(const Scene& scene, const Edge& edge, const Vertex& end) {
  if (end.in_medium()) return mean(end.medium->sigma_t(end.position()) * edge.tau_q);
  if (!scene.has_null_surfaces()) return mean(edge.tau_q);
  return mean(edge.tau_q * (RGB(1) - passage(scene, end, edge.w)));
}

/// Follows the ray that leaves `x` along `w` to its next vertex by free flight with primary samples
/// u = (channel, distance): a surface of passage T counts as an optical depth of −ln T. Escaped:
/// `edge` describes the way to infinity. Lost: beyond `t_max`.
ExtendResult extend(const Scene& scene, const Vertex& x, const Vec3& w, const Vec2& u, Vertex& next,
                    Edge& edge, double t_min = 0, double t_max = kInfinity);

/// The same to the first surface that stops the ray, whatever media lie before it, after as many
/// `passages` through surfaces that need not have stopped it (or fewer, as the edge then says).
/// Escaped where there is none.
ExtendResult extend_to_surface(const Scene& scene, const Vertex& x, const Vec3& w, Vertex& next,
                               Edge& edge, double t_min = 0, double t_max = kInfinity,
                               std::int64_t passages = 0);

/// The same with no medium but those that `passed(medium, t0, t1)` is told of, vacuum as null, and
/// where a surface lets a part T through, `crosses(T)` decides.
ExtendResult trace_media(const Scene& scene, const Vertex& x, const Ray& ray, Vertex& next,
                         double& length,
                         const std::function<void(const Medium*, double, double)>& passed,
                         const std::function<bool(const RGB&)>& crosses);

/// The primary samples with which `extend` would have ended on `end`, drawn from their conditional
/// law by uniform auxiliaries.
Vec2 invert_distance(const Scene& scene, const Edge& edge, const Vertex& end,
                     const Vec2& auxiliary);

/// The edge from `a` to `b`, nothing if a surface is in between: V and τ at once. `a` lies on the
/// light's side: the answer is a function of the path alone.
std::optional<Edge> connect(const Scene& scene, const Vertex& a, const Vertex& b);

/// The medium vertex at distance t on the ray from `x` along `w`, nothing if a surface is in
/// between or no vertices are sampled there; `edge` leads to it.
std::optional<Vertex> medium_vertex_at(const Scene& scene, const Vertex& x, const Vec3& w, double t,
                                       double t_min, Edge& edge);

/// The media along a ray from a vertex to the first surface that stops all light: where vertices
/// can be on it, and how free flight spreads them. Vertices on surfaces that light passes in part
/// are none of it.
class RayProfile {
 public:
  /// Between t_min and t_max from `x` along `w`.
  void trace(const Scene& scene, const Vertex& x, const Vec3& w, double t_min = 0,
             double t_max = kInfinity);

  /// Whether a surface ends the ray; else it escapes.
  bool has_wall() const { return has_wall_; }
  const Vertex& wall() const { return wall_; }
  /// To the wall.
  const Edge& edge() const { return edge_; }
  double length() const { return edge_.length; }
  Vec3 point(double t) const { return ray_(t); }

  /// Transmittance of the sampled media up to distance t.
  RGB tau_q(double t) const;
  /// The distance where 1 − τ_q of one channel is u; nothing beyond the wall, or where that is on a
  /// surface.
  std::optional<double> distance(int channel, double u) const;
  /// The scattering medium at distance t, null where there is none.
  const Medium* scatters_at(double t) const;
  /// The medium vertex at distance t, where scatters_at(t), and the edge that leads to it.
  Vertex vertex(const Scene& scene, double t, Edge& edge) const;

 private:
  struct Section {
    double begin, end;
    const Medium* medium;
    RGB tau, tau_q;  ///< up to its beginning
    std::int64_t passages;
  };
  const Section& section_at(double t) const;

  Ray ray_;
  bool has_wall_ = false;
  Vertex wall_;
  Edge edge_;
  std::vector<Section> sections_;
  /// τ_q where it was asked for last in heterogeneous media: (t, τ_q).
  mutable std::array<std::pair<double, RGB>, 4> answers_;
};

/// Rays traced by all threads so far.
std::uint64_t rays_traced();

}  // namespace fogbow
