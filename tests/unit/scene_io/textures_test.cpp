// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/image.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

/// Two grey pixels, or as many as the name says, whatever the file holds.
Image read_fake(const std::string& path) {
  if (path.find("broken") != std::string::npos)
    throw Error(ErrorKind::InputOutput, path + ": no picture");
  Image image(2, 1, {"R", "G", "B"});
  image.integers = true;
  image.pixels = {0.25f, 0.25f, 0.25f, 0.75f, 0.75f, 0.75f};
  if (path.find("bright") != std::string::npos) image.pixels[0] = 2;
  return image;
}

class TextureTest : public ::testing::Test {
 protected:
  TextureTest() {
    folder_.options.read_image = read_fake;
    for (const char* name : {"a.png", "broken.png", "bright.exr"}) folder_.write(name, name);
  }
  /// Reflectance of <bsdf type="diffuse"> with this in it.
  RGB reflectance(const std::string& body, const Vec2& uv, const std::string& before = "") {
    const auto scene = folder_.load(before + "<shape type=\"sphere\"><bsdf type=\"diffuse\">" +
                                    body + "</bsdf></shape>");
    SurfacePoint x;
    x.uv = uv;
    return scene.surfaces.at(0).bsdf->albedo(x);
  }
  SceneFolder folder_;
};

const char* kFile = R"(<string name="filename" value="a.png"/>)";

std::string bitmap(const std::string& more = "", const std::string& name = "reflectance") {
  return "<texture type=\"bitmap\" name=\"" + name + "\">" + kFile + more + "</texture>";
}

