// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/geometry/accel.h"
#include "core/scene/scene.h"

namespace fogbow {

enum class VertexKind : std::uint8_t {
  Surface,        ///< on 𝓜: c_i = 0, measure dA
  Medium,         ///< in Ω°: c_i = 1, measure dV
  PointLight,     ///< Dirac position, counting measure, D = 1
  InfiniteLight,  ///< a direction, measure dσ, or counting where it is Dirac; `point.n_g` is where
                  ///< its light travels
  Sensor,         ///< on the aperture (dA), or a pinhole (counting measure)
  ParallelSensor,  ///< the direction `point.n_g` in which an orthographic camera looks, counting
                   ///< measure; where on the film x_{k−1} is seen from is its position
};

/// One x_i, wherever it came from. The whole state of a path lies in its vertices.
struct Vertex {
  VertexKind kind = VertexKind::Surface;
  bool degenerate = false;  ///< scatters by the Dirac part of its BSDF
  SurfacePoint point;
  PrimitiveId id;                  ///< Surface only
  const Medium* medium = nullptr;  ///< that holds the vertex; unused where a surface bounds two
  int emitter = -1;                ///< index in the scene if the vertex can be x₁

  const Vec3& position() const { return point.position; }
  bool on_surface() const { return kind == VertexKind::Surface; }
  bool in_medium() const { return kind == VertexKind::Medium; }
  bool infinite() const { return kind == VertexKind::InfiniteLight; }
  bool on_sensor() const {
    return kind == VertexKind::Sensor || kind == VertexKind::ParallelSensor;
  }
  /// Whether it is a direction, so that rays from it spread by their positions across it.
  bool parallel() const { return infinite() || kind == VertexKind::ParallelSensor; }
};

/// The segment between two consecutive vertices, with what attenuates it.
struct Edge {
  Vec3 w{0};          ///< unit, away from the vertex whose edge this is
  double length = 0;  ///< infinite towards an InfiniteLight
  RGB tau{1};         ///< transmittance, of surfaces that are passed through too
  RGB tau_q{1};  ///< its factor due to surfaces, and to media in which vertices are sampled: what
                 ///< free flight sees
  std::int64_t passages = 0;  ///< surfaces passed through that could have been vertices
};

/// Medium on the side of a vertex to which w points.
inline const Medium* medium_toward(const Scene& scene, const Vertex& x, const Vec3& w) {
  if (!x.on_surface()) return x.medium;
  const Surface& surface = scene.surface(x.id.shape);
  if (!surface.medium_boundary) return x.medium;
  return dot(w, x.point.n_g) > 0 ? surface.exterior.get() : surface.interior.get();
}

}  // namespace fogbow
