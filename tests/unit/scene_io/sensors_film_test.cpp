// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

// Numbers: printed by Mitsuba 3.9.1 (scalar_rgb) for the same XML with its 768 × 576 film.

SceneDescription load_sensor(SceneFolder& folder, const std::string& properties,
                             const std::string& type = "perspective") {
  return folder.load_text("<scene version=\"3.0.0\"><sensor type=\"" + type + "\">" + properties +
                          "</sensor></scene>");
}

/// Angle between the directions through the middles of the left and right edges, degrees.
double horizontal_angle(const Sensor& sensor) {
  const Vec3 x = sensor.sample_position(Vec2(0.5));
  const Vec3 left = sensor.sample_direction(x, Vec2(0, 0.5)).w;
  const Vec3 right = sensor.sample_direction(x, Vec2(1, 0.5)).w;
  return std::acos(dot(left, right)) * 180 / kPi;
}

TEST(Perspective, FieldOfViewAlongEveryAxis) {
  SceneFolder folder;
  const std::pair<const char*, double> cases[] = {
      {"", 38.1848},
      {R"(<float name="fov" value="40"/>)", 40},
      {R"(<float name="fov" value="40"/><string name="fov_axis" value="x"/>)", 40},
      {R"(<float name="fov" value="40"/><string name="fov_axis" value="y"/>)", 51.774},
      {R"(<float name="fov" value="40"/><string name="fov_axis" value="diagonal"/>)", 32.4686},
      {R"(<float name="fov" value="40"/><string name="fov_axis" value="smaller"/>)", 51.774},
      {R"(<float name="fov" value="40"/><string name="fov_axis" value="larger"/>)", 40},
      {R"(<string name="focal_length" value="50mm"/>)", 38.1848},
      {R"(<string name="focal_length" value="50"/>)", 38.1848},
  };
  for (const auto& [properties, expected] : cases) {
    const auto scene = load_sensor(folder, properties);
    EXPECT_NEAR(horizontal_angle(*scene.sensor), expected, 6e-5) << properties;
    EXPECT_TRUE(scene.sensor->dirac_position());
    EXPECT_TRUE(folder.warnings.empty());
  }
  const auto tall = load_sensor(folder, R"(<float name="fov" value="40"/>
      <string name="fov_axis" value="larger"/><film type="hdrfilm"><integer name="width" value="300"/>
      <integer name="height" value="400"/></film>)");
  EXPECT_NEAR(horizontal_angle(*tall.sensor), 2 * std::atan(std::tan(kPi / 9) * 0.75) * 180 / kPi,
              1e-9);
}

TEST(Perspective, RefusesWhatIsImpossible) {
  SceneFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {R"(<float name="fov" value="0"/>)", "between 0 and 180"},
      {R"(<float name="fov" value="180"/>)", "between 0 and 180"},
      {R"(<float name="fov" value="40"/><string name="fov_axis" value="z"/>)", "\"diagonal\""},
      {R"(<float name="fov" value="40"/><string name="focal_length" value="50mm"/>)", "either"},
      {R"(<string name="focal_length" value="50cm"/>)", "expected a finite number"},
      {R"(<string name="focal_length" value="-5mm"/>)", "greater than zero"},
      {R"(<float name="near_clip" value="0"/>)", "greater than zero"},
      {R"(<float name="near_clip" value="2"/><float name="far_clip" value="1"/>)", "smaller than"},
      {R"(<transform name="to_world"><scale x="2"/></transform>)", "stretch"},
      {R"(<film type="hdrfilm"><integer name="width" value="0"/></film>)", "no pixels"},
      {R"(<film type="hdrfilm"><integer name="width" value="-5"/></film>)", "between 0 and"},
      {R"(<film type="hdrfilm"><integer name="width" value="99999999999"/></film>)",
       "between 0 and"},
      {R"(<film type="hdrfilm"><integer name="width" value="1000000"/><integer name="height" value="1000000"/></film>)",
       "more than 268435456 pixels"},
      {R"(<film type="hdrfilm"><float name="width" value="10"/></film>)", "of type integer"},
      {R"(<film type="hdrfilm"><integer name="crop_offset_x" value="5"/></film>)",
       "inside the film"},
      {R"(<film type="hdrfilm"><integer name="crop_width" value="0"/></film>)", "empty"},
      {R"(<film type="ldrfilm"/>)", "the film plugin \"ldrfilm\" is not supported"},
      {R"(<film type="hdrfilm"><rfilter type="lanczos"/></film>)",
       "known: \"box\", \"gaussian\" and \"tent\""},
  };
  for (const auto& [properties, message] : cases) {
    folder.write("scene.xml", "<scene version=\"3.0.0\"><sensor type=\"perspective\">" +
                                  std::string(properties) + "</sensor></scene>");
    EXPECT_NE(folder.error_of_file("scene.xml").find(message), std::string::npos)
        << folder.error_of_file("scene.xml");
    EXPECT_EQ(folder.where.line, 1);
    EXPECT_GT(folder.where.column, 1);
  }
}

