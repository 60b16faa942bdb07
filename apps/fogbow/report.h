// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "apps/fogbow/commands.h"
#include "mlt/render.h"

namespace fogbow::cli {

struct OutputFiles {
  std::string exr, png, json;
};

/// All that is told of a render once it is over.
struct RenderRecord {
  const RenderArguments& arguments;
  const Scene& scene;
  const RenderResult& result;
  const std::vector<std::string>& warnings;  ///< of the whole run
  const OutputFiles& files;
  ExitCode exit_code;
};

/// For people: b ± σ, path lengths, mutations, speed.
std::string report_text(const RenderRecord& record);
/// For programs: everything.
std::string report_json(const RenderRecord& record);

/// What an EXR file says about itself while the render goes on …
void describe_picture(Image& image, const Scene& scene, const RenderArguments& arguments,
                      const RenderProgress& progress);
/// … and at its end.
void describe_picture(Image& image, const RenderRecord& record);

/// "mutations" or "samples": what an integrator counts.
std::string sample_unit(const std::string& integrator);

/// The content hash as it is written everywhere.
std::string scene_hash(const Scene& scene);

/// "fogbow 0.1.0".
std::string program_version();

}  // namespace fogbow::cli
