// SPDX-License-Identifier: GPL-3.0-or-later
#include <set>

#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

const std::string kMesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

/// A scene with a bit of everything; the arguments stand where variants differ.
std::string scene_text(const std::string& reflectance = "0.5, 0.25, 0.125",
                       const std::string& id = "grey", const std::string& mesh = "m.obj",
                       const std::string& extra = "", const std::string& sensor = "") {
  return "<scene version=\"3.0.0\"><default name=\"depth\" value=\"8\"/>"
         "<integrator type=\"path\"><integer name=\"max_depth\" value=\"$depth\"/></integrator>"
         "<sensor type=\"perspective\"><float name=\"fov\" value=\"40\"/>" +
         sensor +
         "</sensor>"
         "<bsdf type=\"diffuse\" id=\"" +
         id + "\"><rgb name=\"reflectance\" value=\"" + reflectance +
         "\"/></bsdf>"
         "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><point name=\"center\" "
         "value=\"1, 2, 3\"/>"
         "<ref id=\"" +
         id +
         "\"/><medium name=\"interior\" type=\"homogeneous\"/></shape>"
         "<shape type=\"obj\"><string name=\"filename\" value=\"" +
         mesh + "\"/><emitter type=\"area\"/></shape>" + extra + "</scene>";
}

class Hash : public ::testing::Test {
 protected:
  Hash() {
    folder_.write("m.obj", kMesh);
    reference_ = of(scene_text());
  }
  std::uint64_t of(const std::string& text, const std::string& name = "scene.xml") {
    return folder_.load_text(text, name).content_hash;
  }
  SceneFolder folder_;
  std::uint64_t reference_ = 0;
};

TEST_F(Hash, IgnoresWhatDoesNotMatter) {
  EXPECT_EQ(of(scene_text()), reference_);
  EXPECT_EQ(of(scene_text(), "other.xml"), reference_);
  EXPECT_EQ(of(scene_text("0.50 2.5e-1 .125", "gris")), reference_);
  EXPECT_EQ(of("<!-- a comment -->\n" + scene_text()), reference_);
  folder_.write("elsewhere/copy.obj", kMesh);
  EXPECT_EQ(of(scene_text("0.5, 0.25, 0.125", "grey", "elsewhere/copy.obj")), reference_);
  EXPECT_EQ(
      of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "<bsdf type=\"null\" id=\"unused\"/>")),
      reference_);
  std::string reordered = scene_text();
  const std::string radius = "<float name=\"radius\" value=\"2\"/>",
                    center = "<point name=\"center\" value=\"1, 2, 3\"/>";
  reordered.replace(reordered.find(radius + center), (radius + center).size(), center + radius);
  EXPECT_EQ(of(reordered), reference_);
  // The film's defaults, spelled out.
  EXPECT_EQ(
      of(scene_text(
          "0.5, 0.25, 0.125", "grey", "m.obj", "",
          R"(<film type="hdrfilm"><integer name="width" value="768"/><rfilter type="gaussian"/></film>)")),
      reference_);
}

TEST_F(Hash, SeesWhatMatters) {
  std::set<std::uint64_t> hashes{reference_};
  hashes.insert(of(scene_text("0.5, 0.25, 0.25")));
  hashes.insert(of(scene_text("0.25, 0.5, 0.125")));
  hashes.insert(of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "<shape type=\"cube\"/>")));
  hashes.insert(
      of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "<emitter type=\"constant\"/>")));
  hashes.insert(
      of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "",
                    R"(<film type="hdrfilm"><integer name="width" value="767"/></film>)")));
  hashes.insert(of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "",
                              R"(<film type="hdrfilm"><rfilter type="box"/></film>)")));
  hashes.insert(of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "",
                              R"(<float name="far_clip" value="100"/>)")));
  hashes.insert(
      of(scene_text("0.5, 0.25, 0.125", "grey", "m.obj", "", R"(<medium type="homogeneous"/>)")));
  std::string text = scene_text();
  text.replace(text.find("\"interior\""), 10, "\"exterior\"");
  hashes.insert(of(text));
  folder_.options.definitions = {{"depth", "9"}};
  hashes.insert(of(scene_text()));
  folder_.options.definitions.clear();
  folder_.options.size = {{10, 10}};
  hashes.insert(of(scene_text()));
  folder_.options.crop = {{0, 0, 5, 5}};
  hashes.insert(of(scene_text()));
  folder_.options = {};
  folder_.write("m.obj", kMesh + "v 1 1 1\n");
  hashes.insert(of(scene_text()));
  EXPECT_EQ(hashes.size(), 14u);
}

}  // namespace
}  // namespace fogbow