TEST(Perspective, LooksWhereItIsTold) {
  SceneFolder folder;
  const auto scene = load_sensor(folder, R"(<transform name="to_world">
      <lookat origin="1, 2, 3" target="1, 2, -7" up="0, 1, 0"/></transform>
      <float name="near_clip" value="0.5"/><float name="far_clip" value="20"/>
      <float name="focus_distance" value="7"/>)");
  EXPECT_TRUE(folder.warnings.empty()) << "a pinhole has its focus everywhere";
  const Sensor& sensor = *scene.sensor;
  EXPECT_EQ(sensor.sample_position(Vec2(0.5)), Vec3(1, 2, 3));
  const Vec3 axis = sensor.sample_direction(Vec3(1, 2, 3), Vec2(0.5)).w;
  EXPECT_NEAR(length(axis - Vec3(0, 0, -1)), 0, 1e-12);
  // u to the right, v down.
  EXPECT_GT(sensor.sample_direction(Vec3(1, 2, 3), Vec2(1, 0.5)).w.x, 0.1);
  EXPECT_LT(sensor.sample_direction(Vec3(1, 2, 3), Vec2(0.5, 1)).w.y, -0.1);
  EXPECT_NEAR(sensor.near_distance(axis), 0.5, 1e-12);
  EXPECT_NEAR(sensor.far_distance(axis), 20, 1e-12);
  const auto standard = load_sensor(folder, "");
  EXPECT_NEAR(standard.sensor->near_distance(Vec3(0, 0, 1)), 0.01, 1e-12);
  EXPECT_NEAR(standard.sensor->far_distance(Vec3(0, 0, 1)), 1e4, 1e-8);
}

TEST(Perspective, ShiftsThePrincipalPoint) {
  SceneFolder folder;
  const auto axis_at = [&](const char* properties) {
    return load_sensor(folder, properties).sensor->raster(Vec3(0), Vec3(0, 0, 1)).value();
  };
  EXPECT_NEAR(length(axis_at("") - Vec2(0.5)), 0, 1e-12);
  const Vec2 x = axis_at(R"(<float name="principal_point_offset_x" value="0.1"/>)");
  const Vec2 y = axis_at(R"(<float name="principal_point_offset_y" value="0.2"/>)");
  EXPECT_NEAR(std::abs(x.x - 0.5), 0.1, 1e-12);
  EXPECT_NEAR(x.y, 0.5, 1e-12);
  EXPECT_NEAR(std::abs(y.y - 0.5), 0.2, 1e-12);
}

