// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

namespace fs = std::filesystem;

Image white(const std::string&) {  // formats of pictures are tested elsewhere
  Image picture(4, 3, {"R", "G", "B"});
  std::ranges::fill(picture.pixels, 1.0f);
  return picture;
}

/// The project's own scenes hold nothing that has no effect, nor files from elsewhere.
TEST(Scenes, LoadStrictlyAndSandboxed) {
  LoadOptions options;
  options.strict = options.sandbox_paths = true;
  options.read_image = white;
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
  EXPECT_GE(count, 18);
}

/// One file for each plugin, with every property that the documentation of Mitsuba 3 names; those
/// that end in -old as Mitsuba 0.6 wrote it.
TEST(Plugins, LoadStrictly) {
  const fs::path folder = "tests/regression/plugins";
  LoadOptions options;
  options.strict = options.sandbox_paths = true;
  options.read_image = white;
  set_log_sink([](LogLevel, std::string_view) {});  // upgrades are told
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".xml") continue;
    std::vector<std::string> warnings;
    try {
      load_mitsuba_xml(entry.path().string(), builtin_media(), options, warnings);
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
    for (const std::string& warning : warnings) ADD_FAILURE() << entry.path() << ": " << warning;
  }
  set_log_sink({});
  for (const char* name : {"shape-obj",
                           "shape-ply",
                           "shape-serialized",
                           "shape-rectangle",
                           "shape-cube",
                           "shape-sphere",
                           "shape-disk",
                           "shape-cylinder",
                           "shape-shapegroup",
                           "shape-instance",
                           "bsdf-diffuse",
                           "bsdf-twosided",
                           "bsdf-dielectric",
                           "bsdf-roughdielectric",
                           "bsdf-thindielectric",
                           "bsdf-conductor",
                           "bsdf-roughconductor",
                           "bsdf-plastic",
                           "bsdf-roughplastic",
                           "bsdf-mask",
                           "bsdf-null",
                           "bsdf-bumpmap",
                           "bsdf-normalmap",
                           "bsdf-blendbsdf",
                           "bsdf-principled",
                           "bsdf-phong",
                           "bsdf-roughdiffuse",
                           "emitter-area",
                           "emitter-envmap",
                           "emitter-constant",
                           "emitter-point",
                           "emitter-spot",
                           "emitter-directional",
                           "emitter-sunsky",
                           "emitter-sky-old",
                           "emitter-sun-old",
                           "emitter-projector",
                           "sensor-perspective",
                           "sensor-thinlens",
                           "sensor-orthographic",
                           "film-hdrfilm",
                           "film-ldrfilm-old",
                           "rfilter-box",
                           "rfilter-tent",
                           "rfilter-gaussian",
                           "medium-homogeneous",
                           "medium-heterogeneous",
                           "phase-isotropic",
                           "phase-hg",
                           "phase-rayleigh",
                           "phase-tabphase",
                           "phase-blendphase",
                           "volume-grid",
                           "volume-gridvolume",
                           "volume-const",
                           "volume-constvolume",
                           "texture-bitmap",
                           "texture-checkerboard",
                           "texture-mesh_attribute",
                           "texture-rawconstant",
                           "tags"})
    EXPECT_TRUE(fs::exists(folder / (std::string(name) + ".xml"))) << name;
}

}  // namespace
}  // namespace fogbow
