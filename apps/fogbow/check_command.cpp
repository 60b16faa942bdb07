// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/scene_loading.h"

namespace fogbow::cli {

ExitCode run_check(const SceneArguments& arguments) {
  const LoadedScene loaded = load_scene(
      arguments, [](const std::string& warning) { std::printf("warning: %s\n", warning.c_str()); });
  std::printf("%s: %s\n", arguments.path.c_str(),
              loaded.warnings.empty() ? "nothing to complain about"
                                      : count_of(loaded.warnings.size(), "warning").c_str());
  if (arguments.strict) require_no_warnings(arguments.path, loaded.warnings);
  return ExitCode::Done;
}

}  // namespace fogbow::cli
