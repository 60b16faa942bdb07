// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/seen_light_picture.h"

#include <algorithm>

#include "mlt/class_tally.h"

namespace fogbow {

namespace {

/// A sample takes about as long as a mutation; the first few are worth more.
constexpr std::uint64_t kMutationsPerSample = 16, kFirstRounds = 8, kMutationsPerFirst = 2;
/// Fraction bits of the film below the mean luminance; emitters may be brighter by many more.
constexpr int kFractionBits = 24;

bool has_visible_emitters(const Scene& scene) {
  for (std::size_t i = 0; i < scene.emitter_count(); ++i) {
    const EmitterKind kind = scene.emitter(i).kind();
    if (!is_dirac(kind)) return true;
  }
  return false;
}

/// Adds b_k, or b_k^c, where there is none yet as a new one.
void add(std::vector<ClassShare>& shares, const ClassShare& more) {
  const auto same = std::ranges::find_if(shares, [&](const ClassShare& share) {
    return share.k == more.k && share.configuration == more.configuration;
  });
  if (same == shares.end()) return shares.push_back(more);
  same->value += more.value;
  same->standard_error = std::hypot(same->standard_error, more.standard_error);
}

}  // namespace

SeenLightPicture::SeenLightPicture(const Scene& scene, const RenderSettings& settings,
                                   std::uint64_t seed, double b) {
  if (!has_visible_emitters(scene)) return;
  EstimatorSettings s;
  s.max_depth = settings.max_depth;
  s.hide_emitters = settings.hide_emitters;
  estimator_ = make_seen_light(scene, s);
  const double mean = std::max(b, mean_luminance(*estimator_, seed));
  const int least = least_film_exponent(scene);
  sampling_.emplace(*estimator_, scene.film(), seed,
                    mean > 0 ? std::max(std::ilogb(mean) + 1 - kFractionBits, least) : least);
}

void SeenLightPicture::keep_up(std::uint64_t mutations) {
  if (!sampling_) return;
  const auto pixels = static_cast<std::uint64_t>(sampling_->width()) * sampling_->height();
  const std::uint64_t rounds =
      std::max(1 + mutations / (kMutationsPerSample * pixels),
               std::min(kFirstRounds, 1 + mutations / (kMutationsPerFirst * pixels)));
  while (sampling_->samples() < rounds * pixels) sampling_->run_round();
}

ReplicateMean SeenLightPicture::luminance() const {
  if (!sampling_) return {};
  return total_luminance(sampling_->tally(), PictureScale::of_samples(sampling_->samples()));
}

Image SeenLightPicture::add_to(Image chains) const {
  if (!sampling_) return chains;
  const Image seen = sampling_->develop();
  for (std::size_t c = 0; c < chains.channels.size(); ++c) {
    const std::string& name = chains.channels[c];
    const int from = seen.channel(name);
    const bool error = name.starts_with("Error.");
    for (int y = 0; y < chains.height; ++y)
      for (int x = 0; x < chains.width; ++x) {
        float& pixel = chains.at(x, y, static_cast<int>(c));
        const float more = seen.at(x, y, from);
        pixel = error ? std::hypot(pixel, more) : pixel + more;
      }
  }
  return chains;
}

void SeenLightPicture::add_to(RenderResult& result) const {
  if (!sampling_) return;
  result.image = add_to(std::move(result.image));
  const ReplicateMean seen = luminance();
  result.b += seen.mean;
  result.b_stderr = std::hypot(result.b_stderr, seen.standard_error);
  result.non_finite += sampling_->refused();
  const auto scale = PictureScale::of_samples(sampling_->samples());
  for (const ClassShare& share : length_shares(sampling_->tally(), scale))
    add(result.lengths, share);
  if (!result.classes.empty())
    for (const bool glow : {false, true})
      for (ClassShare share : length_shares(sampling_->tally(glow), scale)) {
        share.configuration = configuration_text({share.k, glow});
        add(result.classes, share);
      }
  std::ranges::sort(result.lengths, {}, &ClassShare::k);
  std::ranges::stable_sort(result.classes, std::greater(), &ClassShare::value);
}

}  // namespace fogbow
