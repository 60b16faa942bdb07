// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render_settings.h"

#include <charconv>

namespace fogbow {

namespace {

/// Longest path where the scene sets no limit, in edges.
constexpr int kDepthCap = 256;

template <class T>
T parse_number(const std::string& name, const std::string& text, T least, T most) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= least) ||
      !(value <= most))
    throw Error(ErrorKind::Usage, "integrator property \"" + name + "\" is \"" + text +
                                      "\", expected a number from " + std::to_string(least) +
                                      " to " + std::to_string(most));
  return value;
}

bool parse_boolean(const std::string& name, const std::string& text) {
  if (text == "true") return true;
  if (text == "false") return false;
  throw Error(ErrorKind::Usage,
              "integrator property \"" + name + "\" is \"" + text + "\", expected true or false");
}

/// Our name of an integrator that other renderers' files ask for; empty if there is none.
std::string own_integrator(const std::string& type) {
  if (type == "path" || type == "volpath" || type == "volpathmis") return "path";
  if (type == "light" || type == "ptracer") return "light";
  if (type == "bdpt") return "bdpt";
  if (type == "pssmlt" || type == "mlt") return type;
  return {};
}

/// False if the property is none of ours.
bool apply(RenderSettings& settings, const std::string& name, const std::string& value) {
  if (name == "max_depth" || name == "maxDepth") {
    const int depth = parse_number<int>(name, value, -1, 1 << 16);
    settings.depth_capped = depth == -1;
    settings.max_depth = depth == -1 ? kDepthCap : depth;
  } else if (name == "rr_depth" || name == "rrDepth") {
    settings.rr_depth = parse_number<int>(name, value, 0, 1 << 16);
  } else if (name == "hide_emitters" || name == "hideEmitters") {
    settings.hide_emitters = parse_boolean(name, value);
  } else if (name == "p_large" || name == "pLarge") {
    settings.large_step_probability = parse_number<double>(name, value, 1e-3, 1);
  } else if (name == "mutations") {
    settings.mutations = parse_mutation_weights(value);
  } else if (name == "two_stage" || name == "twoStage") {
    settings.two_stage = parse_boolean(name, value);
  } else if (name == "luminance_samples" || name == "luminanceSamples") {
    settings.bootstrap_samples = parse_number<int>(name, value, 8, 1 << 28);
  } else if (name == "chains") {
    settings.chains_per_group = parse_number<int>(name, value, 1, 1 << 16);
  } else if (name == "sample_count") {
    settings.samples_per_pixel = parse_number<int>(name, value, 1, 1 << 30);
  } else {
    return false;
  }
  return true;
}

}  // namespace

RenderSettings read_render_settings(const Scene& scene, const RenderOptions& options) {
  RenderSettings settings;
  settings.max_depth = kDepthCap;
  settings.depth_capped = true;
  const IntegratorSettings& asked = scene.description().integrator;
  const bool obey = options.integrator == "file";
  const std::string type = obey ? asked.type : options.integrator;
  settings.integrator = type == "auto" || (obey && type.empty()) ? "mlt" : own_integrator(type);
  if (settings.integrator.empty())
    throw Error(ErrorKind::Usage, "unknown integrator \"" + type +
                                      "\", expected auto, file, path, light, bdpt, pssmlt or mlt");
  if (!asked.type.empty() && asked.type != settings.integrator)
    settings.notes.push_back("the scene asks for integrator \"" + asked.type +
                             "\"; rendered by \"" + settings.integrator + "\"");
  // Light from emitters on the first surface: what this integrator's picture is, by any sampler.
  constexpr int kDirectDepth = 2;
  if (asked.type == "direct") {
    settings.max_depth = kDirectDepth;
    settings.depth_capped = false;
  }
  for (const auto& [name, value] : asked.properties)
    if (!apply(settings, name, value))
      settings.notes.push_back("integrator property \"" + name + "\" has no effect");
  for (const auto& [name, value] : options.overrides)
    if (!apply(settings, name, value))
      throw Error(ErrorKind::Usage,
                  "unknown integrator property \"" + name +
                      "\", expected max_depth, rr_depth, "
                      "hide_emitters, p_large, mutations, two_stage, luminance_samples, chains or "
                      "sample_count");
  return settings;
}

}  // namespace fogbow
