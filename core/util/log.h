// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string_view>

namespace fogbow {

enum class LogLevel { Debug, Info, Warning, Error };

void log(LogLevel level, std::string_view message);
inline void log_info(std::string_view message) { log(LogLevel::Info, message); }
inline void log_warning(std::string_view message) { log(LogLevel::Warning, message); }

/// Messages below `level` are dropped.
void set_log_level(LogLevel level);
/// Replaces standard error as the place messages go; an empty sink restores it.
void set_log_sink(std::function<void(LogLevel, std::string_view)> sink);

}  // namespace fogbow
