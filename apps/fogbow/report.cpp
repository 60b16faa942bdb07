// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/report.h"

#include <algorithm>
#include <cinttypes>
#include <cmath>
#include <span>

#include "apps/fogbow/console.h"
#include "core/image/image_metadata.h"

namespace fogbow::cli {

namespace {

constexpr double kFaintPercent = 0.01;

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

double per_second(double count, double seconds) { return seconds > 0 ? count / seconds : 0; }

std::string mutation_line(const MutationReport& mutation) {
  const auto proposed = static_cast<double>(mutation.proposed);
  std::string line =
      format("  %-16s %s proposed, %.2f%% accepted, %.0f%% of the time, rms jump %.2g",
             mutation.name.c_str(), with_si_prefix(proposed).c_str(),
             percent(static_cast<double>(mutation.accepted), proposed), 100 * mutation.time_share,
             std::sqrt(mutation.mean_squared_jump));
  const char* separator = "; refused: ";
  for (const auto& [kind, count] : mutation.rejected) {
    if (count == 0) continue;
    line += format("%s%s %.2f%%", separator, kind.c_str(),
                   percent(static_cast<double>(count), proposed));
    separator = ", ";
  }
  line += "\n";
  for (const MutationReport::Kind& kind : mutation.kinds)
    if (kind.proposed > 0)
      line +=
          format("    %-26s %s proposed, %.2f%% accepted\n", kind.name.c_str(),
                 with_si_prefix(static_cast<double>(kind.proposed)).c_str(),
                 percent(static_cast<double>(kind.accepted), static_cast<double>(kind.proposed)));
  return line;
}

/// Lengths that carry next to nothing share a line; the JSON has them all.
std::string lengths_table(const RenderResult& result) {
  std::string table = "paths by number of vertices (b_k, share of b):\n";
  std::uint64_t faint = 0;
  double rest = 0;
  for (const ClassShare& share : result.lengths) {
    if (!(percent(share.value, result.b) >= kFaintPercent)) {
      ++faint;
      rest += share.value;
      continue;
    }
    table += format("  %4d  %-26s %6.2f%%\n", share.k,
                    with_error(share.value, share.standard_error).c_str(),
                    percent(share.value, result.b));
  }
  if (faint > 0)
    table += format("  %s more with %.2g%%\n", count_of(faint, "length").c_str(),
                    percent(rest, result.b));
  return table;
}

/// The largest; the JSON has them all.
std::string classes_table(const RenderResult& result) {
  constexpr std::size_t kShown = 8;
  std::string table =
      "largest classes, from light to eye (S on surfaces, M in media; b_k^c, share of b):\n";
  for (const ClassShare& share :
       std::span(result.classes).first(std::min(kShown, result.classes.size())))
    table += format("  %-12s %-26s %6.2f%%\n", share.configuration.c_str(),
                    with_error(share.value, share.standard_error).c_str(),
                    percent(share.value, result.b));
  return table;
}

/// Row vectors and the axes of OpenEXR's standard attribute: x right, y up, z forward, in world
/// units.
std::vector<float> world_to_camera(const Sensor& sensor) {
  const Mat4 to_world = sensor.to_world();
  const double scale = length(Vec3(to_world[2]));
  Mat4 axes(1.0);
  axes[0][0] = -scale;  // our cameras have +x to the left
  axes[1][1] = axes[2][2] = scale;
  const Mat4 m = axes * glm::inverse(to_world);
  std::vector<float> elements;
  // A column of a matrix for column vectors is a row of one for row vectors.
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row) elements.push_back(static_cast<float>(m[column][row]));
  return elements;
}

void describe_run(Image& image, const Scene& scene, const RenderArguments& arguments) {
  image.metadata["fogbowVersion"] = program_version();
  image.metadata["sceneHash"] = scene_hash(scene);
  image.metadata["seed"] = std::to_string(arguments.seed);
  image.metadata["worldToCamera"] = world_to_camera(scene.sensor());
}

void describe_state(Image& image, double b, double b_stderr, double samples, double seconds) {
  image.metadata[kMetadataB] = static_cast<float>(b);
  image.metadata[kMetadataBError] = static_cast<float>(b_stderr);
  image.metadata["samples"] = format("%.0f", samples);  // too many for an EXR integer
  image.metadata["renderTimeSeconds"] = static_cast<float>(seconds);
}

}  // namespace

std::string report_text(const RenderRecord& record) {
  const RenderResult& result = record.result;
  const std::string unit = sample_unit(result.integrator);
  const auto samples = static_cast<double>(result.samples);
  const double pixels = static_cast<double>(result.image.width) * result.image.height;
  std::string text = "integrator " + result.integrator;
  if (result.chains > 0)
    text +=
        format(", %s in %s", count_of(static_cast<std::uint64_t>(result.chains), "chain").c_str(),
               count_of(static_cast<std::uint64_t>(result.groups), "group").c_str());
  text += "\nb = " + with_error(result.b, result.b_stderr) + "\n";
  if (!result.lengths.empty()) text += lengths_table(result);
  if (!result.classes.empty()) text += classes_table(result);
  if (!result.mutations.empty()) text += "mutations:\n";
  for (const MutationReport& mutation : result.mutations) text += mutation_line(mutation);
  text +=
      format("%s %s (%.4g a pixel) in %s (%.1f CPU-s): %s %s/s, %s rays/s\n",
             with_si_prefix(samples).c_str(), unit.c_str(), pixels > 0 ? samples / pixels : 0.0,
             duration(result.seconds).c_str(), result.cpu_seconds,
             with_si_prefix(per_second(samples, result.render_seconds)).c_str(), unit.c_str(),
             with_si_prefix(per_second(static_cast<double>(result.rays), result.seconds)).c_str());
  text += "wrote " + record.files.exr + ", " + record.files.png + ", " + record.files.json + "\n";
  return text;
}

void describe_picture(Image& image, const Scene& scene, const RenderArguments& arguments,
                      const RenderProgress& progress) {
  describe_run(image, scene, arguments);
  const double pixels = static_cast<double>(image.width) * image.height;
  describe_state(image, progress.b, progress.b_stderr, progress.samples_per_pixel * pixels,
                 progress.seconds);
  image.metadata["finished"] = 0;
}

void describe_picture(Image& image, const RenderRecord& record) {
  const RenderResult& result = record.result;
  describe_run(image, record.scene, record.arguments);
  describe_state(image, result.b, result.b_stderr, static_cast<double>(result.samples),
                 result.seconds);
  image.metadata["integrator"] = result.integrator;
  image.metadata["chains"] = result.chains;
  image.metadata["finished"] = result.interrupted ? 0 : 1;
}

std::string sample_unit(const std::string& integrator) {
  static constexpr const char* independent[] = {"path",  "volpath", "volpathmis",
                                                "light", "ptracer", "bdpt"};
  return std::ranges::find(independent, integrator) != std::end(independent) ? "samples"
                                                                             : "mutations";
}

std::string scene_hash(const Scene& scene) {
  return format("%016" PRIx64, scene.description().content_hash);
}

std::string program_version() { return "fogbow " FOGBOW_VERSION; }

}  // namespace fogbow::cli
