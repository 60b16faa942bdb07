// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/util/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <mutex>

namespace fogbow {

namespace {
std::atomic<LogLevel> threshold{LogLevel::Info};
std::mutex sink_mutex;
std::function<void(LogLevel, std::string_view)> custom_sink;

spdlog::logger& console() {
  static auto logger = [] {
    auto result = std::make_shared<spdlog::logger>(
        "fogbow", std::make_shared<spdlog::sinks::stderr_color_sink_mt>());
    result->set_pattern("%^%l%$: %v");
    result->set_level(spdlog::level::trace);
    return result;
  }();
  return *logger;
}

spdlog::level::level_enum spdlog_level(LogLevel level) {
  switch (level) {
    case LogLevel::Debug: return spdlog::level::debug;
    case LogLevel::Info: return spdlog::level::info;
    case LogLevel::Warning: return spdlog::level::warn;
    case LogLevel::Error: return spdlog::level::err;
  }
  return spdlog::level::err;
}
}  // namespace

void log(LogLevel level, std::string_view message) {
  if (level < threshold) return;
  const std::lock_guard lock(sink_mutex);
  if (custom_sink)
    custom_sink(level, message);
  else
    console().log(spdlog_level(level), message);
}

void set_log_level(LogLevel level) { threshold = level; }

void set_log_sink(std::function<void(LogLevel, std::string_view)> sink) {
  const std::lock_guard lock(sink_mutex);
  custom_sink = std::move(sink);
}

}  // namespace fogbow
