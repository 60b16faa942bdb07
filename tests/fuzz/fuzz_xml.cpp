// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "core/scene_io/load.h"
#include "core/util/log.h"
#include "media/registry.h"
#include "tests/fuzz/targets.h"

namespace {

/// Holds the scene, and files that it may name.
const std::filesystem::path& folder() {
  static const std::filesystem::path path = [] {
    fogbow::set_log_sink([](fogbow::LogLevel, std::string_view) {});
    std::string pattern = (std::filesystem::temp_directory_path() / "fogbow-fuzz-XXXXXX").string();
    FOGBOW_CHECK(mkdtemp(pattern.data()));
    const std::filesystem::path made = pattern;
    std::ofstream(made / "a.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(made / "a.xml") << "<scene version='3.0.0'><default name='x' value='1'/></scene>";
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(folder(), ignored);
    });
    return made;
  }();
  return path;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogbow;
  const std::string scene = (folder() / "scene.xml").string();
  std::ofstream(scene, std::ios::binary) << testing::text_of(data, size);
  LoadOptions options;
  options.sandbox_paths = true;
  std::vector<std::string> warnings;
  testing::read_or_refuse([&] {
    const SceneDescription read = load_mitsuba_xml(scene, builtin_media(), options, warnings);
    FOGBOW_CHECK(read.sensor != nullptr);
    for (const Surface& s : read.surfaces) FOGBOW_CHECK(s.shape && s.bsdf);
  });
  return 0;
}
