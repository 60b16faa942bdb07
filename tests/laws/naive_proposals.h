// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "core/path/path.h"

/// Densities of the local mutations by their definitions, in the reduced measure of notation.md: no
/// cache, no formal delta, derivatives of traced rays by finite differences.
namespace fogbow::testing {

/// From path[from] through degenerate vertices to path[to], by rays traced from the first.
struct Stretch {
  int from, to;
  int step() const { return to > from ? 1 : -1; }
};

/// A logarithm and how far it may be off.
struct Measured {
  double value = 0, error = 0;
  Measured& operator+=(const Measured& m) { return value += m.value, error += m.error, *this; }
  Measured& operator-=(const Measured& m) { return value -= m.value, error += m.error, *this; }
};

/// log |dσ_from/dA⊥_to|: dA⊥_from where light comes from infinity, dσ_to where it comes to. The
/// error is the difference between forward and backward derivatives: large where a triangle ends
/// or a ray grazes.
Measured log_ray_jacobian(const Scene& scene, const Path& path, const Stretch& stretch);

/// Log of the reduced f over the formal one, from the chains of the path alone.
Measured log_reduced_over_formal(const Scene& scene, const Path& path);

/// A way in which a mutation may have come from x to y: all that it may have touched, and the log
/// ratio that it then must state, log T(y→x; r*) − log T(x→y; r).
struct Way {
  int first, last;
  Measured log_ratio;
};

/// All records of a mutation (lens, multichain, caustic, scattering, propagation, switch, manifold)
/// that lead from x to y.
std::vector<Way> ways(const std::string& mutation, const Scene& scene, const Path& x,
                      const Path& y);

/// Position, kind, place and scattering of a vertex are the same to the bit.
bool same_vertex(const Vertex& a, const Vertex& b);

}  // namespace fogbow::testing
