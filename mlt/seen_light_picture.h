// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>

#include "core/estimators/sampling.h"
#include "mlt/render.h"
#include "mlt/render_parts.h"

namespace fogbow {

/// The light that chains leave out (make_seen_light()), sampled pixel by pixel beside them.
class SeenLightPicture {
 public:
  /// `b` of the chains: what their mean luminance is about.
  SeenLightPicture(const Scene& scene, const RenderSettings& settings, std::uint64_t seed,
                   double b);

  /// Samples until there are enough for so many mutations.
  void keep_up(std::uint64_t mutations);

  ReplicateMean luminance() const;
  Image add_to(Image chains) const;
  /// To picture, b, lengths and classes.
  void add_to(RenderResult& result) const;

 private:
  std::unique_ptr<Estimator> estimator_;
  std::optional<IndependentSampling> sampling_;  ///< nothing where no emitter can be run into
};

}  // namespace fogbow
