// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <bitset>
#include <vector>

#include "core/path/subpath.h"

namespace fogbow {

/// Longest path, in vertices.
inline constexpr int kMaxVertices = 1024;

/// x₁ … x_k, x₁ at the light.
using Path = std::vector<Vertex>;

/// Unit direction from path[i] to path[j], its neighbour.
Vec3 direction(const Path& path, int i, int j);

/// c, and which vertices are degenerate.
struct PathConfiguration {
  int k = 0;
  std::bitset<kMaxVertices> in_medium, degenerate;
  bool operator==(const PathConfiguration&) const = default;
};
PathConfiguration configuration(const Path& path);

/// The path of technique (s, t) over two subpaths.
Path assemble(const Scene& scene, const Subpath& light, int s, const Subpath& eye, int t);

// The definitions, evaluated without any cache: the oracle of whatever is faster.

/// f without the pixel filter. Degenerate vertices have the values of bsdf.h whose deltas cancel
/// against those of `technique_density`.
RGB f(const Scene& scene, const Path& path);

/// p_s: density in μ with which s vertices from the light and k − s from the eye make this path,
/// roulette included; 0 where they cannot.
double technique_density(const Scene& scene, const Path& path, int s);

/// Where the film sees the path; nothing off the film.
std::optional<Vec2> raster(const Scene& scene, const Path& path);

/// f with specular chains reduced [JakobMarschner2012, sec. 4]: chains of degenerate vertices
/// between a and b enter as D_a J_{a→b} D_b ∏C. A density in μ of the non-degenerate vertices.
RGB reduced_f(const Scene& scene, const Path& path);

/// By what the reduced f takes the Dirac value of f̂ at x, so that it is a factor on radiance that
/// comes from the light: C with the shading normals' correction.
double dirac_to_reduced(const Scene& scene, const Vertex& x, const Vec3& w_eye);

}  // namespace fogbow
