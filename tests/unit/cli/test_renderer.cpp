// SPDX-License-Identifier: GPL-3.0-or-later
// A renderer for tests of the command line: it ends the way `--set integrator.outcome=…` says and
// takes as long as --time says, so that every exit code and every field can be asked for.
#include <chrono>
#include <cmath>
#include <new>
#include <thread>

#include "core/util/error.h"
#include "core/util/log.h"
#include "mlt/render.h"

namespace fogbow {

namespace {

std::string setting(const RenderOptions& options, const std::string& key) {
  std::string found;
  for (const auto& [name, value] : options.overrides)
    if (name == key) found = value;
  return found;
}

/// Red counts columns, green rows, blue is one half.
Image gradient(const FilmSettings& film) {
  const bool crop = film.crop_width > 0;
  Image image(crop ? film.crop_width : film.width, crop ? film.crop_height : film.height,
              {"R", "G", "B", "Error.R", "Error.G", "Error.B"});
  image.x = crop ? film.crop_x : 0;
  image.y = crop ? film.crop_y : 0;
  image.full_width = film.width;
  image.full_height = film.height;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      image.at(x, y, 0) = static_cast<float>(x);
      image.at(x, y, 1) = static_cast<float>(y);
      image.at(x, y, 2) = 0.5f;
    }
  return image;
}

void fail_if_asked(const std::string& outcome) {
  if (outcome == "usage") throw Error(ErrorKind::Usage, "no such property");
  if (outcome == "no_light") throw Error(ErrorKind::NoLight, "nothing carries light");
  if (outcome == "numerical") throw Error(ErrorKind::Numerical, "the film overflows");
  if (outcome == "bad_alloc") throw std::bad_alloc();
}

RenderProgress progress_at(double fraction, double seconds) {
  RenderProgress progress;
  progress.fraction = fraction;
  progress.seconds = seconds;
  progress.samples_per_pixel = 64 * fraction;
  progress.samples_per_second = 1.5e6;
  progress.b = 0.25;
  progress.b_stderr = 0.0025;
  progress.stage = fraction < 0.1 ? "bootstrap" : "render";
  return progress;
}

/// True if it was stopped.
bool pass_time(const RenderOptions& options, const Image& image, double& seconds) {
  using Clock = std::chrono::steady_clock;
  const std::string outcome = setting(options, "outcome");
  const auto start = Clock::now();
  const double total = options.seconds.value_or(0);
  double next_picture = options.picture_interval > 0 ? options.picture_interval : INFINITY;
  bool spoken = outcome != "chatty";
  for (;;) {
    seconds = std::chrono::duration<double>(Clock::now() - start).count();
    options.on_progress(progress_at(total > 0 ? std::fmin(1, seconds / total) : 1, seconds));
    if (!spoken && seconds > total / 2) {
      log_warning("a word on the way");
      spoken = true;
    }
    if (*options.stop && outcome != "stubborn") return true;
    if (*options.save_now || seconds >= next_picture) {
      options.on_picture(image);
      if (seconds >= next_picture) next_picture += options.picture_interval;
    }
    if (seconds >= total) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void fill_statistics(RenderResult& result, const RenderOptions& options) {
  result.integrator = options.integrator == "auto" ? "pssmlt" : options.integrator;
  result.b = 0.25;
  result.b_stderr = 0.0025;
  result.samples = 40'000'000'000;  // more than 32 bits
  result.chains = 64;
  result.groups = 8;
  result.cpu_seconds = 1.5;
  result.rays = 123456;
  result.lengths = {{2, 0.05, 0.001}, {3, 0.2, 0.002}, {4, 1e-6, 1e-7}, {9, 5e-7, 1e-7}};
  result.classes = {{3, 0.19, 0.002, "SMS"}, {2, 0.05, 0.001, "SS"}};
  result.mutations = {{"large step",
                       0.5,
                       1000,
                       250,
                       {{"Occluded", 500}, {"NonFinite", 3}},
                       0.0625,
                       0.75,
                       1e-6,
                       {{"S-V", 400, 100}, {"V-S", 600, 150}, {"never", 0, 0}}},
                      {"small step", 1.5, 0, 0, {}, 0, 0, 0, {}}};
  result.diagnostics = {{"r_hat", 1.01}};
  result.notes = {"the scene asks for volpath"};
}

}  // namespace

RenderResult render(const Scene& scene, const RenderOptions& options) {
  const std::string outcome = setting(options, "outcome");
  fail_if_asked(outcome);
  RenderResult result;
  result.image = gradient(scene.film());
  result.interrupted = pass_time(options, result.image, result.seconds);
  result.render_seconds = 0.5 * result.seconds;  // the rest is the bootstrap
  fill_statistics(result, options);
  result.groups_disagree = outcome == "disagree";
  if (outcome == "non_finite") {
    result.non_finite = 3;
    result.b_stderr = NAN;
  }
  if (outcome == "latin1") result.notes = {"caf\xe9"};
  return result;
}

std::string replay(const Scene&, const RenderOptions& options, std::uint64_t seed,
                   std::uint64_t chain, std::uint64_t step) {
  return options.integrator + " seed " + std::to_string(seed) + " chain " + std::to_string(chain) +
         " step " + std::to_string(step);
}

std::map<std::string, std::size_t> render_memory(const Scene&, const RenderOptions& options) {
  const std::string asked = setting(options, "memory");
  return {{"film", asked.empty() ? std::size_t{1} << 20 : std::stoull(asked)},
          {"scene", std::size_t{4} << 10}};
}

}  // namespace fogbow
