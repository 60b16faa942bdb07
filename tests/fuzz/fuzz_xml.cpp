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
    std::ofstream(made / "a.spd") << "400 0.5\n700 1\n";
    std::ofstream(made / "a.exr") << "what picture() answers for";
    std::ofstream vol(made / "a.vol", std::ios::binary);
    const std::int32_t head[] = {1, 1, 1, 1, 1};
    const float rest[] = {0, 0, 0, 1, 1, 1, 0.5f};
    vol.write("VOL\3", 4);
    vol.write(reinterpret_cast<const char*>(head), sizeof head);
    vol.write(reinterpret_cast<const char*>(rest), sizeof rest);
    std::atexit([] {
      std::error_code ignored;
      std::filesystem::remove_all(folder(), ignored);
    });
    return made;
  }();
  return path;
}

fogbow::Image picture(const std::string&) {
  fogbow::Image image(2, 1, {"R", "G", "B"});
  image.at(0, 0, 0) = image.at(1, 0, 2) = 0.5f;
  return image;
}

/// Without Mie's series, which is no reader's and takes a minute under the sanitizers.
fogbow::MediaRegistry quick_media() {
  fogbow::MediaRegistry media = fogbow::builtin_media();
  FOGBOW_CHECK(media.phases.erase("mie") == 1);
  return media;
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogbow;
  const std::string scene = (folder() / "scene.xml").string();
  std::ofstream(scene, std::ios::binary) << testing::text_of(data, size);
  LoadOptions options;
  options.sandbox_paths = true;
  options.read_image = picture;
  static const MediaRegistry media = quick_media();
  std::vector<std::string> warnings;
  testing::read_or_refuse([&] {
    const SceneDescription read = load_mitsuba_xml(scene, media, options, warnings);
    FOGBOW_CHECK(read.sensor != nullptr);
    for (const Surface& s : read.surfaces) FOGBOW_CHECK(s.shape && s.bsdf);
  });
  return 0;
}
