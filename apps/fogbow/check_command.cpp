// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/scene_loading.h"

namespace fogbow::cli {

namespace {

/// Warnings are what `check` is asked for: they go to standard output.
void print_finding(LogLevel level, std::string_view message) {
  if (level != LogLevel::Warning) return print_message(level, message);
  std::printf("warning: %.*s\n", static_cast<int>(message.size()), message.data());
}

}  // namespace

ExitCode run_check(const SceneArguments& arguments) {
  const MessageLog log(print_finding);
  load_scene(arguments);
  std::printf("%s: %s\n", arguments.path.c_str(),
              log.warnings().empty() ? "nothing to complain about"
                                     : count_of(log.warnings().size(), "warning").c_str());
  require_no_warnings(arguments, log);
  return ExitCode::Done;
}

}  // namespace fogbow::cli
