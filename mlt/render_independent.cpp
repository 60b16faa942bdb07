// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render_parts.h"

namespace fogbow {

namespace {

/// Fraction bits of the other films below the mean luminance.
constexpr int kRadianceFractionBits = 30;

}  // namespace

RenderResult render_independent(const Scene& scene, const RenderOptions& options,
                                const RenderSettings& settings, Session& session) {
  const auto estimator = make_estimator(scene, settings);
  session.announce("bootstrap");
  const int exponent = luminance_exponent(*estimator, options.seed) - kRadianceFractionBits;
  IndependentSampling sampling(*estimator, scene.film(), options.seed, exponent);
  session.begin_rendering();
  GroupScale scale{};
  do {
    sampling.run_round();
    scale.fill(Film::kGroups / static_cast<double>(sampling.samples()));
    const ReplicateMean b = total_luminance(sampling.tally(), scale);
    session.report(sampling.samples(), b.mean, b.standard_error,
                   [&] { return sampling.develop(); });
  } while (sampling.samples() < session.target() && !session.out_of_time() &&
           !session.interrupted());

  RenderResult result;
  result.interrupted = session.interrupted() && sampling.samples() < session.target();
  result.image = sampling.develop();
  const ReplicateMean b = total_luminance(sampling.tally(), scale);
  result.b = b.mean;
  result.b_stderr = b.standard_error;
  result.samples = sampling.samples();
  result.non_finite = sampling.refused();
  result.lengths = length_shares(sampling.tally(), scale);
  return result;
}

}  // namespace fogbow
