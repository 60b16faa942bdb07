// SPDX-License-Identifier: GPL-3.0-or-later
// Files as Mitsuba 0.5 and 0.6 wrote them, against what the same scene is in today's names.
#include "core/scene_io/upgrade.h"

#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

TEST(SnakeCase, IsThatOfMitsuba) {
  const std::pair<const char*, const char*> cases[] = {{"toWorld", "to_world"},
                                                       {"intIOR", "int_ior"},
                                                       {"pLarge", "p_large"},
                                                       {"alphaU", "alpha_u"},
                                                       {"to_world", "to_world"},
                                                       {"maxDepth", "max_depth"},
                                                       {"IOR", "IOR"},
                                                       {"fovAxis", "fov_axis"},
                                                       {"cropOffsetX", "crop_offset_x"},
                                                       {"", ""},
                                                       {"flipTexCoords", "flip_tex_coords"}};
  for (const auto& [old, today] : cases) EXPECT_EQ(snake_case(old), today);
}

/// One scene in both spellings; the hash says that they are the same.
const char* kOld = R"(<scene version="0.6.0">
  <default name="myRadius" value="2"/>
  <integrator type="volpath_simple"><integer name="maxDepth" value="7"/></integrator>
  <sensor type="perspective"><float name="fov" value="40"/><string name="fovAxis" value="y"/>
    <float name="nearClip" value="0.1"/><float name="shutterOpen" value="0"/>
    <float name="shutterClose" value="0"/>
    <transform name="toWorld"><lookAt origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sampleCount" value="16"/></sampler>
    <film type="ldrfilm"><integer name="width" value="64"/><integer name="height" value="32"/>
      <integer name="cropOffsetX" value="8"/><integer name="cropWidth" value="16"/>
      <integer name="cropHeight" value="32"/><boolean name="banner" value="false"/>
      <float name="gamma" value="2.2"/><rfilter type="box"/></film></sensor>
  <bsdf type="diffuse" id="gray"><rgb name="diffuseReflectance" value="0.2, 0.3, 0.4"/></bsdf>
  <bsdf type="dielectric" id="glass"><float name="intIOR" value="1.33"/>
    <string name="extIOR" value="air"/></bsdf>
  <medium type="homogeneous" id="fog"><spectrum name="sigmaS" value="1, 2, 3"/>
    <spectrum name="sigmaA" value="1"/></medium>
  <shape type="sphere"><float name="radius" value="$myRadius"/>
    <boolean name="flipNormals" value="true"/><ref name="interior" id="fog"/></shape>
  <shape type="rectangle"><ref id="gray"/>
    <transform name="toWorld"><rotate x="1" angle="90"/></transform>
    <emitter type="area"><spectrum name="radiance" value="4"/></emitter></shape>
  <shape type="cube"><ref name="exterior" id="fog"/><ref id="glass"/></shape>
  <shape type="sphere"><bsdf type="conductor"><rgb name="eta" value="1"/></bsdf></shape>
  <emitter type="spot"><float name="cutoffAngle" value="40"/><spectrum name="intensity" value="3"/>
    <float name="beamWidth" value="9"/></emitter>
</scene>)";
const char* kNew = R"(<scene version="3.0.0">
  <integrator type="volpath"><integer name="max_depth" value="7"/></integrator>
  <sensor type="perspective"><float name="fov" value="40"/><string name="fov_axis" value="y"/>
    <float name="near_clip" value="0.1"/>
    <transform name="to_world"><lookat origin="0, 1, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
    <film type="hdrfilm"><integer name="width" value="64"/><integer name="height" value="32"/>
      <integer name="crop_offset_x" value="8"/><integer name="crop_width" value="16"/>
      <integer name="crop_height" value="32"/><rfilter type="box"/></film></sensor>
  <bsdf type="diffuse" id="gray"><rgb name="reflectance" value="0.2, 0.3, 0.4"/></bsdf>
  <bsdf type="dielectric" id="glass"><float name="int_ior" value="1.33"/>
    <string name="ext_ior" value="air"/></bsdf>
  <medium type="homogeneous" id="fog"><rgb name="sigma_s" value="1, 2, 3"/>
    <rgb name="sigma_a" value="1"/></medium>
  <shape type="sphere"><float name="radius" value="2"/>
    <boolean name="flip_normals" value="true"/><ref name="interior" id="fog"/>
    <bsdf type="null"/></shape>
  <shape type="rectangle"><ref id="gray"/>
    <transform name="to_world"><rotate x="1" angle="90"/></transform>
    <emitter type="area"><rgb name="radiance" value="4"/></emitter></shape>
  <shape type="cube"><ref name="exterior" id="fog"/><ref id="glass"/></shape>
  <shape type="sphere"><bsdf type="conductor"><rgb name="eta" value="1"/></bsdf></shape>
  <emitter type="spot"><float name="cutoff_angle" value="40"/><rgb name="intensity" value="3"/>
    <float name="beam_width" value="9"/></emitter>
