// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/message_log.h"
#include "core/scene/scene.h"

namespace fogbow::cli {

/// Reads and builds the scene; all that there is to warn of is logged.
std::unique_ptr<const Scene> load_scene(const SceneArguments& arguments);

/// Under --strict throws Error(Scene) if anything was warned of: after loading, so that all
/// warnings are seen and not the first.
void require_no_warnings(const SceneArguments& arguments, const MessageLog& log);

}  // namespace fogbow::cli