TEST(Thinlens, NeedsAnApertureAndFocusesFarAway) {
  SceneFolder folder;
  const auto scene = load_sensor(folder, R"(<float name="aperture_radius" value="0.5"/>
      <float name="focus_distance" value="4"/><float name="fov" value="30"/>)",
                                 "thinlens");
  EXPECT_FALSE(scene.sensor->dirac_position());
  const Vec2 raster(0.3, 0.8);
  // Rays of one raster position meet in the plane of focus.
  const auto meet = [&](const Sensor& sensor, const Vec2& lens, double depth) {
    const Vec3 x = sensor.sample_position(lens);
    const Vec3 w = sensor.sample_direction(x, raster).w;
    return x + depth / w.z * w;
  };
  EXPECT_NEAR(
      length(meet(*scene.sensor, Vec2(0.1, 0.2), 4) - meet(*scene.sensor, Vec2(0.7, 0.9), 4)), 0,
      1e-12);
  const auto far =
      load_sensor(folder, R"(<float name="aperture_radius" value="0.5"/>)", "thinlens");
  EXPECT_NEAR(
      length(meet(*far.sensor, Vec2(0.1, 0.2), 1e4) - meet(*far.sensor, Vec2(0.7, 0.9), 1e4)), 0,
      1e-8);
  EXPECT_NEAR(1 / far.sensor->pdf_A(Vec3(0)), kPi * 0.25, 1e-12);
  const auto zero = load_sensor(folder, R"(<float name="aperture_radius" value="0"/>)", "thinlens");
  EXPECT_TRUE(zero.sensor->dirac_position());
  EXPECT_EQ(folder.warnings.size(), 1u);
  folder.write("scene.xml", R"(<scene version="3.0.0"><sensor type="thinlens"/></scene>)");
  EXPECT_NE(folder.error_of_file("scene.xml").find("needs the float \"aperture_radius\""),
            std::string::npos);
}

TEST(Orthographic, SpansTwoUnitsUnlessScaled) {
  SceneFolder folder;
  const auto size = [&](const std::string& properties) {
    const auto scene = load_sensor(folder, properties, "orthographic");
    const auto at = [&](double u, double v) {
      return scene.sensor->sample_direction(Vec3(0), Vec2(u, v)).origin;
    };
    return Vec3(at(0, 0).x - at(1, 0).x, at(0, 0).y - at(0, 1).y,
                scene.sensor->near_distance(Vec3(0, 0, 1)));
  };
  EXPECT_LT(length(size("") - Vec3(2, 1.5, 0.01)), 1e-12);
  EXPECT_LT(length(size(R"(<transform name="to_world"><scale x="10" y="4"/></transform>
                           <float name="near_clip" value="2"/><float name="far_clip" value="20"/>)") -
                   Vec3(20, 6, 2)),
            1e-12);
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_NE(
      folder.error(R"(<sensor type="orthographic"><float name="near_clip" value="0"/></sensor>)")
          .find("greater than zero"),
      std::string::npos);
  load_sensor(folder, R"(<float name="fov" value="40"/>)", "orthographic");
  EXPECT_EQ(folder.warnings.size(), 1u);
}

TEST(Sensor, DeclaresItsMedium) {
  SceneFolder folder;
  const auto scene =
      folder.load_text(R"(<scene version="3.0.0"><medium type="homogeneous" id="fog"/>
      <sensor type="perspective"><ref id="fog"/></sensor></scene>)");
  EXPECT_TRUE(scene.sensor_medium_declared);
  EXPECT_EQ(scene.sensor_medium->id(), "fog");
  EXPECT_FALSE(load_sensor(folder, "").sensor_medium_declared);
}

TEST(Film, DefaultsAndProperties) {
  SceneFolder folder;
  const auto standard = load_sensor(folder, "").film;
  EXPECT_EQ(standard.width, 768);
  EXPECT_EQ(standard.height, 576);
  EXPECT_EQ(standard.crop_width, 0);
  EXPECT_STREQ(standard.filter->name(), "gaussian");
  EXPECT_EQ(standard.filter->radius(), 2);
  const auto film = load_sensor(folder, R"(<film type="hdrfilm"><integer name="width" value="100"/>
      <integer name="height" value="50"/><integer name="crop_offset_x" value="10"/>
      <integer name="crop_offset_y" value="20"/><integer name="crop_width" value="30"/>
      <integer name="crop_height" value="15"/><string name="pixel_format" value="rgb"/>
      <string name="component_format" value="float32"/><string name="file_format" value="openexr"/>
      <rfilter type="tent"><float name="radius" value="1.5"/></rfilter></film>)")
                        .film;
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_EQ(film.width, 100);
  EXPECT_EQ(film.height, 50);
  EXPECT_EQ(film.crop_x, 10);
  EXPECT_EQ(film.crop_y, 20);
  EXPECT_EQ(film.crop_width, 30);
  EXPECT_EQ(film.crop_height, 15);
  EXPECT_EQ(film.filter->radius(), 1.5);
  const std::pair<const char*, double> filters[] = {{"box", 0.5}, {"tent", 1}, {"gaussian", 2}};
  for (const auto& [name, radius] : filters) {
    const auto loaded = load_sensor(
        folder, "<film type=\"hdrfilm\"><rfilter type=\"" + std::string(name) + "\"/></film>");
    EXPECT_STREQ(loaded.film.filter->name(), name);
    EXPECT_EQ(loaded.film.filter->radius(), radius);
  }
}

