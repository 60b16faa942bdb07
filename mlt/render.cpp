// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render.h"

#include <algorithm>
#include <sstream>

#include "core/util/parallel.h"
#include "mlt/render_parts.h"

namespace fogbow {

namespace {

/// The light that no technique of an integrator samples; empty where there is none such.
std::string unreachable_light(const Scene& scene, const std::string& integrator) {
  bool dirac_lights = false;
  for (std::size_t i = 0; i < scene.emitter_count(); ++i)
    dirac_lights |= is_dirac(scene.emitter(i).kind());
  const bool specular =
      std::ranges::any_of(scene.surfaces(), [](const Surface& s) { return s.bsdf->has_dirac(); });
  if (!specular) return {};
  if (integrator == "light") return "what is seen through specular surfaces";
  if (!dirac_lights) return {};
  const std::string such =
      "light from point or directional lights that goes through specular surfaces";
  if (integrator == "path") return such;
  return such +
         " and is seen through specular surfaces, with no two other vertices next to each other,";
}

void finish(RenderResult& result, const Scene& scene, const Session& session,
            const RenderSettings& settings) {
  result.integrator = settings.integrator;
  result.groups = Film::kGroups;
  result.seconds = session.seconds();
  result.render_seconds = session.render_seconds();
  result.cpu_seconds = session.cpu_seconds();
  result.rays = session.rays();
  result.notes.insert(result.notes.begin(), settings.notes.begin(), settings.notes.end());
  if (const std::string light = unreachable_light(scene, settings.integrator); !light.empty())
    result.notes.push_back(light + " is not sampled by " + settings.integrator);
  if (!settings.depth_capped || result.lengths.empty()) return;
  const ClassShare& last = result.lengths.back();
  const double cut = last.k == settings.max_depth + 1 ? last.value : 0;
  std::ostringstream note;
  note << "the scene sets no max_depth: paths are cut at " << settings.max_depth
       << " edges; the longest kept carry " << (result.b > 0 ? 100 * cut / result.b : 0)
       << "% of the light";
  result.notes.push_back(note.str());
}

}  // namespace

std::unique_ptr<Estimator> make_estimator(const Scene& scene, const RenderSettings& settings) {
  EstimatorSettings s;
  s.max_depth = settings.max_depth;
  s.rr_depth = settings.rr_depth;
  s.hide_emitters = settings.hide_emitters;
  if (settings.integrator == "path") return make_path_tracer(scene, s);
  if (settings.integrator == "light") return make_light_tracer(scene, s);
  s.seen_light = !settings.uses_chains();
  return make_bdpt(scene, s);
}

int least_film_exponent(const Scene& scene) {
  constexpr int kFractionBits = 46;
  // Power through the sphere around the scene, as radiance.
  const double radiance = scene.power() / sqr(2 * kPi * scene.radius());
  return radiance > 0 ? std::ilogb(radiance) - kFractionBits : 0;
}

PictureScale PictureScale::of_samples(std::uint64_t samples) {
  PictureScale scale{1 / static_cast<double>(samples), {}};
  scale.group.fill(Film::kGroups * scale.all);
  return scale;
}

ReplicateMean PictureScale::operator()(const std::array<double, Film::kGroups>& sums) const {
  std::array<double, Film::kGroups> groups;
  double total = 0;
  for (int g = 0; g < Film::kGroups; ++g) {
    groups[g] = sums[g] * group[g];
    total += sums[g];
  }
  return {total * all, replicate_mean(groups).standard_error};
}

std::vector<ClassShare> length_shares(const LengthTally& tally, const PictureScale& scale) {
  std::size_t longest = 0;
  for (const auto& sums : tally) longest = std::max(longest, sums.size());
  std::vector<ClassShare> result;
  for (std::size_t k = 0; k < longest; ++k) {
    std::array<double, Film::kGroups> groups{};
    for (int g = 0; g < Film::kGroups; ++g)
      if (k < tally[g].size()) groups[g] = tally[g][k];
    const ReplicateMean m = scale(groups);
    if (m.mean > 0) result.push_back({static_cast<int>(k), m.mean, m.standard_error});
  }
  return result;
}

ReplicateMean total_luminance(const LengthTally& tally, const PictureScale& scale) {
  std::array<double, Film::kGroups> groups{};
  for (int g = 0; g < Film::kGroups; ++g)
    for (const double sum : tally[g]) groups[g] += sum;
  return scale(groups);
}

RenderResult render(const Scene& scene, const RenderOptions& options) {
  const RenderSettings settings = read_render_settings(scene, options);
  const ThreadLimit limit(options.threads);
  const auto [width, height] = rendered_size(scene.film());
  Session session(options, settings.samples_per_pixel, static_cast<std::uint64_t>(width) * height);
  RenderResult result = settings.uses_chains()
                            ? render_chains(scene, options, settings, session)
                            : render_independent(scene, options, settings, session);
  finish(result, scene, session, settings);
  return result;
}

std::map<std::string, std::size_t> render_memory(const Scene& scene, const RenderOptions& options) {
  const RenderSettings settings = read_render_settings(scene, options);
  std::map<std::string, std::size_t> parts;
  parts["acceleration"] = scene.accel().memory_bytes();
  for (const auto& medium : scene.media())
    if (const std::size_t bytes = medium->memory_bytes()) parts["volumes"] += bytes;
  parts["film"] = Film::memory_bytes(scene.film());
  const auto depth = static_cast<std::size_t>(settings.max_depth);
  const std::size_t workspace = 2 * depth * sizeof(SubpathVertex);
  if (settings.uses_chains()) {
    const std::size_t primary_samples = 12 * depth * sizeof(double);
    const std::size_t chain = 2 * (workspace + primary_samples);
    parts["film"] *= 2;  // one of the light that chains leave out
    parts["chains"] = Film::kGroups * static_cast<std::size_t>(settings.chains_per_group) * chain;
    parts["bootstrap"] = static_cast<std::size_t>(settings.bootstrap_samples) * sizeof(double);
  } else {
    parts["workspaces"] = static_cast<std::size_t>(hardware_threads()) * workspace;
  }
  return parts;
}

}  // namespace fogbow
