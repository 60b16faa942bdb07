// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <memory>

#include "core/estimators/sampling.h"
#include "mlt/normalization.h"
#include "mlt/render_settings.h"
#include "mlt/session.h"

namespace fogbow {

/// That of the integrator, or that of whose primary samples its chains are made, without the seen
/// light.
std::unique_ptr<Estimator> make_estimator(const Scene& scene, const RenderSettings& settings);

/// Of a film of radiances, by what the emitters' power makes on average: where the first samples
/// see next to nothing, or nothing, the next may see ordinary light.
int least_film_exponent(const Scene& scene);

/// Factors by which sums estimate the whole picture: those of all groups together, and for its
/// error those of each group alone.
struct PictureScale {
  double all = 0;
  std::array<double, Film::kGroups> group{};

  /// Of independent samples, spread evenly over the groups.
  static PictureScale of_samples(std::uint64_t samples);
  ReplicateMean operator()(const std::array<double, Film::kGroups>& sums) const;
};

/// Mean luminance by path length, and that of all lengths together.
std::vector<ClassShare> length_shares(const LengthTally& tally, const PictureScale& scale);
ReplicateMean total_luminance(const LengthTally& tally, const PictureScale& scale);

/// The two ways to make a picture; what they have in common is left to render().
RenderResult render_independent(const Scene& scene, const RenderOptions& options,
                                const RenderSettings& settings, Session& session);
RenderResult render_chains(const Scene& scene, const RenderOptions& options,
                           const RenderSettings& settings, Session& session);

}  // namespace fogbow
