// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <map>
#include <set>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/report.h"
#include "apps/fogbow/scene_loading.h"
#include "core/util/parallel.h"

namespace fogbow::cli {

namespace {

void print_row(const char* label, const std::string& text) {
  std::printf("%-12s%s\n", label, text.c_str());
}

std::string vector_text(const Vec3& v) { return format("%.6g, %.6g, %.6g", v.x, v.y, v.z); }

/// "3 diffuse, 1 dielectric"; "none".
std::string tally_text(const std::map<std::string, std::uint64_t>& tally) {
  std::string text;
  for (const auto& [name, count] : tally)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + name;
  return text.empty() ? "none" : text;
}

void print_surfaces(const Scene& scene) {
  std::map<std::string, std::uint64_t> primitives, materials;
  for (std::uint32_t i = 0; i < scene.declared_surfaces(); ++i) {
    const Surface& surface = scene.surface(i);
    const std::uint64_t count = surface.shape->primitive_count();
    switch (surface.shape->primitive_kind()) {
      case PrimitiveKind::Triangles: primitives["triangles"] += count; break;
      case PrimitiveKind::Quads: primitives["quads"] += count; break;
      case PrimitiveKind::Analytic: primitives["curved primitives"] += count; break;
    }
    ++materials[surface.bsdf->name()];
  }
  print_row("surfaces",
            count_of(scene.declared_surfaces(), "surface") + ": " + tally_text(primitives));
  print_row("materials", tally_text(materials));
}

void print_emitters(const Scene& scene) {
  std::map<std::string, std::uint64_t> kinds;
  for (std::size_t i = 0; i < scene.emitter_count(); ++i) switch (scene.emitter(i).kind()) {
      case EmitterKind::Area: ++kinds["area"]; break;
      case EmitterKind::Point: ++kinds["point"]; break;
      case EmitterKind::Directional: ++kinds["directional"]; break;
      case EmitterKind::Infinite: ++kinds["infinite"]; break;
      case EmitterKind::Volume: ++kinds["volume"]; break;
    }
  print_row("emitters", tally_text(kinds));
}

std::string medium_name(const Medium* medium) {
  if (!medium) return "vacuum";
  return medium->id().empty() ? "unnamed medium" : "medium '" + medium->id() + "'";
}

void print_media(const Scene& scene) {
  std::set<const Medium*> media{scene.sensor_medium()};
  for (const Surface& surface : scene.surfaces())
    media.insert({surface.interior.get(), surface.exterior.get()});
  media.erase(nullptr);
  print_row("media", media.empty() ? "none" : std::to_string(media.size()));
  const Vec3 center = scene.bounds().center();
  for (const Medium* medium : media) {
    std::string text = medium_name(medium) + ": sigma_t " + vector_text(medium->sigma_t(center)) +
                       "; sigma_s " + vector_text(medium->sigma_s(center));
    if (medium->emits()) text += "; emission " + vector_text(medium->emission(center));
    print_row("", text + " (at the scene's centre)");
  }
}

void print_camera(const Scene& scene) {
  const Sensor& sensor = scene.sensor();
  const char* kind = sensor.parallel()         ? "orthographic"
                     : sensor.dirac_position() ? "pinhole"
                                               : "thin lens";
  print_row("sensor", std::string(kind) + " at " + vector_text(Vec3(sensor.to_world()[3])) +
                          ", in " + medium_name(scene.sensor_medium()) +
                          (scene.description().sensor_medium_declared ? "" : " (not declared)"));
  const FilmSettings& film = scene.film();
  std::string text = format("%dx%d, %s filter of radius %g", film.width, film.height,
                            film.filter->name(), film.filter->radius());
  if (film.crop_width > 0)
    text +=
        format(", crop %d,%d,%d,%d", film.crop_x, film.crop_y, film.crop_width, film.crop_height);
  print_row("film", text);
}

void print_integrator(const Scene& scene, const std::string& used) {
  const IntegratorSettings& asked = scene.description().integrator;
  std::string text = asked.type.empty() ? "none" : asked.type;
  for (const auto& [name, value] : asked.properties) text += ", " + name + " " + value;
  print_row("integrator", "the file asks for: " + text);
  if (used != "file")
    print_row("", "rendered with: " + used + " (--integrator file obeys the file)");
}

void print_memory(const std::map<std::string, std::size_t>& parts) {
  double total = 0;
  for (const auto& [part, bytes] : parts) total += static_cast<double>(bytes);
  print_row("memory", byte_size(total) + " to render");
  for (const auto& [part, bytes] : parts)
    print_row("", part + ": " + byte_size(static_cast<double>(bytes)));
}

}  // namespace

ExitCode run_info(const InfoArguments& arguments) {
  const ThreadLimit limit(arguments.integrator.threads);
  const MessageLog log(print_message);
  const auto loaded = load_scene(arguments.scene);
  require_no_warnings(arguments.scene, log);
  const Scene& scene = *loaded;
  RenderOptions options;
  options.integrator = arguments.integrator.name;
  options.overrides = arguments.integrator.overrides;
  options.threads = arguments.integrator.threads;
  const auto memory = render_memory(scene, options);

  print_row("scene", scene.description().title);
  print_row("hash", scene_hash(scene));
  print_surfaces(scene);
  print_row("bounds", vector_text(scene.bounds().lo) + " to " + vector_text(scene.bounds().hi) +
                          format(", radius %.6g", scene.radius()));
  print_emitters(scene);
  print_media(scene);
  print_camera(scene);
  print_integrator(scene, arguments.integrator.name);
  print_memory(memory);
  print_row("warnings", log.warnings().empty() ? "none" : std::to_string(log.warnings().size()));
  return ExitCode::Done;
}

}  // namespace fogbow::cli
