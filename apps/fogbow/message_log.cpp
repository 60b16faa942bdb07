// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/message_log.h"

namespace fogbow::cli {

MessageLog::MessageLog(Printer printer) : printer_(std::move(printer)) {
  set_log_sink([this](LogLevel level, std::string_view message) { receive(level, message); });
}

MessageLog::~MessageLog() { set_log_sink({}); }

void MessageLog::receive(LogLevel level, std::string_view message) {
  if (level == LogLevel::Warning) {
    if (!known_.emplace(message).second) return;
    warnings_.emplace_back(message);
  }
  printer_(level, message);
}

}  // namespace fogbow::cli
