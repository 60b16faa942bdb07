// SPDX-License-Identifier: GPL-3.0-or-later
#include <nlohmann/json.hpp>

#include "apps/fogbow/report.h"

namespace fogbow::cli {

namespace {

using nlohmann::ordered_json;

ordered_json with_error_json(double value, double standard_error) {
  return {{"value", value}, {"standard_error", standard_error}};
}

ordered_json optional_json(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json(nullptr);
}

ordered_json scene_json(const RenderRecord& record) {
  const SceneDescription& description = record.scene.description();
  const Image& image = record.result.image;
  return {{"file", record.arguments.scene.path},
          {"title", description.title},
          {"hash", scene_hash(record.scene)},
          {"definitions", record.arguments.scene.definitions},
          {"integrator", description.integrator.type},
          {"width", image.full_width},
          {"height", image.full_height},
          {"crop", {image.x, image.y, image.width, image.height}}};
}

ordered_json kinds_json(const MutationReport& mutation) {
  ordered_json kinds = ordered_json::object();
  for (const MutationReport::Kind& kind : mutation.kinds)
    kinds[kind.name] = {{"proposed", kind.proposed}, {"accepted", kind.accepted}};
  return kinds;
}

ordered_json mutations_json(const RenderResult& result) {
  ordered_json list = ordered_json::array();
  for (const MutationReport& mutation : result.mutations) {
    ordered_json acceptance;  // null: never proposed
    if (mutation.proposed > 0)
      acceptance = static_cast<double>(mutation.accepted) / static_cast<double>(mutation.proposed);
    list.push_back({{"name", mutation.name},
                    {"weight", mutation.weight},
                    {"proposed", mutation.proposed},
                    {"accepted", mutation.accepted},
                    {"acceptance", acceptance},
                    {"rejected", mutation.rejected},
                    {"mean_squared_raster_jump", mutation.mean_squared_jump},
                    {"time_share", mutation.time_share},
                    {"seconds_per_proposal", mutation.seconds_per_proposal},
                    {"kinds", kinds_json(mutation)}});
  }
  return list;
}

ordered_json lengths_json(const RenderResult& result) {
  ordered_json list = ordered_json::array();
  for (const ClassShare& share : result.lengths)
    list.push_back(
        {{"k", share.k}, {"value", share.value}, {"standard_error", share.standard_error}});
  return list;
}

ordered_json classes_json(const RenderResult& result) {
  ordered_json list = ordered_json::array();
  for (const ClassShare& share : result.classes)
    list.push_back({{"configuration", share.configuration},
                    {"k", share.k},
                    {"value", share.value},
                    {"standard_error", share.standard_error}});
  return list;
}

ordered_json speed_json(const RenderResult& result) {
  const auto rate = [](std::uint64_t count, double seconds) {
    return seconds > 0 ? ordered_json(static_cast<double>(count) / seconds) : ordered_json(nullptr);
  };
  return {{"seconds", result.seconds},
          {"render_seconds", result.render_seconds},
          {"cpu_seconds", result.cpu_seconds},
          {"rays", result.rays},
          {"rays_per_second", rate(result.rays, result.seconds)},
          {"samples_per_second", rate(result.samples, result.render_seconds)}};
}

ordered_json options_json(const RenderArguments& arguments) {
  ordered_json overrides = ordered_json::object();
  for (const auto& [key, value] : arguments.integrator.overrides) overrides[key] = value;
  return {{"integrator", arguments.integrator.name},
          {"overrides", overrides},
          {"seconds", optional_json(arguments.seconds)},
          {"samples_per_pixel", optional_json(arguments.samples_per_pixel)},
          {"threads", arguments.integrator.threads},
          {"seed", arguments.seed}};
}

}  // namespace

std::string report_json(const RenderRecord& record) {
  const RenderResult& result = record.result;
  const ordered_json report = {
      {"version", program_version()},
      {"command", record.arguments.command},
      {"options", options_json(record.arguments)},
      {"scene", scene_json(record)},
      {"integrator", result.integrator},
      {"b", with_error_json(result.b, result.b_stderr)},
      {"b_k", lengths_json(result)},
      {"b_k_c", classes_json(result)},
      {"samples", result.samples},
      {"sample_unit", sample_unit(result.integrator)},
      {"chains", result.chains},
      {"groups", result.groups},
      {"mutations", mutations_json(result)},
      {"diagnostics", result.diagnostics},
      {"non_finite", result.non_finite},
      {"speed", speed_json(result)},
      {"interrupted", result.interrupted},
      {"groups_disagree", result.groups_disagree},
      {"exit_code", static_cast<int>(record.exit_code)},
      {"notes", result.notes},
      {"warnings", record.warnings},
      {"files",
       {{"exr", record.files.exr}, {"png", record.files.png}, {"json", record.files.json}}}};
  // Names and paths need not be UTF-8, JSON must.
  return report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace fogbow::cli
