// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/session.h"

#include <algorithm>
#include <ctime>

#include "core/path/transport.h"

namespace fogbow {

namespace {

double process_cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

Session::Session(const RenderOptions& options, double default_samples_per_pixel,
                 std::uint64_t pixels)
    : options_(options),
      pixels_(static_cast<double>(pixels)),
      start_(std::chrono::steady_clock::now()),
      cpu_start_(process_cpu_seconds()),
      rays_start_(rays_traced()) {
  if (options.samples_per_pixel)
    target_ = *options.samples_per_pixel * pixels_;
  else if (!options.seconds)
    target_ = default_samples_per_pixel * pixels_;
}

double Session::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double Session::cpu_seconds() const { return process_cpu_seconds() - cpu_start_; }

std::uint64_t Session::rays() const { return rays_traced() - rays_start_; }

std::uint64_t Session::target() const {
  return target_ > 0 ? static_cast<std::uint64_t>(std::llround(target_)) : std::uint64_t{1} << 63;
}

void Session::announce(const char* stage) const {
  if (!options_.on_progress) return;
  RenderProgress p;
  p.stage = stage;
  p.seconds = seconds();
  options_.on_progress(p);
}

void Session::report(std::uint64_t samples, double b, double b_stderr,
                     const std::function<Image()>& develop) {
  if (options_.on_progress) {
    RenderProgress p;
    p.stage = "render";
    p.seconds = seconds();
    p.samples_per_pixel = static_cast<double>(samples) / pixels_;
    p.samples_per_second = static_cast<double>(samples) / std::max(render_seconds(), 1e-9);
    p.b = b;
    p.b_stderr = b_stderr;
    if (target_ > 0) p.fraction = static_cast<double>(samples) / target_;
    if (options_.seconds) p.fraction = std::max(p.fraction, p.seconds / *options_.seconds);
    p.fraction = std::min(p.fraction, 1.0);
    options_.on_progress(p);
  }
  const bool due =
      options_.picture_interval > 0 && seconds() - last_picture_ >= options_.picture_interval;
  if (options_.on_picture && (due || (options_.save_now && *options_.save_now))) {
    options_.on_picture(develop());
    last_picture_ = seconds();
  }
}

}  // namespace fogbow
