// SPDX-License-Identifier: GPL-3.0-or-later
// The command line: flags into argument structs, failures into exit codes. The only file that knows
// of CLI11.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/parse.h"
#include "apps/fogbow/report.h"

namespace fogbow::cli {

namespace {

/// An option whose text goes through `parse`; what that refuses becomes a usage error that names
/// the flag.
CLI::Option* add_parsed(CLI::App& app, const std::string& flag, const std::string& type,
                        const std::string& help,
                        const std::function<void(const std::string&)>& parse) {
  return app
      .add_option_function<std::string>(
          flag,
          [parse, name = flag.substr(flag.rfind(',') + 1)](const std::string& text) {
            try {
              parse(text);
            } catch (const Error& error) {
              throw CLI::ValidationError(name, error.what());
            }
          },
          help)
      ->type_name(type);
}

/// The same for an option that may be repeated, one value each time.
void add_repeated(CLI::App& app, const std::string& flag, const std::string& type,
                  const std::string& help, const std::function<void(const std::string&)>& parse) {
  add_parsed(app, flag, type, help, parse)
      ->trigger_on_parse()
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

void add_scene_arguments(CLI::App& app, SceneArguments& scene) {
  app.add_option("SCENE", scene.path, "Scene in Mitsuba's XML format")->required();
  add_repeated(app, "-D,--define", "NAME=VALUE", "Value for $NAME in the scene",
               [&scene](const std::string& text) {
                 const auto [name, value] = parse_definition(text);
                 scene.definitions[name] = value;
               });
  add_parsed(app, "--size", "WxH", "Size of the picture in pixels",
             [&scene](const std::string& text) { scene.size = parse_size(text); });
  add_parsed(app, "--crop", "X,Y,W,H", "Part of the picture to render, in pixels",
             [&scene](const std::string& text) { scene.crop = parse_rectangle(text); });
  app.add_flag("--strict", scene.strict, "Treat warnings about the scene as errors");
  app.add_flag("--repair", scene.repair,
               "Close meshes that bound media or refract where they have small faults");
  app.add_flag("--sandbox-paths", scene.sandbox_paths,
               "Refuse files that are not in the scene's folder");
}

void add_threads(CLI::App& app, int& threads) {
  app.add_option("-t,--threads", threads, "Threads; 0: all")
      ->check(CLI::Range(0, 4096))
      ->type_name("N");
}

void add_integrator_arguments(CLI::App& app, IntegratorArguments& integrator) {
  app.add_option(
         "--integrator", integrator.name,
         "path, light, bdpt, pssmlt, mlt; auto: the best there is; file: what the scene asks for")
      ->type_name("NAME")
      ->capture_default_str();
  add_repeated(app, "--set", "integrator.KEY=VALUE", "Overrides a property of the integrator",
               [&integrator](const std::string& text) {
                 integrator.overrides.push_back(parse_override(text));
               });
  add_threads(app, integrator.threads);
}

void add_render_stop(CLI::App& app, RenderArguments& arguments) {
  auto* time =
      add_parsed(app, "--time", "TIME", "Stop after 90s, 2m, 1h30m",
                 [&](const std::string& text) { arguments.seconds = parse_duration(text); });
  auto* spp = add_parsed(
      app, "--spp", "N", "Stop after N mutations or samples a pixel (default 64)",
      [&](const std::string& text) { arguments.samples_per_pixel = parse_number(text, true); });
  time->excludes(spp);
}

void add_render(CLI::App& program, RenderArguments& arguments, std::function<ExitCode()>& run) {
  CLI::App& app = *program.add_subcommand("render", "Render a scene to EXR, PNG and JSON");
  add_scene_arguments(app, arguments.scene);
  app.add_option("-o,--output", arguments.output,
                 "EXR to write, a PNG and a JSON beside it; default: named after the scene, here")
      ->type_name("OUT.exr");
  add_integrator_arguments(app, arguments.integrator);
  add_render_stop(app, arguments);
  add_parsed(app, "--seed", "S", "Seed of all random numbers (default 0)",
             [&](const std::string& text) { arguments.seed = parse_seed(text); });
  app.add_option("--json", arguments.json, "Where the report goes; default: beside the picture")
      ->type_name("FILE");
  add_parsed(app, "--picture-interval", "TIME",
             "Time between writes of the picture so far (default 60s; 0: never)",
             [&](const std::string& text) {
               arguments.picture_interval = text == "0" ? 0 : parse_duration(text);
             });
  add_parsed(app, "--exposure", "STOPS", "Exposure of the PNG (default 0)",
             [&](const std::string& text) { arguments.exposure = parse_number(text, false); });
  add_parsed(app, "--replay", "SEED:CHAIN:STEP", "Print one proposal with all its factors instead",
             [&](const std::string& text) { arguments.replay = parse_replay(text); });
  auto* quiet = app.add_flag_callback(
      "-q,--quiet", [&] { arguments.verbosity = Verbosity::Quiet; }, "Print nothing but errors");
  auto* verbose = app.add_flag_callback(
      "-v,--verbose", [&] { arguments.verbosity = Verbosity::Verbose; }, "Print more");
  quiet->excludes(verbose);
  app.callback([&] { run = [&] { return run_render(arguments); }; });
}

void add_compare(CLI::App& program, CompareArguments& arguments, std::function<ExitCode()>& run) {
  CLI::App& app = *program.add_subcommand("compare", "Compare two pictures");
  app.add_option("A", arguments.a, "Picture")->required();
  app.add_option("B", arguments.b, "Reference")->required();
  app.add_option("--diff", arguments.difference, "EXR of A - B to write")->type_name("OUT.exr");
  app.add_option("--tile", arguments.tile, "Tile size in pixels")
      ->check(CLI::Range(1, 1 << 20))
      ->type_name("N")
      ->capture_default_str();
  add_repeated(
      app, "--exclude", "X,Y,W,H", "Pixels to leave out, from the pictures' top left",
      [&](const std::string& text) { arguments.exclude.push_back(parse_rectangle(text)); });
  app.add_option("--error-a", arguments.error_a,
                 "Standard errors of A; default: its Error.* channels")
      ->type_name("FILE");
  app.add_option("--error-b", arguments.error_b,
                 "Standard errors of B; default: its Error.* channels")
      ->type_name("FILE");
  app.add_option("--json", arguments.json, "Report to write")->type_name("FILE");
  app.callback([&] { run = [&] { return run_compare(arguments); }; });
}

void add_explain(CLI::App& program, ExplainArguments& arguments, std::function<ExitCode()>& run) {
  CLI::App& app =
      *program.add_subcommand("explain", "Say what makes a scene hard, and what to do about it");
  add_scene_arguments(app, arguments.scene);
  app.add_option("--samples", arguments.samples, "Samples of BDPT to look at")
      ->check(CLI::Range(std::uint64_t{8}, std::uint64_t{1} << 40))
      ->type_name("N")
      ->capture_default_str();
  add_parsed(app, "--seed", "S", "Seed of all random numbers (default 0)",
             [&](const std::string& text) { arguments.seed = parse_seed(text); });
  add_threads(app, arguments.threads);
  app.callback([&] { run = [&] { return run_explain(arguments); }; });
}

void add_fit_phase(CLI::App& program, FitPhaseArguments& arguments,
                   std::function<ExitCode()>& run) {
  CLI::App& app = *program.add_subcommand(
      "fit-phase", "Fit droplets' scattering, or a table, by Henyey-Greenstein and Draine");
  const auto number = [&app](const std::string& flag, const std::string& type,
                             const std::string& help, std::optional<double>& value) {
    return add_parsed(app, flag, type, help,
                      [&value](const std::string& text) { value = parse_number(text, false); });
  };
  auto* table = app.add_option("--table", arguments.table,
                               "File to fit instead: lines of an angle in degrees and a value")
                    ->type_name("FILE");
  number("--radius", "UM", "Median radius in micrometres (default 10)", arguments.radius)
      ->excludes(table);
  number("--spread", "S", "Standard deviation of ln radius (default 0.2)", arguments.spread)
      ->excludes(table);
  number("--index", "N", "Index of refraction (default: water's)", arguments.index)
      ->excludes(table);
  number("--k", "K", "Its imaginary part (default 0)", arguments.k)->excludes(table);
  add_parsed(app, "--wavelengths", "R,G,B", "In nanometres (default 611,549,464)",
             [&arguments](const std::string& text) { arguments.wavelengths = parse_triple(text); })
      ->excludes(table);
  app.add_flag("--xml", arguments.xml, "Print nothing but the phase function for a scene");
  app.callback([&] { run = [&] { return run_fit_phase(arguments); }; });
}

int fail(ErrorKind kind, const std::string& message) {
  std::fflush(stdout);
  print_message(LogLevel::Error, message);
  return static_cast<int>(kind);
}

int run_program(int argc, char** argv) {
  CLI::App app("Fogbow: Metropolis light transport for surfaces and participating media", "fogbow");
  app.require_subcommand(0, 1);
  app.set_version_flag("--version", program_version());
  app.footer(
      "Exit codes: 0 done, 2 usage, 3 scene, 4 input or output, 5 no light found, 6 numerical,\n"
      "7 groups of chains disagree, 33 memory, 75 interrupted with the picture so far written");
  std::function<ExitCode()> run;
  RenderArguments render;
  InfoArguments info;
  SceneArguments check;
  ExplainArguments explain;
  CompareArguments compare;
  FitPhaseArguments fit_phase;
  render.command.assign(argv, argv + argc);
  add_render(app, render, run);
  CLI::App& info_app =
      *app.add_subcommand("info", "Say what is in a scene and what rendering it takes");
  add_scene_arguments(info_app, info.scene);
  add_integrator_arguments(info_app, info.integrator);
  info_app.callback([&] { run = [&] { return run_info(info); }; });
  CLI::App& check_app = *app.add_subcommand("check", "Load a scene and print every warning");
  add_scene_arguments(check_app, check);
  check_app.callback([&] { run = [&] { return run_check(check); }; });
  add_explain(app, explain, run);
  add_compare(app, compare, run);
  add_fit_phase(app, fit_phase, run);

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? static_cast<int>(ExitCode::Done)
                                : static_cast<int>(ExitCode::Usage);
  }
  if (!run) {
    std::fputs(app.help().c_str(), stderr);
    return static_cast<int>(ExitCode::Usage);
  }
  const ExitCode code = run();
  if (std::fflush(stdout) != 0)
    return fail(ErrorKind::InputOutput, "standard output cannot be written");
  return static_cast<int>(code);
}

int guarded_main(int argc, char** argv) {
  try {
    return run_program(argc, argv);
  } catch (const Error& error) {
    return fail(error.kind(), error.what());
  } catch (const std::bad_alloc&) {
    return fail(ErrorKind::Memory, "out of memory");
  } catch (const std::length_error& error) {
    return fail(ErrorKind::Memory, std::string("out of memory: ") + error.what());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail(ErrorKind::InputOutput, error.what());
  }
  // Anything else is a fault of the program, and ends it as a broken CHECK does.
}

}  // namespace

}  // namespace fogbow::cli

int main(int argc, char** argv) { return fogbow::cli::guarded_main(argc, argv); }