</scene>)";

TEST(Upgrade, MakesTheSameSceneWithoutAWarning) {
  SceneFolder folder;
  const auto old = folder.load_text(kOld);
  EXPECT_TRUE(folder.warnings.empty()) << folder.warnings.front();
  const auto today = folder.load_text(kNew);
  EXPECT_TRUE(folder.warnings.empty()) << folder.warnings.front();
  EXPECT_EQ(old.content_hash, today.content_hash);
  EXPECT_EQ(old.integrator.type, "volpath");
  EXPECT_EQ(old.integrator.properties, today.integrator.properties);
  EXPECT_STREQ(old.surfaces.at(0).bsdf->name(), "null");
  EXPECT_EQ(old.surfaces[0].interior->sigma_t(Vec3(0)), RGB(2, 3, 4));
  EXPECT_LT(length(old.surfaces[0].interior->sigma_s(Vec3(0)) - RGB(1, 2, 3)), 1e-15);
  EXPECT_STREQ(old.surfaces[1].bsdf->name(), "diffuse");
  EXPECT_STREQ(old.surfaces[2].bsdf->name(), "dielectric");
  EXPECT_EQ(old.film.crop_x, 8);
}

/// What a body means in an old file, it means in today's words in a file of today.
void expect_same(SceneFolder& folder, const std::string& old, const std::string& today) {
  const auto file = [](const char* version, const std::string& body) {
    return std::string("<scene version=\"") + version + "\"><sensor type=\"perspective\"/>" + body +
           "</scene>";
  };
  const auto before = folder.load_text(file("0.6.0", old));
  EXPECT_TRUE(folder.warnings.empty()) << folder.warnings.front();
  const auto now = folder.load_text(file("3.0.0", today));
  EXPECT_TRUE(folder.warnings.empty()) << folder.warnings.front();
  EXPECT_EQ(before.content_hash, now.content_hash) << old;
}

TEST(Upgrade, BitmapsThatWereFilteredInOtherWaysOrWereLinear) {
  SceneFolder folder;
  folder.options.read_image = [](const std::string&) {
    Image image(2, 1, {"R", "G", "B"});
    std::ranges::fill(image.pixels, 0.5f);
    return image;
  };
  folder.write("a.png", "bytes");
  const auto bitmap = [](const std::string& properties) {
    return R"(<shape type="sphere"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
      <string name="filename" value="a.png"/>)" +
           properties + "</texture></bsdf></shape>";
  };
  const std::string bilinear = bitmap(R"(<string name="filter_type" value="bilinear"/>)");
  expect_same(folder, bitmap(R"(<string name="filterType" value="trilinear"/>)"), bilinear);
  expect_same(folder, bitmap(R"(<string name="filterType" value="ewa"/>)"), bilinear);
  expect_same(folder, bitmap(R"(<float name="gamma" value="1"/>)"),
              bitmap(R"(<boolean name="raw" value="true"/>)"));
  expect_same(folder, bitmap(R"(<float name="gamma" value="-1"/>)"), bitmap(""));
}

TEST(Upgrade, VoxelsFilledTheBoxOfTheirFile) {
  SceneFolder folder;
  std::string vol("VOL\3", 4);
  const std::int32_t words[] = {1, 1, 1, 1, 1};
  const float rest[] = {-1, -2, -3, 4, 5, 6, 0.5f};  // the box, and one voxel
  vol.append(reinterpret_cast<const char*>(words), sizeof words);
  vol.append(reinterpret_cast<const char*>(rest), sizeof rest);
  folder.write("a.vol", vol);
  const auto smoke = [](const std::string& name, const std::string& properties) {
    return R"(<shape type="cube"><bsdf type="null"/>
      <medium type="heterogeneous" name="interior"><volume type="gridvolume" name=")" +
           name + R"("><string name="filename" value="a.vol"/>)" + properties +
           "</volume></medium></shape>";
  };
  expect_same(folder, smoke("density", ""),
              smoke("sigma_t", R"(<boolean name="use_grid_bbox" value="true"/>)"));
}

