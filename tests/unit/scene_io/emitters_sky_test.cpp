// SPDX-License-Identifier: GPL-3.0-or-later
// Sun, sky, projectors and textured lamps; defaults are those of Mitsuba 3.9.1.
#include "core/image/image.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

EmitterPoint from(const Vec3& d) {
  EmitterPoint x;
  x.surface.n_g = -d;
  return x;
}

RGB light_from(const SceneDescription& scene, const Vec3& d) {
  RGB sum(0);
  for (const auto& e : scene.emitters) sum += e->L_e(from(d), -d);
  return sum;
}

std::string emitter(const std::string& type, const std::string& body) {
  return "<emitter type=\"" + type + "\">" + body + "</emitter>";
}

void expect_color(const RGB& a, const RGB& b, double relative) {
  EXPECT_LT(length(a - b), relative * length(b)) << a.x << ' ' << a.y << ' ' << a.z;
}

const char* kSun = R"(<vector name="sun_direction" x="1" y="0.5" z="1"/>)";
const Vec3 kTowards = normalize(Vec3(1, 0.5, 1));

TEST(SunSky, ShinesByItsDefaults) {
  SceneFolder folder;
  const auto scene = folder.load(emitter("sunsky", ""));
  ASSERT_EQ(scene.emitters.size(), 2u);
  EXPECT_TRUE(folder.warnings.empty());
  // Where Mitsuba has the sun on that afternoon; the disk is there, and not far beside it.
  const Vec3 sun = normalize(Vec3(0.05138545, 0.6917480, 0.7203085));
  EXPECT_GT(light_from(scene, sun).x, 1e4);
  EXPECT_LT(light_from(scene, normalize(sun + Vec3(0.01, 0, 0))).x, 10);
  EXPECT_GT(light_from(scene, Vec3(0, 0, 1)).z, 0.01);
  EXPECT_EQ(light_from(scene, Vec3(0, 0.1, -1)), RGB(0));
  // It stands in the sky, and is turned with it.
  const auto turned = folder.load(
      emitter("sunsky", R"(<transform name="to_world"><rotate x="1" angle="-90"/></transform>)"));
  EXPECT_GT(light_from(turned, {sun.x, sun.z, -sun.y}).x, 1e4);
  EXPECT_LT(light_from(turned, sun).x, 10);
}

