// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/util/error.h"

namespace fogbow::cli {

/// What the program answers to its caller; the values of ErrorKind are exit codes too.
enum class ExitCode {
  Done = 0,
  Usage = static_cast<int>(ErrorKind::Usage),
  Scene = static_cast<int>(ErrorKind::Scene),
  GroupsDisagree = 7,  ///< the picture is written
  Memory = static_cast<int>(ErrorKind::Memory),
  Interrupted = 75,  ///< the picture so far is written
};

enum class Verbosity { Quiet, Normal, Verbose };

/// What every command that reads a scene takes.
struct SceneArguments {
  std::string path;
  std::map<std::string, std::string> definitions;  ///< -D name=value
  std::optional<std::pair<int, int>> size;
  std::optional<std::array<int, 4>> crop;
  bool strict = false;
  bool sandbox_paths = false;
  bool repair = false;
};

/// What decides how a scene is rendered, and how much memory that takes.
struct IntegratorArguments {
  std::string name = "auto";
  std::vector<std::pair<std::string, std::string>> overrides;  ///< --set integrator.KEY=VALUE
  int threads = 0;
};

struct RenderArguments {
  SceneArguments scene;
  IntegratorArguments integrator;
  std::string output;  ///< empty: named after the scene, in the current folder
  std::string json;    ///< empty: beside the picture
  std::optional<double> seconds, samples_per_pixel;
  std::uint64_t seed = 0;
  double picture_interval = 60;
  double exposure = 0;
  std::optional<std::array<std::uint64_t, 3>> replay;  ///< seed, chain, step
  Verbosity verbosity = Verbosity::Normal;
  std::vector<std::string> command;  ///< the command line as typed
};

struct InfoArguments {
  SceneArguments scene;
  IntegratorArguments integrator;
};

struct ExplainArguments {
  SceneArguments scene;
  std::uint64_t samples = 200'000;  ///< of BDPT
  std::uint64_t seed = 0;
  int threads = 0;
};

struct CompareArguments {
  std::string a, b;        ///< b is the reference
  std::string difference;  ///< EXR of a − b; empty: none
  int tile = 16;
  std::string error_a, error_b;  ///< pictures of standard errors; empty: the Error.* channels
  std::vector<std::array<int, 4>> exclude;  ///< x, y, width, height, from the pictures' top left
  std::string json;                         ///< empty: none
};

struct FitPhaseArguments {
  std::optional<double> radius, spread;              ///< of droplets: µm, deviation of ln radius
  std::optional<std::array<double, 3>> wavelengths;  ///< nm
  std::optional<double> index, k;                    ///< complex index of refraction; none: water's
  std::string table;                                 ///< file of angles and values to fit instead
  bool xml = false;  ///< print nothing but the phase functions for a scene
};

// Each throws Error on failure, and std::bad_alloc.
ExitCode run_render(const RenderArguments& arguments);
ExitCode run_info(const InfoArguments& arguments);
ExitCode run_check(const SceneArguments& arguments);
ExitCode run_explain(const ExplainArguments& arguments);
ExitCode run_compare(const CompareArguments& arguments);
ExitCode run_fit_phase(const FitPhaseArguments& arguments);

}  // namespace fogbow::cli
