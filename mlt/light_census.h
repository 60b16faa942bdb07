// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/estimators/estimator.h"
#include "mlt/normalization.h"

namespace fogbow {

/// By which ways the light of a picture comes to the eye, as BDPT finds it: what makes a scene
/// hard.
struct LightCensus {
  ReplicateMean luminance;  ///< of the picture's mean

  // Parts of it, each a mean luminance of its own. "Lit through" and "seen through" speak of
  // degenerate vertices between the light, or the eye, and the first vertex that scatters smoothly.
  ReplicateMean seen_light;       ///< the eye sees a light, directly or through specular surfaces
  ReplicateMean seen_glow;        ///< the same of a medium that emits
  ReplicateMean by_next_event;    ///< next-event estimation of path tracing can make it
  ReplicateMean surface_caustic;  ///< surfaces lit through specular surfaces
  ReplicateMean volume_caustic;   ///< media lit through specular surfaces
  ReplicateMean caustic_seen_through;  ///< of both caustics, what is seen through specular surfaces
  ReplicateMean in_media;              ///< scattered or emitted by a medium

  /// Least part of the samples that holds half of the light: 0.5 where all are alike.
  double half_in = 0;

  // Of paths from lights of Dirac position or direction to an eye of Dirac position, those with
  // specular vertices on both sides of every other are beyond any technique.
  double dirac_lit_through = 0;  ///< part of such light's paths that first meet a specular surface
  double seen_through = 0;       ///< part of the picture that is seen through specular surfaces
};

/// From `samples` of BDPT, the same for any number of threads.
LightCensus take_light_census(const Scene& scene, const EstimatorSettings& settings,
                              std::uint64_t samples, std::uint64_t seed);

}  // namespace fogbow
