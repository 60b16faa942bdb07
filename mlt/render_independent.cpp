// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render_parts.h"

namespace fogbow {

namespace {

/// Fraction bits of the other films below the mean luminance.
constexpr int kRadianceFractionBits = 30;

/// One count of the film is 2 to this.
int film_exponent(const Scene& scene, const Estimator& estimator, std::uint64_t seed) {
  return std::max(luminance_exponent(estimator, seed) - kRadianceFractionBits,
                  least_film_exponent(scene));
}

}  // namespace

RenderResult render_independent(const Scene& scene, const RenderOptions& options,
                                const RenderSettings& settings, Session& session) {
  const auto estimator = make_estimator(scene, settings);
  session.announce("bootstrap");
  IndependentSampling sampling(*estimator, scene.film(), options.seed,
                               film_exponent(scene, *estimator, options.seed));
  session.begin_rendering();
  PictureScale scale;
  do {
    sampling.run_round();
    scale = PictureScale::of_samples(sampling.samples());
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
