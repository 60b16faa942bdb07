// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "core/path/subpath.h"

namespace fogbow {

/// What one sample adds to the picture: an unbiased part of ∫ f dμ at `raster` (in [0,1)²), without
/// the pixel filter.
struct Contribution {
  Vec2 raster;
  RGB value;
  int k;                      ///< vertices of the path
  int s, t;                   ///< vertices from the light and from the eye
  int infinite_emitter = -1;  ///< which of them the eye's subpath ran into, s = 0
  bool glow = false;          ///< seen light from a medium
};

/// Buffers an estimator reuses; one a thread or chain.
struct Workspace {
  Subpath light, eye;
  std::vector<Contribution> contributions;
  std::uint64_t refused = 0;  ///< non-finite contributions, refused

  void add(const Contribution& c) {
    if (!is_finite(c.value))
      ++refused;
    else if (!is_black(c.value))
      contributions.push_back(c);
  }
};

/// An unbiased estimator of the picture from primary samples: the mean over samples of all
/// contributions is ∫ f dμ.
class Estimator {
 public:
  virtual ~Estimator() = default;
  /// Replaces the contributions in `workspace`. `eye` and `light` are separate streams; the raster
  /// position is the first two of `eye`.
  virtual void sample(SampleStream& light, SampleStream& eye, Workspace& workspace) const = 0;
  virtual const char* name() const = 0;
};

struct EstimatorSettings {
  int max_depth = 64;  ///< longest path, in edges: k ≤ max_depth + 1
  int rr_depth = 5;    ///< path: edges before roulette on the throughput starts
  /// path: transmittances and flights by null collisions instead of exactly, and each light by one
  /// technique alone, for exact densities are not known then: the oracle of the rest.
  bool null_collisions = false;
  /// bdpt: with the light that make_seen_light() samples.
  bool seen_light = true;
  /// Without the lights that the eye sees directly, through index-matched boundaries included;
  /// media that glow are none.
  bool hide_emitters = false;

  /// Whether paths of k vertices from x₁ are left out.
  bool hides(const Scene& scene, const Vertex& x, int k) const {
    return hide_emitters && k == 2 && !x.in_medium() && hittable(scene, x);
  }
};

/// Volumetric path tracing: next-event estimation with multiple importance sampling; in media also
/// at equiangular distances [Kulla2012].
std::unique_ptr<Estimator> make_path_tracer(const Scene& scene, const EstimatorSettings& settings);
/// Light subpaths connected to the sensor; sees no class that needs another technique.
std::unique_ptr<Estimator> make_light_tracer(const Scene& scene, const EstimatorSettings& settings);
/// All techniques (s,t) over surface and medium vertices, weighted by the balance heuristic
/// [Veach1997].
std::unique_ptr<Estimator> make_bdpt(const Scene& scene, const EstimatorSettings& settings);
/// The light alone that the eye sees directly or by specular vertices only
/// (MeasuredPath::is_seen_light()): where on the film it lies is easily found by looking, and
/// hardly by chains.
std::unique_ptr<Estimator> make_seen_light(const Scene& scene, const EstimatorSettings& settings);

}  // namespace fogbow
