// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <mutex>
#include <string>
#include <string_view>

#include "apps/fogbow/message_log.h"
#include "mlt/render.h"

namespace fogbow::cli {

/// Shows how far a render is on standard error: a bar that is redrawn where that is a terminal,
/// else a line now and then. Log messages go above the bar while it lives. One at a time.
class ProgressDisplay {
 public:
  enum class Style { None, Bar, Lines };

  /// `unit`: what is counted, "mutations" or "samples".
  ProgressDisplay(Style style, std::string unit, MessageLog& log);
  ~ProgressDisplay();
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// Bar on a terminal, lines elsewhere.
  static Style default_style();

  void update(const RenderProgress& progress);

 private:
  using Clock = std::chrono::steady_clock;

  void print(LogLevel level, std::string_view message);
  std::string status(const RenderProgress& progress) const;
  std::string bar_line(const RenderProgress& progress) const;
  void erase_bar();

  std::mutex mutex_;  ///< messages come from any thread
  Style style_;
  std::string unit_;
  MessageLog& log_;
  std::string stage_;
  Clock::time_point start_ = Clock::now(), next_ = start_;
  std::string shown_;  ///< the bar on the screen
};

}  // namespace fogbow::cli
