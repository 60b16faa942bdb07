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

/// One factor a group, by which its sums estimate the whole picture.
using GroupScale = std::array<double, Film::kGroups>;

/// Mean luminance by path length, and that of all lengths together.
std::vector<ClassShare> length_shares(const LengthTally& tally, const GroupScale& scale);
ReplicateMean total_luminance(const LengthTally& tally, const GroupScale& scale);

/// The two ways to make a picture; what they have in common is left to render().
RenderResult render_independent(const Scene& scene, const RenderOptions& options,
                                const RenderSettings& settings, Session& session);
RenderResult render_chains(const Scene& scene, const RenderOptions& options,
                           const RenderSettings& settings, Session& session);

}  // namespace fogbow
