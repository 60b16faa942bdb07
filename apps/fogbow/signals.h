// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <atomic>

namespace fogbow::cli {

/// While it lives, SIGINT and SIGTERM ask for a stop (a second one ends the program at once, and so
/// does the first before `arm`), and SIGUSR1 asks for the picture so far. One at a time.
class SignalScope {
 public:
  SignalScope();
  ~SignalScope();
  SignalScope(const SignalScope&) = delete;
  SignalScope& operator=(const SignalScope&) = delete;

  /// From here on there is something to save.
  void arm();

  static const std::atomic<bool>& stop();
  static std::atomic<bool>& save_now();
};

}  // namespace fogbow::cli
