// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/signals.h"

#include <csignal>

namespace fogbow::cli {

namespace {

std::atomic<bool> armed{false}, stop_flag{false}, save_flag{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers need lock-free flags");

constexpr int kStopSignals[] = {SIGINT, SIGTERM};

extern "C" void on_stop(int signal) {
  if (armed && !stop_flag.exchange(true)) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);  // delivered on return: the caller sees a death by signal
}

extern "C" void on_save(int) { save_flag = true; }

void install(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

SignalScope::SignalScope() {
  armed = stop_flag = save_flag = false;
  for (const int signal : kStopSignals) install(signal, on_stop);
  install(SIGUSR1, on_save);
}

SignalScope::~SignalScope() {
  for (const int signal : kStopSignals) install(signal, SIG_DFL);
  install(SIGUSR1, SIG_DFL);
}

void SignalScope::arm() { armed = true; }

const std::atomic<bool>& SignalScope::stop() { return stop_flag; }
std::atomic<bool>& SignalScope::save_now() { return save_flag; }

}  // namespace fogbow::cli
