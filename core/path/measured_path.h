// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <iosfwd>

#include "core/math/scaled.h"
#include "core/path/path.h"

namespace fogbow {

/// x₁ … x_k with every factor of f and every density that techniques are made of, so that a change
/// costs only what it touches. Indices are from 0; edge(i) leads from x[i] to x[i + 1].
///
/// f is that of path.h: degenerate vertices enter with one formal delta each, as they do in
/// densities.
class MeasuredPath {
 public:
  MeasuredPath() = default;
  /// A copy has the room of what it was made from.
  MeasuredPath(const MeasuredPath& x) { *this = x; }
  MeasuredPath& operator=(const MeasuredPath& x);
  MeasuredPath(MeasuredPath&&) = default;
  MeasuredPath& operator=(MeasuredPath&&) = default;

  /// Room for paths of so many vertices; no allocation up to there.
  void reserve(int vertices);
  int capacity() const { return static_cast<int>(vertices_.capacity()); }
  /// Vertices beyond the old size are to be written before anything else is asked.
  void resize(int k);

  int size() const { return static_cast<int>(vertices_.size()); }
  int last() const { return size() - 1; }
  const Vertex& operator[](int i) const { return vertices_[i]; }
  const Edge& edge(int i) const { return edges_[i]; }
  /// At the ends: L_e or W_e with the density of the direction along the path (dA across the ray
  /// where they are parallel).
  const Scattering& scattering(int i) const { return scattering_[i]; }

  /// Whether edge(i) leads through a medium in which vertices can lie.
  bool sees_medium(int i) const {
    const RGB& tau_q = edges_[i].tau_q;
    return tau_q.x < 1 || tau_q.y < 1 || tau_q.z < 1;
  }
  /// Direction from x[i] to x[i ± 1].
  Vec3 to_light(int i) const { return -edges_[i - 1].w; }
  Vec3 to_eye(int i) const { return edges_[i].w; }

  Vertex& vertex(int i) { return vertices_[i]; }
  void set_edge(int i, const Edge& edge) { edges_[i] = edge; }
  /// n vertices of x from `first`, and the edges between them, with all their factors, to places
  /// from `to`.
  void copy(const MeasuredPath& x, int first, int to, int n);
  /// Direction and length alone of the straight edge, without a ray. A parallel sensor's position
  /// follows its neighbour's.
  void aim(const Scene& scene, int i);

  /// From vertices and directions on both sides: f̂ and densities at x[i]; false where it is black.
  bool measure_vertex(const Scene& scene, int i);
  /// V and τ of edge(i), traced from the light's side; false where something is in between.
  bool connect(const Scene& scene, int i);
  /// G τ of edge(i).
  void measure_edge(const Scene& scene, int i);
  /// f as the product of all factors, and the raster position; false off the film.
  bool evaluate(const Scene& scene);

  const ScaledProduct<RGB>& f() const { return f_; }
  const Vec2& raster() const { return raster_; }

  /// Whether the eye sees x₁ directly or by degenerate vertices alone, running
  /// into it: "seen light", a function of the film's position (and of the place on the ray in
  /// what glows), up to the choice of events.
  bool is_seen_light(const Scene& scene) const;

  /// Density in μ of x[i] sampled from the light, or from the eye, given what comes before it
  /// there; roulette and distance included.
  double pdf_from_light(const Scene& scene, int i) const;
  double pdf_from_eye(const Scene& scene, int i) const;

  const Path& vertices() const { return vertices_; }
  /// Takes over all vertices and computes every factor; false if the path carries no light.
  bool measure(const Scene& scene, const Path& path);

  void serialize(std::ostream& out, const Scene& scene) const;
  /// Throws Error(InputOutput) on a broken stream.
  static MeasuredPath deserialize(std::istream& in, const Scene& scene);

 private:
  std::vector<Vertex> vertices_;
  std::vector<Edge> edges_;
  std::vector<RGB> transport_;  ///< G τ of each edge
  std::vector<Scattering> scattering_;
  ScaledProduct<RGB> f_;
  Vec2 raster_{0};
};

}  // namespace fogbow
