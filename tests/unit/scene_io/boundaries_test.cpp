// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene file says of the boundaries of media beyond their shape: priority and repair.
#include "core/geometry/mesh_check.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

const std::string kFog = R"(<medium name="interior" type="homogeneous"/>)";
const std::string kGlass = R"(<bsdf type="dielectric"/>)";

std::string sphere(const std::string& content) {
  return "<shape type=\"sphere\">" + content + "</shape>";
}
std::string priority(const std::string& value) {
  return "<integer name=\"priority\" value=\"" + value + "\"/>";
}

TEST(Priority, BelongsToWhatBoundsAVolume) {
  SceneFolder folder;
  const auto scene = folder.load(sphere(kFog + priority("3")) + sphere(kGlass + priority("-2")) +
                                 sphere(kFog) + sphere(kGlass));
  EXPECT_TRUE(folder.warnings.empty());
  ASSERT_EQ(scene.surfaces.size(), 4u);
  const int expected[] = {3, -2, 0, 0};
  for (int i = 0; i < 4; ++i) EXPECT_EQ(scene.surfaces[i].priority, expected[i]);
}

TEST(Priority, OfWhatBoundsNothingHasNoEffectAndIsWarnedOf) {
  SceneFolder folder;
  const auto scene = folder.load(sphere(priority("3")));
  EXPECT_EQ(scene.surfaces.at(0).priority, 0);
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("priority"), std::string::npos);
  EXPECT_NE(folder.warnings[0].find("scene.xml:2:"), std::string::npos);
}

TEST(Priority, MustBeASmallInteger) {
  SceneFolder folder;
  EXPECT_NE(folder.error(sphere(kFog + priority("1000001"))).find("-1000000 and 1000000"),
            std::string::npos);
  EXPECT_EQ(folder.where.line, 2);
  EXPECT_NE(folder.error(sphere(kFog + priority("1.5"))).find("1.5"), std::string::npos);
}

/// A tetrahedron whose faces have vertices of their own, a thousandth of an edge apart.
std::string cracked_tetrahedron() {
  const int corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  std::string obj;
  for (int f = 0; f < 4; ++f)
    for (const int v : faces[f]) {
      obj += "v";
      for (const int x : corners[v]) obj += " " + std::to_string(x + 0.001 * (f % 2));
      obj += "\n";
    }
  for (int f = 0; f < 4; ++f) {
    obj += "f";
    for (int i = 1; i <= 3; ++i) obj += " " + std::to_string(3 * f + i);
    obj += "\n";
  }
  return obj;
}

class Repair : public ::testing::Test {
 protected:
  Repair() {
    folder_.write("cracked.obj", cracked_tetrahedron());
    folder_.options.on_repair = [this](const std::string& text) { told_.push_back(text); };
  }
  static std::string shape(const std::string& content) {
    return "<shape type=\"obj\" id=\"tent\"><string name=\"filename\" value=\"cracked.obj\"/>"
           "<boolean name=\"face_normals\" value=\"true\"/>" +
           content + "</shape>";
  }
  static bool closed(const SceneDescription& scene) {
    const Shape* shapes[] = {scene.surfaces.at(0).shape.get()};
    return BoundaryGroup(shapes).closed();
  }

  SceneFolder folder_;
  std::vector<std::string> told_;
};

TEST_F(Repair, ComesOnlyWhenAskedFor) {
  EXPECT_FALSE(closed(folder_.load(shape(kFog))));
  EXPECT_FALSE(closed(folder_.load(shape(kFog + R"(<boolean name="repair" value="false"/>)"))));
  EXPECT_TRUE(told_.empty());
}

TEST_F(Repair, ClosesAndTellsOfIt) {
  const std::string property = R"(<boolean name="repair" value="true"/>)";
  EXPECT_TRUE(closed(folder_.load(shape(kFog + property))));
  EXPECT_TRUE(folder_.warnings.empty());
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_NE(told_[0].find("scene.xml:2:1: shape \"tent\" repaired: "), std::string::npos)
      << told_[0];
  // A shape that asks for it is repaired whatever it is made of.
  EXPECT_TRUE(closed(folder_.load(shape(property))));
}

TEST_F(Repair, OfAllMendsWhatBoundsMediaOrRefracts) {
  folder_.options.repair = true;
  EXPECT_TRUE(closed(folder_.load(shape(kFog))));
  EXPECT_TRUE(closed(folder_.load(shape(kGlass))));
  EXPECT_EQ(told_.size(), 2u);
  EXPECT_FALSE(closed(folder_.load(shape(""))));
  EXPECT_EQ(told_.size(), 2u);
  // Instances are copies, and mended like others.
  const std::string group = "<shape type=\"shapegroup\" id=\"g\">" + shape(kFog) + "</shape>";
  EXPECT_TRUE(closed(folder_.load(group + R"(<shape type="instance"><ref id="g"/></shape>)")));
}

}  // namespace
}  // namespace fogbow
