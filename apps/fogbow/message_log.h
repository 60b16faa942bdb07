// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "core/util/log.h"

namespace fogbow::cli {

/// The log's sink while it lives: prints messages and keeps the warnings, each once. One at a time.
class MessageLog {
 public:
  using Printer = std::function<void(LogLevel, std::string_view)>;

  explicit MessageLog(Printer printer);
  ~MessageLog();
  MessageLog(const MessageLog&) = delete;
  MessageLog& operator=(const MessageLog&) = delete;

  /// Not while other threads log.
  void set_printer(Printer printer) { printer_ = std::move(printer); }
  /// In the order they came.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void receive(LogLevel level, std::string_view message);

  Printer printer_;
  std::set<std::string, std::less<>> known_;
  std::vector<std::string> warnings_;
};

}  // namespace fogbow::cli
