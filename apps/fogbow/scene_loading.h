// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "apps/fogbow/commands.h"
#include "core/scene/scene.h"

namespace fogbow::cli {

struct LoadedScene {
  std::unique_ptr<const Scene> scene;
  std::vector<std::string> warnings;  ///< each once, in the order they came
};

/// Reads and builds the scene and hands over each warning once, as it comes. Does not look at
/// `arguments.strict`: all warnings are wanted, not the first.
LoadedScene load_scene(const SceneArguments& arguments,
                       const std::function<void(const std::string&)>& on_warning);

/// Prints the warnings to standard error; obeys `arguments.strict`.
LoadedScene load_scene(const SceneArguments& arguments);

/// Throws Error(Scene) if there are any.
void require_no_warnings(const std::string& path, const std::vector<std::string>& warnings);

}  // namespace fogbow::cli