TEST(Film, SizeAndCropCanBeOverridden) {
  SceneFolder folder;
  const std::string film = R"(<film type="hdrfilm"><integer name="width" value="100"/>
      <integer name="height" value="50"/><integer name="crop_width" value="30"/></film>)";
  folder.options.size = {{40, 80}};
  const auto sized = load_sensor(
      folder, film + R"(<float name="fov" value="40"/><string name="fov_axis" value="y"/>)");
  EXPECT_EQ(sized.film.width, 40);
  EXPECT_EQ(sized.film.height, 80);
  EXPECT_EQ(sized.film.crop_width, 0);
  EXPECT_NEAR(horizontal_angle(*sized.sensor), 2 * std::atan(std::tan(kPi / 9) / 2) * 180 / kPi,
              1e-9);
  folder.options.crop = {{1, 2, 3, 4}};
  const auto cropped = load_sensor(folder, film).film;
  EXPECT_EQ(cropped.width, 40);
  EXPECT_EQ(cropped.crop_x, 1);
  EXPECT_EQ(cropped.crop_y, 2);
  EXPECT_EQ(cropped.crop_width, 3);
  EXPECT_EQ(cropped.crop_height, 4);
  folder.options.crop = {{38, 2, 3, 4}};
  folder.error_of_file("scene.xml");
  EXPECT_EQ(folder.kind, ErrorKind::Usage);
}

TEST(Integrator, KeepsItsPropertiesAsText) {
  SceneFolder folder;
  const auto scene = folder.load_text(R"(<scene version="3.0.0"><default name="d" value=" 12 "/>
      <integrator type="anything"><integer name="max_depth" value="$d"/>
      <float name="pLarge" value="0.30"/><boolean name="twoStage" value="true"/>
      <string name="mutations" value="lens:2,switch:1"/></integrator>
      <sensor type="perspective"><sampler type="whatever"><integer name="sample_count" value="64"/></sampler></sensor></scene>)");
  EXPECT_EQ(scene.integrator.type, "anything");
  const std::vector<std::pair<std::string, std::string>> expected{{"max_depth", "12"},
                                                                  {"pLarge", "0.30"},
                                                                  {"twoStage", "true"},
                                                                  {"mutations", "lens:2,switch:1"},
                                                                  {"sample_count", "64"}};
  EXPECT_EQ(scene.integrator.properties, expected);
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_EQ(load_sensor(folder, "").integrator.type, "");
  EXPECT_NE(
      folder.error(R"(<integrator type="path"><integer name="max_depth" value="x"/></integrator>)")
          .find("2:51: expected a whole number"),
      std::string::npos);
}

TEST(Integrator, OneInsideAnotherSaysWhichPicture) {
  SceneFolder folder;
  const std::string sensor = "<sensor type=\"perspective\"/>";
  const std::string text = R"(<scene version="3.0.0"><integrator type="aov">
<string name="aovs" value="dd:depth"/>
<integrator type="moment"><integrator type="path"><integer name="max_depth" value="2"/>
<boolean name="hide_emitters" value="true"/></integrator></integrator></integrator>)";
  const auto scene = folder.load_text(text + sensor + "</scene>");
  EXPECT_EQ(scene.integrator.type, "path");
  const std::vector<std::pair<std::string, std::string>> expected{{"max_depth", "2"},
                                                                  {"hide_emitters", "true"}};
  EXPECT_EQ(scene.integrator.properties, expected);
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("2:1: string \"aovs\" of integrator \"aov\" has no effect"),
            std::string::npos)
      << folder.warnings[0];
}

}  // namespace
}  // namespace fogbow