TEST(SunSky, TurnsWithItsTransformAndScales) {
  SceneFolder folder;
  const auto one = folder.load(emitter("sunsky", kSun));
  // The sun's direction is one of the world.
  const auto turned = folder.load(emitter("sunsky", std::string(kSun) + R"(
      <transform name="to_world"><rotate x="1" angle="-90"/></transform>)"));
  EXPECT_GT(light_from(turned, kTowards).x, 1e4);
  EXPECT_EQ(light_from(turned, Vec3(0, -1, 0.01)), RGB(0));
  EXPECT_GT(light_from(turned, Vec3(0, 1, 0)).z, 0.01);
  const auto scaled = folder.load(emitter("sunsky", std::string(kSun) + R"(
      <float name="sky_scale" value="3"/><float name="sun_scale" value="0"/>)"));
  EXPECT_EQ(scaled.emitters.size(), 1u);
  expect_color(light_from(scaled, Vec3(0, 0, 1)), 3.0 * light_from(one, Vec3(0, 0, 1)), 1e-12);
  const auto large = folder.load(emitter("sunsky", std::string(kSun) + R"(
      <float name="sun_aperture" value="10"/><boolean name="complex_sun" value="true"/>
      <float name="sky_scale" value="0"/>)"));
  const Vec3 edge = normalize(kTowards + 0.08 * normalize(cross(kTowards, Vec3(0, 0, 1))));
  EXPECT_LT(light_from(large, edge).z, 0.9 * light_from(large, kTowards).z);
  EXPECT_GT(light_from(large, edge).z, 1);
  EXPECT_TRUE(folder.warnings.empty());
}

TEST(SunSky, RefusesWhatIsImpossible) {
  SceneFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {R"(<float name="turbidity" value="11"/>)", "between 1 and 10"},
      {R"(<rgb name="albedo" value="0.1,1.5,0"/>)", "between 0 and 1"},
      {R"(<vector name="sun_direction" value="0,0,1"/><float name="hour" value="3"/>)", "either"},
      {R"(<vector name="sun_direction" value="0,0,0"/>)", "not zero"},
      {R"(<float name="sun_scale" value="-1"/>)", "negative"},
      {R"(<float name="sun_aperture" value="0"/>)", "between 0 and 180"},
      {R"(<transform name="to_world"><scale x="2"/></transform>)", "not stretch"},
  };
  for (const auto& [body, message] : cases) {
    EXPECT_NE(folder.error(emitter("sunsky", body)).find(message), std::string::npos) << body;
    EXPECT_EQ(folder.where.line, 2);
  }
  EXPECT_TRUE(
      folder.load(emitter("sunsky", R"(<float name="hour" value="22"/>)")).emitters.empty());
  EXPECT_EQ(folder.warnings.size(), 1u);
}

/// Mitsuba 0.6: +y is up, one plugin each, and other names.
TEST(SunSky, OldOnesAreUpgraded) {
  SceneFolder folder;
  const auto old = [&](const std::string& type, const std::string& body) {
    return folder.load_text("<scene version=\"0.6.0\"><sensor type=\"perspective\"/>" +
                            emitter(type, body) + "</scene>");
  };
  const std::string sun = R"(<vector name="sunDirection" x="1" y="1" z="0.5"/>)";
  const Vec3 towards = normalize(Vec3(1, 1, 0.5));
  const auto both = old("sunsky", sun + R"(<float name="sunScale" value="2"/>
      <float name="skyScale" value="0.5"/><integer name="resolution" value="256"/>
      <float name="sunRadiusScale" value="4"/>)");
  EXPECT_TRUE(folder.warnings.empty());
  ASSERT_EQ(both.emitters.size(), 2u);
  EXPECT_GT(light_from(both, Vec3(0, 1, 0)).z, 0.001);
  EXPECT_EQ(light_from(both, Vec3(0, -1, 0)), RGB(0));
  const auto today = folder.load(emitter("sunsky", R"(<vector name="sun_direction" x="1" y="1"
      z="0.5"/><transform name="to_world"><rotate x="1" angle="-90"/></transform>
      <float name="sun_scale" value="2"/><float name="sky_scale" value="0.5"/>
      <float name="sun_aperture" value="2.1432"/><float name="albedo" value="0.15"/>)"));
  for (const Vec3& d : {towards, Vec3(0, 1, 0), normalize(Vec3(-1, 0.1, 2))})
    expect_color(light_from(both, d), light_from(today, d), 1e-12);
  EXPECT_EQ(old("sky", sun).emitters.size(), 1u);
  EXPECT_EQ(light_from(old("sun", sun), Vec3(0, 1, 0)), RGB(0));
  // An afternoon in Tokyo: to the west and a little to the south, where +z is.
  const auto noon = old("sun", R"(<float name="sunRadiusScale" value="20"/>)");
  EXPECT_GT(light_from(noon, normalize(Vec3(-0.6917480, 0.7203085, 0.05138545))).x, 1);
}

Image read_fake(const std::string&) {
  Image image(4, 2, {"R", "G", "B"});
  image.at(0, 0, 0) = 2;
  return image;
}

TEST(Projector, ShinesByItsPicture) {
  SceneFolder folder;
  folder.options.read_image = read_fake;
  folder.write("a.exr", "a");
  const auto scene = folder.load(emitter("projector", R"(<texture type="bitmap" name="irradiance">
      <string name="filename" value="a.exr"/><string name="filter_type" value="nearest"/></texture>
      <float name="fov" value="90"/><float name="scale" value="3"/><transform name="to_world">
      <lookat origin="1,2,3" target="1,2,0" up="0,1,0"/></transform>)"));
  EXPECT_TRUE(folder.warnings.empty());
  const Emitter& e = *scene.emitters.at(0);
  EXPECT_EQ(e.kind(), EmitterKind::Point);
  const auto x = e.sample_position(Vec3(0.5));
  EXPECT_EQ(x->surface.position, Vec3(1, 2, 3));
  // Up and to the left of who looks along −z.
  EXPECT_NEAR(e.L_e(*x, normalize(Vec3(-0.9, 0.4, -1))).x, 6 * kPi * std::pow(1.97, 1.5), 1e-9);
  EXPECT_EQ(e.L_e(*x, normalize(Vec3(0.9, 0.4, -1))), RGB(0));
  EXPECT_EQ(e.L_e(*x, normalize(Vec3(-0.9, 0.51, -1))), RGB(0));
  // Along y, of a picture twice as wide as it is high.
  const auto wide = folder.load(emitter("projector", R"(<texture type="bitmap" name="irradiance">
      <string name="filename" value="a.exr"/><string name="filter_type" value="nearest"/></texture>
      <float name="fov" value="90"/><string name="fov_axis" value="y"/>)"));
  const auto y = wide.emitters.at(0)->sample_position(Vec3(0.5));
  EXPECT_GT(wide.emitters[0]->L_e(*y, normalize(Vec3(1.9, 0.9, 1))).x, 0);
  EXPECT_EQ(wide.emitters[0]->L_e(*y, normalize(Vec3(2.1, 0, 1))), RGB(0));
  EXPECT_EQ(wide.emitters[0]->L_e(*y, normalize(Vec3(0, 1.1, 1))), RGB(0));
  // 38.2 degrees from edge to edge, and white, if nothing is said.
  const auto standard = folder.load(emitter("projector", ""));
  const auto o = standard.emitters.at(0)->sample_position(Vec3(0.5));
  const auto at = [&](double degrees) {
    const double t = degrees * kPi / 180;
    return standard.emitters[0]->L_e(*o, Vec3(std::sin(t), 0, std::cos(t))).x;
  };
  EXPECT_NEAR(at(0), kPi, 1e-12);
  // 35 mm film of 50 mm on the diagonal of a square: Mitsuba's x_fov is 34.0225.
  EXPECT_GT(at(17.0), 0);
  EXPECT_EQ(at(17.1), 0);
  EXPECT_NE(folder.error(emitter("projector", R"(<float name="scale" value="0"/>)"))
                .find("greater than zero"),
            std::string::npos);
}

TEST(AreaEmitter, TakesATexture) {
  SceneFolder folder;
  folder.options.read_image = read_fake;
  folder.write("a.exr", "a");
  const auto scene = folder.load(R"(<shape type="rectangle"><emitter type="area">
      <texture type="bitmap" name="radiance"><string name="filename" value="a.exr"/>
      <string name="filter_type" value="nearest"/></texture></emitter></shape>)");
  EXPECT_TRUE(folder.warnings.empty());
  const Surface& s = scene.surfaces.at(0);
  const auto x = s.shape->surface_point(0, Vec2(0.1, 0.2));
  EXPECT_EQ(s.emitter->L_e({x, {}, 0}, x.n_g), RGB(2, 0, 0));
  const auto dark = s.shape->surface_point(0, Vec2(0.6, 0.2));
  EXPECT_EQ(s.emitter->L_e({dark, {}, 0}, x.n_g), RGB(0));
  EXPECT_GT(s.emitter->pdf_position({x, {}, 0}), 4 * s.emitter->pdf_position({dark, {}, 0}));
  EXPECT_NE(folder
                .error(R"(<shape type="rectangle"><emitter type="area"><texture type="checkerboard"
      name="radiance"><float name="color0" value="0"/><float name="color1" value="0"/></texture>
      </emitter></shape>)")
                .find("black"),
            std::string::npos);
}

TEST(RawConstant, IsANumberOrThree) {
  SceneFolder folder;
  const auto albedo = [&](const std::string& value) {
    const auto scene = folder.load(R"(<shape type="sphere"><bsdf type="diffuse">
        <texture type="rawconstant" name="reflectance">)" +
                                   value + "</texture></bsdf></shape>");
    EXPECT_TRUE(folder.warnings.empty());
    return scene.surfaces.at(0).bsdf->albedo({});
  };
  EXPECT_EQ(albedo(R"(<float name="value" value="0.3"/>)"), RGB(0.3));
  EXPECT_EQ(albedo(R"(<vector name="value" value="0.1,0.2,0.3"/>)"), RGB(0.1, 0.2, 0.3));
  EXPECT_NE(folder.error(R"(<texture type="rawconstant" id="a"/>)").find("needs a \"value\""),
            std::string::npos);
  EXPECT_NE(folder
                .error(R"(<bsdf type="diffuse" id="a"><texture type="rawconstant"
      name="reflectance"><float name="value" value="1.3"/></texture></bsdf>)")
                .find("between 0 and 1"),
            std::string::npos);
}

}  // namespace
}  // namespace fogbow
