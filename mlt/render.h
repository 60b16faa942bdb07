// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/image.h"
#include "core/scene/scene.h"

namespace fogbow {

struct RenderProgress {
  double fraction = 0;  ///< of the target, in [0, 1]
  double seconds = 0;
  double samples_per_pixel = 0;  ///< mutations or samples so far
  double samples_per_second = 0;
  double b = 0, b_stderr = 0;  ///< mean luminance and its standard error
  std::string stage;           ///< "bootstrap", "render"
};

struct RenderOptions {
  std::string integrator = "auto";  ///< auto, file, path, light, bdpt, pssmlt, mlt
  /// Integrator properties that override the scene's, as text.
  std::vector<std::pair<std::string, std::string>> overrides;
  std::optional<double> seconds;            ///< wall-clock budget
  std::optional<double> samples_per_pixel;  ///< mutations or samples; neither: 64 a pixel
  int threads = 0;                          ///< 0: all
  std::uint64_t seed = 0;
  double picture_interval = 0;  ///< seconds between calls of on_picture; 0: never
  std::function<void(const RenderProgress&)> on_progress;
  std::function<void(const Image&)> on_picture;
  const std::atomic<bool>* stop = nullptr;  ///< set from elsewhere to end at the next round
  const std::atomic<bool>* save_now =
      nullptr;  ///< asks for one on_picture at the next round; the caller resets it
};

/// Mean luminance carried by the paths of k vertices, with standard error between groups.
struct ClassShare {
  int k = 0;
  double value = 0, standard_error = 0;
  std::string configuration = {};  ///< for b_k^c: "SMS…" from light to eye, M in media
};

struct MutationReport {
  std::string name;
  double weight = 0;  ///< as asked for, unnormalized
  std::uint64_t proposed = 0, accepted = 0;
  std::map<std::string, std::uint64_t> rejected;  ///< by kind
  double mean_squared_jump = 0;  ///< E[a |Δraster|²], Δraster in parts of the picture
  double time_share = 0;         ///< of all steps
  double seconds_per_proposal = 0;
  struct Kind {
    std::string name;
    std::uint64_t proposed = 0, accepted = 0;
  };
  std::vector<Kind> kinds;  ///< where the mutation tells proposals apart
};

struct RenderResult {
  Image image;  ///< R G B Error.R Error.G Error.B
  std::string integrator;
  double b = 0, b_stderr = 0;
  std::uint64_t samples = 0;  ///< paths or mutations, without the bootstrap
  int chains = 0, groups = 0;
  double seconds = 0, cpu_seconds = 0;
  double render_seconds = 0;  ///< without the bootstrap
  std::uint64_t rays = 0;
  std::uint64_t non_finite = 0;  ///< contributions refused
  bool interrupted = false;
  bool groups_disagree = false;  ///< b differs between groups by more than a tenth of itself
  std::vector<ClassShare> lengths;
  std::vector<ClassShare> classes;  ///< b_k^c, from the largest; chains of paths alone
  std::vector<MutationReport> mutations;
  std::map<std::string, double> diagnostics;  ///< R-hat, ESS, …
  std::vector<std::string>
      notes;  ///< e.g. that the scene asked for another integrator, or properties without effect
};

/// Throws Error: NoLight if nothing that was tried carries light, Usage on unknown integrators or
/// properties, Numerical on film overflow.
RenderResult render(const Scene& scene, const RenderOptions& options);

/// One proposal with all its factors, as text: `--replay seed:chain:step`.
std::string replay(const Scene& scene, const RenderOptions& options, std::uint64_t seed,
                   std::uint64_t chain, std::uint64_t step);

/// Bytes that render() will need, by part.
std::map<std::string, std::size_t> render_memory(const Scene& scene, const RenderOptions& options);

}  // namespace fogbow
