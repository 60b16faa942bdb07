// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/scene_loading.h"

#include <set>

#include "apps/fogbow/console.h"
#include "core/scene_io/load.h"
#include "media/registry.h"

namespace fogbow::cli {

namespace {

/// Warnings come through the log, in lists, or both: each is kept and passed on once.
class WarningCollector {
 public:
  explicit WarningCollector(const std::function<void(const std::string&)>& pass_on)
      : pass_on_(pass_on) {
    set_log_sink([this](LogLevel level, std::string_view message) {
      if (level == LogLevel::Warning)
        add(std::string(message));
      else
        print_message(level, message);
    });
  }
  ~WarningCollector() { set_log_sink(print_message); }
  WarningCollector(const WarningCollector&) = delete;
  WarningCollector& operator=(const WarningCollector&) = delete;

  void add(const std::string& message) {
    if (!known_.insert(message).second) return;
    messages_.push_back(message);
    pass_on_(message);
  }
  const std::vector<std::string>& messages() const { return messages_; }

 private:
  const std::function<void(const std::string&)>& pass_on_;
  std::set<std::string> known_;
  std::vector<std::string> messages_;
};

}  // namespace

LoadedScene load_scene(const SceneArguments& arguments,
                       const std::function<void(const std::string&)>& on_warning) {
  WarningCollector collector(on_warning);
  LoadOptions options;
  options.definitions = arguments.definitions;
  options.size = arguments.size;
  options.crop = arguments.crop;
  options.sandbox_paths = arguments.sandbox_paths;
  std::vector<std::string> listed;
  SceneDescription description = load_mitsuba_xml(arguments.path, builtin_media(), options, listed);
  for (const std::string& warning : listed) collector.add(warning);
  auto scene = std::make_unique<const Scene>(std::move(description));
  for (const std::string& warning : scene->warnings()) collector.add(warning);
  return {std::move(scene), collector.messages()};
}

LoadedScene load_scene(const SceneArguments& arguments) {
  LoadedScene loaded = load_scene(
      arguments, [](const std::string& warning) { print_message(LogLevel::Warning, warning); });
  if (arguments.strict) require_no_warnings(arguments.path, loaded.warnings);
  return loaded;
}

void require_no_warnings(const std::string& path, const std::vector<std::string>& warnings) {
  if (warnings.empty()) return;
  throw Error(ErrorKind::Scene,
              path + ": " + count_of(warnings.size(), "warning") + ", which --strict makes errors");
}

}  // namespace fogbow::cli
