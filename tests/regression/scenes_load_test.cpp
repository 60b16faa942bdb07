// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

namespace fs = std::filesystem;

/// The project's own scenes hold nothing that has no effect, nor files from elsewhere.
TEST(Scenes, LoadStrictlyAndSandboxed) {
  LoadOptions options;
  options.strict = options.sandbox_paths = true;
  options.read_image = [](const std::string&) {  // formats of pictures are tested elsewhere
    Image picture(4, 3, {"R", "G", "B"});
    std::ranges::fill(picture.pixels, 1.0f);
    return picture;
  };
  int count = 0;
  for (const auto& entry : fs::directory_iterator("scenes")) {
    const fs::path file = entry.path() / "scene.xml";
    if (!fs::exists(file)) continue;
    SCOPED_TRACE(file.string());
    std::vector<std::string> warnings;
    const SceneDescription scene =
        load_mitsuba_xml(file.string(), builtin_media(), options, warnings);
    EXPECT_TRUE(warnings.empty());
    EXPECT_FALSE(scene.surfaces.empty());
    EXPECT_NE(scene.content_hash, 0u);
    ++count;
  }
  EXPECT_GE(count, 12);
}

}  // namespace
}  // namespace fogbow
