// SPDX-License-Identifier: GPL-3.0-or-later
#include <unistd.h>

#include <cstdio>
#include <filesystem>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/files.h"
#include "apps/fogbow/progress.h"
#include "apps/fogbow/report.h"
#include "apps/fogbow/scene_loading.h"
#include "apps/fogbow/signals.h"
#include "core/image/image_io.h"
#include "core/util/parallel.h"

namespace fogbow::cli {

namespace {

OutputFiles output_files(const RenderArguments& arguments) {
  OutputFiles files;
  files.exr = arguments.output.empty() ? default_output(arguments.scene.path) : arguments.output;
  files.png = with_extension(files.exr, ".png");
  files.json = arguments.json.empty() ? with_extension(files.exr, ".json") : arguments.json;
  if (!has_extension(files.exr, ".exr"))
    throw Error(ErrorKind::Usage,
                "-o: expected a name that ends in .exr (a PNG is written beside it), found '" +
                    files.exr + "'");
  std::error_code error;
  if (std::filesystem::equivalent(files.json, arguments.scene.path, error) ||
      files.json == files.exr || files.json == files.png)
    throw Error(ErrorKind::Usage, "--json: '" + files.json + "' is another file of this render");
  for (const std::string& path : {files.exr, files.png, files.json}) require_writable(path);
  return files;
}

RenderOptions render_options(const RenderArguments& arguments) {
  RenderOptions options;
  options.integrator = arguments.integrator.name;
  options.overrides = arguments.integrator.overrides;
  options.threads = arguments.integrator.threads;
  options.seconds = arguments.seconds;
  options.samples_per_pixel = arguments.samples_per_pixel;
  options.seed = arguments.seed;
  options.picture_interval = arguments.picture_interval;
  return options;
}

/// Rather a message now than the system's out-of-memory killer later.
void require_memory(const Scene& scene, const RenderOptions& options) {
  double needed = 0;
  for (const auto& [part, bytes] : render_memory(scene, options))
    needed += static_cast<double>(bytes);
  const double present =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  if (needed > present)
    throw Error(ErrorKind::Memory, "the render needs " + byte_size(needed) +
                                       " of memory and this machine has " + byte_size(present));
}

void write_pictures(const Image& image, const OutputFiles& files, double exposure) {
  write_exr(files.exr, image);
  write_png(files.png, image, exposure);
}

/// Adds what the program says along the way to `options`, and the pictures at intervals.
void attach_callbacks(RenderOptions& options, const RenderArguments& arguments, const Scene& scene,
                      const OutputFiles& files, ProgressDisplay& display) {
  options.stop = &SignalScope::stop();
  options.save_now = &SignalScope::save_now();
  auto last = std::make_shared<RenderProgress>();
  options.on_progress = [last, &display](const RenderProgress& progress) {
    *last = progress;
    display.update(progress);
  };
  options.on_picture = [last, &arguments, &scene, &files](const Image& so_far) {
    SignalScope::save_now() = false;  // before writing: a request made meanwhile counts
    Image image = so_far;
    describe_picture(image, scene, arguments, *last);
    try {
      write_pictures(image, files, arguments.exposure);
    } catch (const Error& error) {
      // The render is worth more than this picture: the disk may have room again at the end.
      log_warning(std::string("the picture so far was not saved: ") + error.what());
    }
  };
}

ExitCode exit_code_of(const RenderResult& result) {
  if (result.interrupted) return ExitCode::Interrupted;
  return result.groups_disagree ? ExitCode::GroupsDisagree : ExitCode::Done;
}

void warn_of(const RenderResult& result) {
  if (result.non_finite > 0)
    log_warning(count_of(result.non_finite, "non-finite contribution") + " refused");
  if (result.groups_disagree)
    log_warning("the groups of chains disagree by more than their errors allow: render longer");
  if (result.interrupted)
    log_warning(
        "interrupted: the picture so far is written (going on from it is not possible yet)");
}

RenderResult render_with_display(const RenderArguments& arguments, const Scene& scene,
                                 const OutputFiles& files, SignalScope& signals, MessageLog& log) {
  RenderOptions options = render_options(arguments);
  require_memory(scene, options);
  const bool file_decides = options.integrator == "file";
  ProgressDisplay display(
      arguments.verbosity == Verbosity::Quiet ? ProgressDisplay::Style::None
                                              : ProgressDisplay::default_style(),
      sample_unit(file_decides ? scene.description().integrator.type : options.integrator), log);
  attach_callbacks(options, arguments, scene, files, display);
  signals.arm();
  return render(scene, options);
}

ExitCode replay_step(const RenderArguments& arguments, const Scene& scene) {
  const auto [seed, chain, step] = *arguments.replay;
  const std::string text = replay(scene, render_options(arguments), seed, chain, step);
  std::fputs(text.c_str(), stdout);
  if (!text.ends_with('\n')) std::fputs("\n", stdout);
  return ExitCode::Done;
}

ExitCode render_to_files(const RenderArguments& arguments, const Scene& scene,
                         const OutputFiles& files, SignalScope& signals, MessageLog& log) {
  RenderResult result = render_with_display(arguments, scene, files, signals, log);
  for (const std::string& note : result.notes) log_info(note);
  warn_of(result);
  const RenderRecord record{arguments, scene, result, log.warnings(), files, exit_code_of(result)};
  describe_picture(result.image, record);
  write_pictures(result.image, files, arguments.exposure);
  write_text_file(files.json, report_json(record));
  if (arguments.verbosity != Verbosity::Quiet) std::fputs(report_text(record).c_str(), stdout);
  return record.exit_code;
}

}  // namespace

ExitCode run_render(const RenderArguments& arguments) {
  const ThreadLimit limit(arguments.integrator.threads);
  if (arguments.verbosity == Verbosity::Quiet) set_printed_level(LogLevel::Error);
  if (arguments.verbosity == Verbosity::Verbose) set_log_level(LogLevel::Debug);
  MessageLog log(print_message);
  SignalScope signals;
  // What cannot be written is told before hours of work, not after.
  const std::optional<OutputFiles> files =
      arguments.replay ? std::nullopt : std::optional(output_files(arguments));
  const auto scene = load_scene(arguments.scene);
  require_no_warnings(arguments.scene, log);
  return files ? render_to_files(arguments, *scene, *files, signals, log)
               : replay_step(arguments, *scene);
}

}  // namespace fogbow::cli
