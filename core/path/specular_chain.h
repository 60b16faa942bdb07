// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>

#include "core/path/path.h"

namespace fogbow {

/// Derivatives of a ray through specular vertices with respect to two orthonormal coordinates of
/// its direction at the start, or of its position across parallel light (ray differentials,
/// [Igehy1999]).
class RayBundle {
 public:
  struct Derivative {
    Vec3 d_position, d_direction;
  };

  RayBundle(const Vertex& start, const Vec3& w);
  /// At distance t the ray meets x, which sends it on along w_out by a facet that is held in the
  /// shading frame.
  void scatter(const Scene& scene, const Vertex& x, double t, const Vec3& w_out);
  /// Of the position at distance t from the last vertex.
  std::array<Vec3, 2> spread(double t) const;
  /// Of the direction.
  std::array<Vec3, 2> turn() const;
  /// The frame whose s and t the coordinates at the start are.
  const Frame& across() const { return across_; }

 private:
  Vec3 w_;
  Frame across_;
  Derivative d_[2];
};

/// |dσ_a/dA⊥_b| from path[a] through the degenerate vertices between to path[b], glossy ones
/// keeping their facet; from a parallel end |dA⊥_a/dA⊥_b|, to one |dσ_a/dσ_b|. `a` may be greater
/// than `b`: then seen from the eye's side.
double chain_jacobian(const Scene& scene, const Path& path, int a, int b);

/// What turns the factors of f between a and b > a, formal deltas included, into those of the
/// reduced f: D_a J_{a→b} D_b over ∏G, and what dirac_to_reduced() says of each vertex between. For
/// a glossy one, the part |do/dσ| that turns its area into the facet that is held.
double chain_correction(const Scene& scene, const Path& path, int a, int b);

}  // namespace fogbow
