// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

double radius(const SceneDescription& scene, std::size_t i = 0) {
  return scene.surfaces.at(i).shape->bounds().hi.x;
}

TEST(Substitution, ReplacesDefaultsInOrder) {
  SceneFolder folder;
  EXPECT_EQ(radius(folder.load(R"(<default name="r" value="2"/>
      <shape type="sphere"><float name="radius" value="$r"/></shape>)")),
            2);
  // Mitsuba 3.9.1: the first default of a name counts, values may hold names themselves, the
  // longest name that fits is meant.
  EXPECT_EQ(radius(folder.load(R"(<default name="y" value="3"/><default name="y" value="5"/>
      <shape type="sphere"><float name="radius" value="$y"/></shape>)")),
            3);
  EXPECT_EQ(radius(folder.load(R"(<default name="x" value="2"/><default name="y" value="1$x"/>
      <shape type="sphere"><float name="radius" value="$y"/></shape>)")),
            12);
  EXPECT_EQ(radius(folder.load(R"(<default name="x" value="2"/><default name="xy" value="3"/>
      <shape type="sphere"><float name="radius" value="$xy"/></shape>)")),
            3);
  EXPECT_EQ(radius(folder.load(R"(<default name="x" value="2"/>
      <shape type="sphere"><float name="radius" value="$x5"/></shape>)")),
            25);
  EXPECT_EQ(radius(folder.load(R"(<default name="x" value="sphere"/><shape type="$x"/>)")), 1);
  EXPECT_TRUE(folder.warnings.empty());
}

TEST(Substitution, DefinitionsWinAndUnusedOnesAreReported) {
  SceneFolder folder;
  folder.options.definitions = {{"r", "7"}, {"spp", "16"}};
  EXPECT_EQ(radius(folder.load(R"(<default name="r" value="2"/>
      <shape type="sphere"><float name="radius" value="$r"/></shape>)")),
            7);
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("definition of \"spp\" has no effect"), std::string::npos);
  folder.options.strict = true;
  EXPECT_THROW(folder.load_file("scene.xml"), Error);
}

TEST(Substitution, UndefinedNamesAreErrors) {
  SceneFolder folder;
  EXPECT_EQ(folder.error(R"(<default name="radius" value="2"/><shape type="sphere">
  <float name="radius" value="$radios"/></shape>)"),
            "scene.xml:3:24: $\"radios\" is not defined by a <default> before it, nor by -D (did "
            "you mean \"radius\"?)");
  EXPECT_NE(
      folder.error(R"(<shape type="$x"/><default name="x" value="sphere"/>)").find(":2:8: $\"x\""),
      std::string::npos);
  EXPECT_NE(folder.error(R"(<string name="a" value="5$"/>)").find("$\"\" is not defined"),
            std::string::npos);
}

TEST(Include, SplicesScenesAndObjects) {
  SceneFolder folder;
  folder.write("parts/a.xml", R"(<scene version="3.0.0"><default name="r" value="3"/>
    <include filename="b.xml"/><shape type="sphere"><float name="radius" value="$r"/></shape></scene>)");
  folder.write("parts/b.xml", R"(<shape type="sphere"><float name="radius" value="5"/></shape>)");
  const auto scene =
      folder.load(R"(<include filename="parts/a.xml"/><include filename="parts/b.xml"/>
    <shape type="sphere"><float name="radius" value="1$r"/></shape>)");
  ASSERT_EQ(scene.surfaces.size(), 4u);
  EXPECT_EQ(radius(scene, 0), 5);
  EXPECT_EQ(radius(scene, 1), 3);
  EXPECT_EQ(radius(scene, 2), 5);
  EXPECT_EQ(radius(scene, 3), 13);
  EXPECT_EQ(scene.surfaces[1].where.file, folder.path("parts/a.xml").string());
  EXPECT_EQ(scene.surfaces[1].where.line, 2);
  EXPECT_EQ(scene.surfaces[1].where.column, 32);
}

TEST(Path, AddsFoldersToLookInto) {
  SceneFolder folder;
  folder.write("far/away/ball.xml", R"(<shape type="sphere"/>)");
  const std::string body = R"(<path value="far/away"/><include filename="ball.xml"/>)";
  EXPECT_EQ(folder.load(body).surfaces.size(), 1u);
  EXPECT_EQ(folder.error(R"(<include filename="ball.xml"/>)")
                .find("scene.xml:2:10: file not found: \"ball.xml\""),
            0u);
  EXPECT_EQ(folder.kind, ErrorKind::InputOutput);
  EXPECT_EQ(folder.error(R"(<path value="nowhere"/>)").find("scene.xml:2:7: there is no folder"),
            0u);
}

/// As Mitsuba takes it: shared parts name folders as the scenes that include them would.
TEST(Path, OfAnIncludedFileMayBeTheScenes) {
  SceneFolder folder;
  folder.write("far/away/ball.xml", R"(<shape type="sphere"/>)");
  folder.write("parts/shared.xml",
               SceneFolder::wrap(R"(<path value="far/away"/><include filename="ball.xml"/>)"));
  EXPECT_EQ(folder.load(R"(<include filename="parts/shared.xml"/>)").surfaces.size(), 1u);
  folder.write("parts/shared.xml", SceneFolder::wrap(R"(<path value="nowhere"/>)"));
  EXPECT_NE(folder.error(R"(<include filename="parts/shared.xml"/>)").find("there is no folder"),
            std::string::npos);
}

TEST(Sandbox, KeepsFilesInsideTheScenesFolder) {
  SceneFolder folder;
  folder.write("ball.xml", R"(<shape type="sphere"/>)");
  folder.write("inner/ball.xml", R"(<shape type="sphere"/>)");
  const auto body = [](const std::string& name) {
    return SceneFolder::wrap("<include filename=\"" + name + "\"/>");
  };
  folder.options.sandbox_paths = true;
  EXPECT_NO_THROW(folder.load_text(body("ball.xml"), "inner/scene.xml"));
  EXPECT_NO_THROW(folder.load_text(body("../inner/ball.xml"), "inner/scene.xml"));
  EXPECT_NO_THROW(
      folder.load_text(body(folder.path("inner/ball.xml").string()), "inner/scene.xml"));
  std::filesystem::create_symlink("../ball.xml", folder.path("inner/link.xml"));
  for (const std::string& name : {std::string("../ball.xml"), std::string("link.xml"),
                                  folder.path("ball.xml").string(), std::string("/etc/passwd")}) {
    folder.write("inner/scene.xml", body(name));
    EXPECT_NE(folder.error_of_file("inner/scene.xml").find("outside the scene's folder"),
              std::string::npos)
        << name;
    EXPECT_EQ(folder.where.line, 2);
  }
  folder.write("inner/scene.xml", SceneFolder::wrap(R"(<path value=".."/>)"));
  EXPECT_NE(folder.error_of_file("inner/scene.xml").find("outside"), std::string::npos);
  folder.options.sandbox_paths = false;
  EXPECT_NO_THROW(folder.load_text(body("../ball.xml"), "inner/scene.xml"));
}

TEST(References, MayPointForwardInwardAndThroughAliases) {
  SceneFolder folder;
  const auto scene = folder.load(R"(
    <shape type="sphere"><ref id="later"/></shape>
    <shape type="sphere"><bsdf type="null" id="inner"/></shape>
    <shape type="sphere"><ref id="inner"/></shape>
    <shape type="sphere"><ref id="other"/></shape>
    <bsdf type="conductor" id="later"/>
    <alias id="later" as="other"/>)");
  EXPECT_STREQ(scene.surfaces[0].bsdf->name(), "conductor");
  EXPECT_EQ(scene.surfaces[1].bsdf, scene.surfaces[2].bsdf);
  EXPECT_EQ(scene.surfaces[0].bsdf, scene.surfaces[3].bsdf);
  EXPECT_TRUE(folder.warnings.empty());
}

TEST(References, FailClearly) {
  SceneFolder folder;
  EXPECT_EQ(folder.error("<shape type=\"sphere\"><ref id=\"q\"/></shape>"),
            "scene.xml:2:27: reference to \"q\", but no object has that id");
  EXPECT_EQ(folder.error("<bsdf type=\"null\" id=\"a\"/>\n <bsdf type=\"null\" id=\"a\"/>"),
            "scene.xml:3:20: the id \"a\" is taken (first at scene.xml:2:1)");
  EXPECT_NE(folder.error("<alias id=\"a\" as=\"b\"/>").find("2:1: alias of an unknown id \"a\""),
            std::string::npos);
  EXPECT_NE(folder.error("<bsdf type=\"null\" id=\"a\"/><alias id=\"a\" as=\"a\"/>").find("taken"),
            std::string::npos);
  EXPECT_NE(folder
                .error(R"(<bsdf type="twosided" id="a"><ref id="b"/></bsdf>
<bsdf type="twosided" id="b"><ref id="a"/></bsdf>)")
                .find("contains itself"),
            std::string::npos);
}

TEST(Xml, ToleratesLatin1AndByteOrderMark) {
  SceneFolder folder;
  const std::string latin1 =
      SceneFolder::wrap("<!-- Universit\xe4t --><shape type=\"sphere\" id=\"k\xfcgel\"/>");
  EXPECT_EQ(folder.load_text(latin1).surfaces[0].id, "k\xfcgel");
  EXPECT_NO_THROW(folder.load_text("\xef\xbb\xbf" + latin1));
  EXPECT_NO_THROW(folder.load_text("<?xml version=\"1.0\" encoding=\"iso-8859-1\"?>\r\n" + latin1));
}

}  // namespace
}  // namespace fogbow
