// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <functional>

#include "mlt/render.h"

namespace fogbow {

/// Time, targets and the calls to whoever watches a render.
class Session {
 public:
  Session(const RenderOptions& options, double default_samples_per_pixel, std::uint64_t pixels);

  double seconds() const;
  /// Without what came before begin_rendering().
  double render_seconds() const { return seconds() - render_start_; }
  double cpu_seconds() const;
  std::uint64_t rays() const;

  /// Samples to make in all; 2⁶³ where only time counts.
  std::uint64_t target() const;
  bool interrupted() const { return options_.stop && *options_.stop; }
  bool out_of_time() const { return options_.seconds && seconds() >= *options_.seconds; }

  void announce(const char* stage) const;
  void begin_rendering() { render_start_ = seconds(); }
  /// Progress after so many samples, and the picture where one is due.
  void report(std::uint64_t samples, double b, double b_stderr,
              const std::function<Image()>& develop);

 private:
  const RenderOptions& options_;
  double pixels_, target_ = 0;
  std::chrono::steady_clock::time_point start_;
  double cpu_start_;
  std::uint64_t rays_start_;
  double render_start_ = 0, last_picture_ = 0;
};

}  // namespace fogbow
