// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/report.h"
#include "apps/fogbow/scene_loading.h"
#include "core/util/parallel.h"
#include "mlt/light_census.h"
#include "mlt/render_settings.h"

namespace fogbow::cli {

namespace {

/// Parts of the light below this are not worth a word.
constexpr double kNotable = 0.01;
/// Where half of the light comes in fewer of the samples, independent samples are noisy.
constexpr double kRare = 0.03;

struct Finding {
  std::string what, advice;
};

double part(const LightCensus& census, const ReplicateMean& of) {
  return of.mean / census.luminance.mean;
}
/// Told apart from nothing as well.
bool is_notable(const LightCensus& census, const ReplicateMean& of) {
  return part(census, of) > kNotable && of.mean > 3 * of.standard_error;
}
std::string percent(double value) { return format("%.3g%%", 100 * value); }

void print_ways(const LightCensus& census) {
  const auto row = [&](const char* way, const ReplicateMean& of) {
    std::printf("  %-58s %6.2f%% +- %.2f%%\n", way, 100 * part(census, of),
                100 * of.standard_error / census.luminance.mean);
  };
  std::printf("the light of the picture (mean luminance %.4g +- %.2g):\n", census.luminance.mean,
              census.luminance.standard_error);
  row("lights seen directly or through specular surfaces", census.seen_light);
  row("glowing media seen directly or through specular surfaces", census.seen_glow);
  row("what next-event estimation can make", census.by_next_event);
  row("surfaces lit through specular surfaces (caustics)", census.surface_caustic);
  row("media lit through specular surfaces (volume caustics)", census.volume_caustic);
  row("  of these caustics, seen through specular surfaces", census.caustic_seen_through);
  row("scattered or emitted by media", census.in_media);
  std::printf("half of it lies in %s of the samples of BDPT\n\n", percent(census.half_in).c_str());
}

void find_caustics(const LightCensus& census, std::vector<Finding>& findings) {
  const double caustics =
      part(census, census.surface_caustic) + part(census, census.volume_caustic);
  const bool on_surfaces = is_notable(census, census.surface_caustic),
             in_media = is_notable(census, census.volume_caustic);
  if (!on_surfaces && !in_media) return;
  const char* where = !in_media     ? "on surfaces"
                      : on_surfaces ? "on surfaces and in media"
                                    : "in media";
  findings.push_back(
      {percent(caustics) + " of the light are caustics " + where +
           ": next-event estimation cannot make them, and path tracing finds them by running into "
           "the light",
       "use mlt; its caustic, multichain and switch mutations are made for this"});
  if (is_notable(census, census.caustic_seen_through))
    findings.push_back({percent(part(census, census.caustic_seen_through)) +
                            " of the light are caustics seen through specular surfaces: light "
                            "tracing cannot make them either, and BDPT only by chance",
                        "use mlt, with its manifold mutation on"});
}

void find_unreachable(const LightCensus& census, const Scene& scene,
                      std::vector<Finding>& findings) {
  if (!(census.dirac_lit_through > 0) || !(census.seen_through > 0)) return;
  const Sensor& sensor = scene.sensor();
  const std::string eye = sensor.parallel()         ? "the parallel rays of the camera"
                          : sensor.dirac_position() ? "the pinhole"
                                                    : "the lens";
  findings.push_back(
      {percent(census.dirac_lit_through) +
           " of the light from point or directional lights first meets a specular surface, and " +
           percent(census.seen_through) + " of the picture is seen through specular surfaces: " +
           "paths with specular vertices on both sides of every other, from a point to " + eye +
           ", are beyond every technique and missing from the picture",
       "give the lights a size: a small sphere with an area emitter of the same power"});
}

bool any_contains(const std::vector<std::string>& messages, const char* text) {
  return std::ranges::any_of(
      messages, [&](const std::string& m) { return m.find(text) != std::string::npos; });
}

/// What the boundaries of media have that should be known or mended.
std::vector<Finding> findings_of_boundaries(const Scene& scene) {
  std::vector<Finding> findings;
  for (const std::string& note : scene.overlap_notes())
    findings.push_back(
        {note, "an integer \"priority\" on the shapes says otherwise: the greater one holds"});
  const std::vector<std::string>& warnings = scene.warnings();
  if (any_contains(warnings, "overlap") || any_contains(warnings, "runs through"))
    findings.push_back({"boundaries overlap in a way that cannot be resolved",
                        "mend what the warning names; then one volume holds where several are, by "
                        "\"priority\" or as the smaller one"});
  if (any_contains(warnings, "doubtful boundary"))
    findings.push_back(
        {"boundaries of media are open or wound both ways: what medium a ray is in "
         "depends on where it came in",
         "try --repair, which closes small faults of meshes and says what it did; "
         "let open sheets end on, or behind, opaque walls"});
  return findings;
}

std::vector<Finding> findings_of(const LightCensus& census, const Scene& scene) {
  std::vector<Finding> findings;
  find_caustics(census, findings);
  find_unreachable(census, scene, findings);
  if (census.half_in < kRare)
    findings.push_back(
        {"half of the light lies in " + percent(census.half_in) +
             " of the samples: most paths that are sampled independently carry nothing",
         "use mlt, which stays where light is; let it run long enough that b is sure (its "
         "standard error is in the report)"});
  if (findings.empty())
    findings.push_back({"nothing here is hard: light comes by ways that independent samples find",
                        "bdpt or path do as well as mlt"});
  return findings;
}

void print(const std::vector<Finding>& findings) {
  for (const Finding& f : findings)
    std::printf("- %s\n  -> %s\n", f.what.c_str(), f.advice.c_str());
}

}  // namespace

ExitCode run_explain(const ExplainArguments& arguments) {
  const ThreadLimit limit(arguments.threads);
  const MessageLog log(print_message);
  const auto scene = load_scene(arguments.scene);
  require_no_warnings(arguments.scene, log);
  const int max_depth = read_render_settings(*scene, {}).max_depth;
  const LightCensus census =
      take_light_census(*scene, {.max_depth = max_depth}, arguments.samples, arguments.seed);
  if (!(census.luminance.mean > 0)) {
    std::vector<Finding> findings{
        {"no light reaches the camera in " + std::to_string(arguments.samples) + " samples of BDPT",
         "look at the side to which emitters shine, at closed boxes around lights or camera, and "
         "try more --samples"}};
    find_unreachable(census, *scene, findings);
    print(findings);
    return ExitCode::Done;
  }
  print_ways(census);
  if (!log.warnings().empty())
    std::printf("- %s about the scene, above\n  -> mend these first: `fogbow check` lists them\n",
                count_of(log.warnings().size(), "warning").c_str());
  print(findings_of_boundaries(*scene));
  print(findings_of(census, *scene));
  return ExitCode::Done;
}

}  // namespace fogbow::cli