TEST(Upgrade, MediaWereOfSkinAndConductorsLayInAir) {
  SceneFolder folder;
  const auto shape = [](const std::string& content) {
    return "<shape type=\"sphere\">" + content + "</shape>";
  };
  const std::string null = R"(<bsdf type="null"/>)";
  expect_same(folder, shape(null + R"(<medium type="homogeneous" name="interior"/>)"),
              shape(null + R"(<medium type="homogeneous" name="interior">
                <rgb name="sigma_s" value="0.74, 0.88, 1.01"/>
                <rgb name="sigma_a" value="0.032, 0.17, 0.48"/></medium>)"));
  const std::string metal = R"(<bsdf type="conductor"><string name="material" value="Au"/>)";
  for (const char* index :
       {R"(<float name="extEta" value="1"/>)", R"(<string name="extEta" value="air"/>)"})
    expect_same(folder, shape(metal + index + "</bsdf>"), shape(metal + "</bsdf>"));
}

TEST(Upgrade, TellsEveryKindOfChangeOnce) {
  SceneFolder folder;
  std::vector<std::string> told;
  set_log_sink([&](LogLevel level, std::string_view message) {
    if (level == LogLevel::Info) told.emplace_back(message);
  });
  folder.load_text(kOld);
  const auto count = [&](const std::string& text) {
    return std::ranges::count_if(
        told, [&](const std::string& m) { return m.find(text) != std::string::npos; });
  };
  for (const char* change :
       {"\"toWorld\" is \"to_world\" now", "<lookAt> is <lookat> now",
        "the film \"ldrfilm\" is \"hdrfilm\" now", "\"gamma\" of a film has no meaning now",
        "a boundary of media without a bsdf has a \"null\" one now",
        "a <spectrum> without wavelengths is <rgb> now"})
    EXPECT_EQ(count(change), 1) << change;
  EXPECT_EQ(count("scene.xml:7:5: of an older version: \"toWorld\""), 1);
}

TEST(Upgrade, LeavesTodaysFilesAlone) {
  SceneFolder folder;
  const auto scene =
      folder.load(R"(<shape type="sphere"><medium type="homogeneous" name="interior"/>
    <transform name="toWorld"/></shape>)");
  EXPECT_STREQ(scene.surfaces.at(0).bsdf->name(), "diffuse");
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("\"toWorld\" of shape \"sphere\" has no effect"),
            std::string::npos);
}

TEST(Upgrade, GoesByTheVersionOfEachFile) {
  SceneFolder folder;
  folder.write("old.xml", R"(<scene version="0.5.0"><shape type="sphere"><transform name="toWorld">
      <scale value="2"/></transform></shape></scene>)");
  folder.write("part.xml", R"(<shape type="sphere"><transform name="toWorld"><scale value="3"/>
      </transform></shape>)");
  const auto radius = [](const Surface& s) { return s.shape->bounds().hi.x; };
  const auto scene = folder.load(R"(<include filename="old.xml"/>)");
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_EQ(radius(scene.surfaces.at(0)), 2);
  folder.load(R"(<include filename="part.xml"/>)");
  EXPECT_EQ(folder.warnings.size(), 1u);
  const auto both = folder.load_text(R"(<scene version="0.6.0"><sensor type="perspective"/>
      <include filename="part.xml"/></scene>)");
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_EQ(radius(both.surfaces.at(0)), 3);
}

TEST(Upgrade, StillWarnsOfWhatNoRuleKnows) {
  SceneFolder folder;
  folder.load_text(R"(<scene version="0.6.0"><sensor type="perspective"/>
    <shape type="sphere"><float name="someThing" value="1"/></shape></scene>)");
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("\"some_thing\" of shape \"sphere\" has no effect"),
            std::string::npos);
}

TEST(Upgrade, ConductorsWereOfCopper) {
  XmlNode scene, bsdf;
  bsdf.tag = "bsdf";
  bsdf.file = scene.file = std::make_shared<const std::string>("a.xml");
  bsdf.attributes = {{"type", "roughconductor"}};
  scene.tag = "scene";
  scene.children = {bsdf};
  upgrade_scene(scene);
  ASSERT_EQ(scene.children[0].children.size(), 1u);
  EXPECT_EQ(*scene.children[0].children[0].attribute("value"), "Cu");
}

TEST(Upgrade, TextureCoordinatesAreScaledByATransform) {
  XmlNode texture, scale;
  texture.tag = "texture";
  texture.file = scale.file = std::make_shared<const std::string>("a.xml");
  texture.attributes = {{"type", "bitmap"}};
  scale.tag = "float";
  scale.attributes = {{"name", "uscale"}, {"value", "4"}};
  texture.children = {scale};
  upgrade_scene(texture);
  ASSERT_EQ(texture.children.size(), 1u);
  const XmlNode& transform = texture.children[0];
  EXPECT_EQ(*transform.attribute("name"), "to_uv");
  ASSERT_EQ(transform.children.size(), 2u);
  EXPECT_EQ(*transform.children[0].attribute("x"), "4");
  EXPECT_EQ(*transform.children[0].attribute("y"), "1");
  EXPECT_EQ(*transform.children[1].attribute("x"), "0");
}

}  // namespace
}  // namespace fogbow
