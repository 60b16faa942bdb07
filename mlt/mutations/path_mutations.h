// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "mlt/chain.h"
#include "mlt/path_sample.h"

namespace fogbow {

class TechniqueDistribution;

using PathMutation = std::unique_ptr<Mutation<PathSample>>;

// The mutations of paths, one file each; derivations in docs/mutations.md. `weight` is
// selection_weight where the mutation can be applied, 0 elsewhere.

/// Deletes a range and grows another from both ends [VeachGuibas1997, sec. 5.1].
PathMutation make_bidirectional(double weight, int max_vertices);
/// Moves the raster position and re-traces to the first vertex that is not degenerate
/// [VeachGuibas1997, sec. 5.3.1].
PathMutation make_lens(double weight);
/// Moves the direction in which light leaves for the vertex that the sensor sees
/// [VeachGuibas1997, sec. 5.3.2].
PathMutation make_caustic(double weight);
/// The lens perturbation through several specular chains [VeachGuibas1997, sec. 5.3.3].
PathMutation make_multichain(double weight);
/// Moves a direction at a medium vertex [Pauly2000].
PathMutation make_scattering(double weight);
/// Moves a vertex along its ray, through the medium and onto the wall [Pauly2000].
PathMutation make_propagation(double weight);
/// Lets a vertex change between surface and medium along a held ray.
PathMutation make_switch(double weight);
/// Moves a direction and solves the specular chain beyond [JakobMarschner2012].
PathMutation make_manifold(double weight);
/// A new path by one technique of bidirectional path tracing.
PathMutation make_large_step(double weight, const TechniqueDistribution& techniques);
/// Moves all primary samples of one technique that could have made the path [Otsu2017].
PathMutation make_primary_sample(double weight, const TechniqueDistribution& techniques);
/// T(ȳ) = Σ_s c_{s,k−s} p_s(ȳ) of a large step.
double log_large_step_density(const PathSample& y, const TechniqueDistribution& techniques);

}  // namespace fogbow
