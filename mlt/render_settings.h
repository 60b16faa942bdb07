// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "core/scene/scene.h"
#include "mlt/registry.h"
#include "mlt/render.h"

namespace fogbow {

/// Integrator properties after the scene's and the overrides have been read.
struct RenderSettings {
  std::string integrator;  ///< path, light, bdpt, pssmlt or mlt
  bool uses_chains() const { return integrator == "pssmlt" || integrator == "mlt"; }
  int max_depth = 0;
  bool depth_capped = false;  ///< the scene sets no limit, and ours stands in for it
  int rr_depth = 5;
  bool hide_emitters = false;
  double large_step_probability = 0.3;                     ///< pssmlt
  MutationWeights mutations = default_mutation_weights();  ///< mlt
  /// Chains share their time for the least relative error, not in proportion to luminance.
  bool two_stage = true;
  int chains_per_group = 256;
  int bootstrap_samples = 1 << 16;
  double samples_per_pixel = 64;  ///< where neither time nor samples are asked for
  std::vector<std::string> notes;
};

/// Throws Error(Usage) on an unknown integrator, an unknown override or a value out of range; what
/// a scene sets without effect becomes a note.
RenderSettings read_render_settings(const Scene& scene, const RenderOptions& options);

}  // namespace fogbow
