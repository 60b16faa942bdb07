// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/image_io.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

RGB albedo(SceneFolder& folder, const std::string& file, const std::string& more = "") {
  folder.options.read_image = read_image;
  const auto scene = folder.load(
      "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" "
      "name=\"reflectance\"><string name=\"filename\" value=\"" +
      file + "\"/>" + more + "</texture></bsdf></shape>");
  SurfacePoint x;
  x.uv = {0.25, 0.25};
  return scene.surfaces.at(0).bsdf->albedo(x);
}

/// What is written as sRGB comes back linear, and EXR as it is.
TEST(TextureFiles, AreReadWithTheirColorSpace) {
  SceneFolder folder;
  Image image(2, 2, {"R", "G", "B"});
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = 0.05f + 0.07f * static_cast<float>(i);
  write_png(folder.path("a.png").string(), image);
  write_exr(folder.path("a.exr").string(), image);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(albedo(folder, "a.png")[c], image.at(0, 0, c), 0.004);
    EXPECT_EQ(albedo(folder, "a.exr")[c], image.at(0, 0, c));
    EXPECT_GT(albedo(folder, "a.png", R"(<boolean name="raw" value="true"/>)")[c],
              image.at(0, 0, c) + 0.1);
  }
}

TEST(TextureFiles, BrokenOnesAreErrorsWithAPlace) {
  SceneFolder folder;
  folder.options.read_image = read_image;
  write_exr(folder.path("a.exr").string(), Image(16, 16, {"R", "G", "B"}));
  const auto size = std::filesystem::file_size(folder.path("a.exr"));
  for (std::uintmax_t n = 0; n < size; n += 17) {
    std::filesystem::resize_file(folder.path("a.exr"), size - 1 - n);
    folder.error(R"(<texture type="bitmap"><string name="filename" value="a.exr"/></texture>)");
    EXPECT_EQ(folder.where.line, 2);
    EXPECT_EQ(folder.kind, ErrorKind::InputOutput);
  }
}

}  // namespace
}  // namespace fogbow
