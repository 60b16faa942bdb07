// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/scene_loading.h"

#include "apps/fogbow/console.h"
#include "core/image/image_io.h"
#include "core/scene_io/load.h"
#include "media/registry.h"

namespace fogbow::cli {

std::unique_ptr<const Scene> load_scene(const SceneArguments& arguments) {
  LoadOptions options;
  options.definitions = arguments.definitions;
  options.size = arguments.size;
  options.crop = arguments.crop;
  options.sandbox_paths = arguments.sandbox_paths;
  options.repair = arguments.repair;
  options.read_image = read_image;
  std::vector<std::string> warnings;
  SceneDescription description =
      load_mitsuba_xml(arguments.path, builtin_media(), options, warnings);
  // Some were logged as they came, and the log shows each once.
  for (const std::string& warning : warnings) log_warning(warning);
  auto scene = std::make_unique<const Scene>(std::move(description));
  for (const std::string& warning : scene->warnings()) log_warning(warning);
  return scene;
}

void require_no_warnings(const SceneArguments& arguments, const MessageLog& log) {
  if (!arguments.strict || log.warnings().empty()) return;
  throw Error(ErrorKind::Scene, arguments.path + ": " + count_of(log.warnings().size(), "warning") +
                                    ", which --strict makes errors");
}

}  // namespace fogbow::cli