TEST_F(TextureTest, BitmapDefaults) {
  const double linear = std::pow((0.75 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(reflectance(bitmap(), {0.75, 0.5}).x, linear, 1e-6);
  const double dark = std::pow((0.25 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(reflectance(bitmap(), {1.5, 3}).x, (linear + dark) / 2, 1e-6) << "bilinear, repeat";
  EXPECT_TRUE(folder_.warnings.empty());
}

TEST_F(TextureTest, BitmapOptions) {
  const std::string raw = R"(<boolean name="raw" value="true"/>)";
  EXPECT_EQ(reflectance(bitmap(raw), {0.75, 0.5}), RGB(0.75));
  const std::string nearest = raw + R"(<string name="filter_type" value="nearest"/>)";
  EXPECT_EQ(reflectance(bitmap(nearest), {0.51, 0.5}), RGB(0.75));
  EXPECT_EQ(reflectance(bitmap(nearest), {1.1, 0.5}), RGB(0.25));
  const std::string clamp = nearest + R"(<string name="wrap_mode" value="clamp"/>)";
  EXPECT_EQ(reflectance(bitmap(clamp), {1.1, 0.5}), RGB(0.75));
  const std::string mirror = nearest + R"(<string name="wrap_mode" value="mirror"/>)";
  EXPECT_EQ(reflectance(bitmap(mirror), {1.1, 0.5}), RGB(0.75));
  EXPECT_EQ(reflectance(bitmap(mirror), {1.6, 0.5}), RGB(0.25));
  const std::string moved = nearest + R"(<transform name="to_uv"><translate x="0.5"/></transform>)";
  EXPECT_EQ(reflectance(bitmap(moved), {0.1, 0.5}), RGB(0.75));
  const std::string dense = nearest + R"(<transform name="to_uv"><scale x="2"/></transform>)";
  EXPECT_EQ(reflectance(bitmap(dense), {0.3, 0.5}), RGB(0.75));
  EXPECT_EQ(reflectance(bitmap(dense), {0.6, 0.5}), RGB(0.25));
  EXPECT_TRUE(folder_.warnings.empty());
}

TEST_F(TextureTest, ReferencesAndNesting) {
  const std::string shared =
      R"(<texture type="checkerboard" id="board"><texture type="bitmap" name="color1">)" +
      std::string(kFile) + R"(<boolean name="raw" value="true"/></texture></texture>)";
  const std::string ref = R"(<ref id="board" name="reflectance"/>)";
  EXPECT_EQ(reflectance(ref, {0.75, 0.75}, shared), RGB(0.4)) << "default of color0";
  EXPECT_EQ(reflectance(ref, {0.75, 0.25}, shared), RGB(0.75));
  EXPECT_EQ(reflectance(R"(<texture type="checkerboard" name="reflectance"/>)", {0.75, 0.25}),
            RGB(0.2))
      << "default of color1";
  EXPECT_TRUE(folder_.warnings.empty());
  reflectance(bitmap("", "reflectence"), {0, 0});
  ASSERT_EQ(folder_.warnings.size(), 1u);
  EXPECT_NE(folder_.warnings[0].find("the texture nested in bsdf \"diffuse\" has no effect"),
            std::string::npos);
}

TEST_F(TextureTest, EveryTexturedProperty) {
  const std::pair<const char*, std::vector<const char*>> plugins[] = {
      {"diffuse", {"reflectance"}},
      {"dielectric", {"specular_reflectance", "specular_transmittance"}},
      {"conductor", {"specular_reflectance", "eta", "k"}},
      {"roughconductor", {"specular_reflectance", "eta", "k", "alpha"}},
      {"roughconductor", {"alpha_u", "alpha_v"}},
      {"roughdielectric", {"specular_reflectance", "specular_transmittance", "alpha"}},
      {"thindielectric", {"specular_reflectance", "specular_transmittance"}},
      {"plastic", {"diffuse_reflectance", "specular_reflectance"}},
      {"roughplastic", {"diffuse_reflectance", "specular_reflectance"}},
      {"phong", {"diffuse_reflectance", "specular_reflectance", "exponent"}},
      {"roughdiffuse", {"reflectance", "alpha"}},
  };
  for (const auto& [plugin, names] : plugins) {
    std::string body = "<shape type=\"sphere\"><bsdf type=\"" + std::string(plugin) + "\">";
    for (const char* name : names) body += bitmap("", name);
    folder_.load(body + "</bsdf></shape>");
    EXPECT_TRUE(folder_.warnings.empty()) << plugin;
  }
}

TEST_F(TextureTest, Errors) {
  const auto in_bsdf = [](const std::string& texture) {
    return "<bsdf type=\"diffuse\">\n" + texture + "</bsdf>";
  };
  const auto of_file = [](const char* name) {
    return "<texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"" +
           std::string(name) + "\"/></texture>";
  };
  const std::pair<std::string, const char*> cases[] = {
      {in_bsdf(R"(<texture type="bitmap" name="reflectance"/>)"),
       "scene.xml:3:1: texture \"bitmap\" needs the string \"filename\""},
      {in_bsdf(R"(<texture type="bitmop" name="reflectance"/>)"),
       "scene.xml:3:1: the texture plugin \"bitmop\" is not supported (did you mean \"bitmap\"?)"},
      {in_bsdf(of_file("absent.png")), "scene.xml:3:43: file not found: \"absent.png\""},
      {in_bsdf(of_file("broken.png")), "scene.xml:3:43: "},
      {in_bsdf(of_file("bright.exr")),
       "scene.xml:3:1: the values of the texture \"reflectance\" must lie between 0 and 1"},
      {in_bsdf(bitmap(R"(<string name="wrap_mode" value="black"/>)")),
       "expected \"repeat\", \"mirror\" or \"clamp\", found \"black\""},
      {in_bsdf(bitmap() + bitmap()), "a second \"reflectance\" texture"},
      {in_bsdf(bitmap() + R"(<rgb name="reflectance" value="0.5"/>)"),
       "is given twice: as a value and as a texture"},
      {R"(<texture type="checkerboard" id="t"><ref name="color0" id="t"/></texture>)",
       "<texture> contains itself by reference"},
  };
  for (const auto& [body, message] : cases)
    EXPECT_NE(folder_.error(body).find(message), std::string::npos)
        << folder_.error(body) << "\nexpected: " << message;
  folder_.options.read_image = nullptr;
  EXPECT_NE(folder_.error(in_bsdf(bitmap())).find("the program gave no reader of images"),
            std::string::npos);
}

TEST_F(TextureTest, HashIsThatOfTheBytes) {
  const auto hash = [&](const char* file) {
    return folder_
        .load(
            "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" "
            "name=\"reflectance\"><string name=\"filename\" value=\"" +
            std::string(file) + "\"/></texture></bsdf></shape>")
        .content_hash;
  };
  folder_.write("b.png", "a.png");
  folder_.write("c.png", "other bytes");
  EXPECT_EQ(hash("a.png"), hash("b.png"));
  EXPECT_NE(hash("a.png"), hash("c.png"));
}

}  // namespace
}  // namespace fogbow
