// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/media.h"
#include "media/mie.h"
#include "media/table_phase.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

// Defaults: probed from Mitsuba 3.9.1 (scalar_rgb, mi.load_string, mi.traverse); `emission` is
// ours.

EmitterPoint position_of(const Emitter& emitter) {
  return emitter.sample_position(Vec3(0.5)).value();
}

TEST(PointEmitter, StandsWherePositionOrTransformSay) {
  SceneFolder folder;
  const std::pair<const char*, Vec3> cases[] = {
      {"", {0, 0, 0}},
      {R"(<point name="position" value="1, 2, 3"/>)", {1, 2, 3}},
      {R"(<point name="position" x="1" y="2" z="3"/>)", {1, 2, 3}},
      {R"(<vector name="position" x="1" y="2" z="3"/>)", {1, 2, 3}},
      {R"(<transform name="to_world"><translate x="1" y="2" z="3"/></transform>)", {1, 2, 3}},
  };
  for (const auto& [property, position] : cases) {
    const auto scene =
        folder.load("<emitter type=\"point\">" + std::string(property) + "</emitter>");
    ASSERT_EQ(scene.emitters.size(), 1u);
    const Emitter& emitter = *scene.emitters[0];
    ASSERT_EQ(emitter.kind(), EmitterKind::Point);
    EXPECT_EQ(position_of(emitter).surface.position, position);
    EXPECT_EQ(emitter.L_e(position_of(emitter), Vec3(0, 0, 1)), RGB(1));
    EXPECT_TRUE(folder.warnings.empty());
  }
  const auto scene =
      folder.load(R"(<emitter type="point"><rgb name="intensity" value="1,2,3"/></emitter>)");
  EXPECT_EQ(scene.emitters[0]->L_e(position_of(*scene.emitters[0]), Vec3(0, 0, 1)), RGB(1, 2, 3));
  EXPECT_NE(folder
                .error(R"(<emitter type="point"><point name="position" value="1"/>
      <transform name="to_world"/></emitter>)")
                .find("either \"position\" or \"to_world\""),
            std::string::npos);
}

TEST(DirectionalEmitter, ShinesWhereDirectionOrTransformSay) {
  SceneFolder folder;
  const auto travels = [&](const std::string& property) {
    const auto scene = folder.load("<emitter type=\"directional\">" + property + "</emitter>");
    EXPECT_TRUE(folder.warnings.empty());
    Emitter& emitter = *scene.emitters.at(0);
    EXPECT_EQ(emitter.kind(), EmitterKind::Directional);
    emitter.bind(Vec3(0), 1);
    return position_of(emitter).surface.n_g;
  };
  EXPECT_EQ(travels(""), Vec3(0, 0, 1));
  const Vec3 expected = Vec3(1, 2, -2) / 3.0;
  EXPECT_LT(length(travels(R"(<vector name="direction" x="1" y="2" z="-2"/>)") - expected), 1e-15);
  EXPECT_LT(length(travels(R"(<transform name="to_world">
      <lookat origin="1,1,1" target="2,3,-1" up="0,0,1"/></transform>)") -
                   expected),
            1e-15);
  const auto scene = folder.load(
      R"(<emitter type="directional"><rgb name="irradiance" value="1,2,3"/></emitter>)");
  EXPECT_EQ(scene.emitters[0]->L_e({}, Vec3(0)), RGB(1, 2, 3));
  EXPECT_NE(folder
                .error(R"(<emitter type="directional"><vector name="direction" x="1" y="0" z="0"/>
      <transform name="to_world"/></emitter>)")
                .find("either \"direction\" or \"to_world\""),
            std::string::npos);
}

TEST(SpotEmitter, HasTheDefaultsOfMitsuba) {
  SceneFolder folder;
  const auto at = [&](const std::string& property, double degrees) {
    const auto scene = folder.load("<emitter type=\"spot\">" + property + "</emitter>");
    const double a = degrees * kPi / 180;
    const EmitterPoint x = position_of(*scene.emitters.at(0));
    return scene.emitters[0]->L_e(x, {std::sin(a), 0, std::cos(a)}).x;
  };
  EXPECT_EQ(at("", 14.9), 1);
  EXPECT_NEAR(at("", 18), 0.4, 1e-12);
  EXPECT_EQ(at("", 20.1), 0);
  const std::string cutoff = R"(<float name="cutoff_angle" value="30"/>)";
  EXPECT_EQ(at(cutoff, 22.4), 1);
  EXPECT_NEAR(at(cutoff + R"(<float name="beam_width" value="10"/>)", 20), 0.5, 1e-12);
  EXPECT_NEAR(at(R"(<rgb name="texture" value="0.25"/>)", 18), 0.1, 1e-12);
  const std::string error = folder.error("<emitter type=\"spot\">" + cutoff +
                                         R"(<float name="beam_width" value="31"/></emitter>)");
  EXPECT_NE(error.find("2:1: a spot light's beam width"), std::string::npos) << error;
}

TEST(EnvironmentEmitter, IsReadAsALinearPicture) {
  SceneFolder folder;
  folder.write("sky.exr", "bytes");
  Image picture(4, 3, {"R", "G", "B"});
  std::ranges::fill(picture.pixels, 0.5f);
  std::string asked;
  folder.options.read_image = [&](const std::string& path) {
    asked = path;
    return picture;
  };
  const auto radiance = [&](const std::string& property) {
    const auto scene =
        folder.load(R"(<emitter type="envmap"><string name="filename" value="sky.exr"/>)" +
                    property + "</emitter>");
    EmitterPoint x;
    x.surface.n_g = {1, 0, 0};
    return scene.emitters.at(0)->L_e(x, x.surface.n_g);
  };
  EXPECT_EQ(radiance(""), RGB(0.5));
  EXPECT_EQ(asked, folder.path("sky.exr"));
  EXPECT_EQ(radiance(R"(<float name="scale" value="3"/>)"), RGB(1.5));
  picture.metadata["oiio:ColorSpace"] = std::string("sRGB");
  EXPECT_NEAR(radiance("").x, 0.21404, 1e-5);  // ((0.5 + 0.055)/1.055)^2.4
  EXPECT_TRUE(folder.warnings.empty());
  picture.pixels[5] = -1;
  radiance("");
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("1 negative values"), std::string::npos);
}

TEST(EnvironmentEmitter, FilesAreHashedAndComplainedOfWithTheirPlace) {
  SceneFolder folder;
  const std::string body = R"(<emitter type="envmap"><string name="filename" value="sky.exr"/>
      </emitter>)";
  folder.write("sky.exr", "bytes");
  EXPECT_NE(folder.error(body).find("2:24: this program reads no pictures"), std::string::npos);
  folder.options.read_image = [](const std::string&) {
    Image picture(4, 3, {"R", "G", "B"});
    std::ranges::fill(picture.pixels, 1.0f);
    return picture;
  };
  const auto hash = folder.load(body).content_hash;
  folder.write("sky.exr", "other bytes");
  EXPECT_NE(folder.load(body).content_hash, hash);
  folder.options.read_image = [](const std::string&) -> Image {
    throw Error(ErrorKind::InputOutput, "no picture");
  };
  EXPECT_NE(folder.error(body).find("2:24: no picture"), std::string::npos);
  EXPECT_NE(folder.error("<emitter type=\"envmap\"/>").find("needs the string \"filename\""),
            std::string::npos);
}

TEST(ConstantEmitter, HasRadianceOneUnlessToldOtherwise) {
  SceneFolder folder;
  const auto radiance = [&](const std::string& property) {
    const auto scene = folder.load("<emitter type=\"constant\">" + property + "</emitter>");
    EXPECT_EQ(scene.emitters.at(0)->kind(), EmitterKind::Infinite);
    scene.emitters[0]->bind(Vec3(0), 1);
    return scene.emitters[0]->L_e(EmitterPoint{}, Vec3(0, 0, 1));
  };
  EXPECT_EQ(radiance(""), RGB(1));
  EXPECT_EQ(radiance(R"(<rgb name="radiance" value="1, 2, 3"/>)"), RGB(1, 2, 3));
  EXPECT_LT(
      length(radiance(R"(<spectrum name="radiance" value="4"/>)") - RGB(4.81918, 3.79316, 3.63566)),
      1e-5);
}

TEST(AreaEmitter, BelongsToItsShape) {
  SceneFolder folder;
  const auto scene = folder.load(R"(
    <emitter type="area" id="lamp"><rgb name="radiance" value="1, 2, 3"/></emitter>
    <shape type="rectangle"><emitter type="area"/></shape>
    <shape type="rectangle"><ref id="lamp"/></shape>
    <shape type="sphere"><ref id="lamp"/></shape>)");
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_TRUE(scene.emitters.empty());
  const RGB expected[] = {RGB(1), RGB(1, 2, 3), RGB(1, 2, 3)};
  for (std::size_t i = 0; i < 3; ++i) {
    const Emitter& emitter = *scene.surfaces[i].emitter;
    ASSERT_EQ(emitter.kind(), EmitterKind::Area);
    const EmitterPoint x = position_of(emitter);
    EXPECT_EQ(emitter.L_e(x, x.surface.n_g), expected[i]);
    EXPECT_EQ(emitter.L_e(x, -x.surface.n_g), RGB(0));
    EXPECT_NEAR(x.pdf_position, 1 / scene.surfaces[i].shape->area(), 1e-12);
  }
}

std::shared_ptr<const Medium> load_medium(SceneFolder& folder, const std::string& properties) {
  return folder
      .load("<shape type=\"sphere\"><medium type=\"homogeneous\" name=\"interior\" id=\"m\">" +
            properties + "</medium></shape>")
      .surfaces.at(0)
      .interior;
}

TEST(HomogeneousMedium, DefaultsAndProperties) {
  SceneFolder folder;
  const Vec3 p(0);
  const auto standard = load_medium(folder, "");
  EXPECT_EQ(standard->sigma_t(p), RGB(1));
  EXPECT_EQ(standard->sigma_s(p), RGB(0.75));
  EXPECT_EQ(standard->emission(p), RGB(0));
  EXPECT_EQ(standard->phase().mean_cosine(), 0);
  EXPECT_EQ(standard->id(), "m");
  const auto full = load_medium(folder, R"(<rgb name="sigma_t" value="1, 2, 4"/>
      <rgb name="albedo" value="0.5, 0.25, 1"/><float name="scale" value="3"/>
      <rgb name="emission" value="7, 8, 9"/><boolean name="sample_emitters" value="false"/>
      <boolean name="has_spectral_extinction" value="true"/>
      <phase type="hg"><float name="g" value="-0.25"/></phase>)");
  EXPECT_EQ(full->sigma_t(p), RGB(3, 6, 12));
  EXPECT_EQ(full->sigma_s(p), RGB(1.5, 1.5, 12));
  EXPECT_EQ(full->emission(p), RGB(7, 8, 9));
  EXPECT_EQ(full->phase().mean_cosine(), -0.25);
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_EQ(load_medium(folder, R"(<phase type="hg"/>)")->phase().mean_cosine(), 0.8);
  EXPECT_EQ(load_medium(folder, R"(<phase type="isotropic"/>)")->phase().mean_cosine(), 0);
}

TEST(Phase, Plugins) {
  SceneFolder folder;
  const auto value = [&](const std::string& phase, double cosine) {
    const auto medium = load_medium(folder, phase);
    return medium->phase().f_p({0, 0, 1}, {std::sqrt(1 - cosine * cosine), 0, -cosine}).x;
  };
  const double sphere = 4 * kPi;
  const std::string draine = R"(<phase type="draine"><float name="g" value="0"/>)";
  EXPECT_NEAR(value(draine + "</phase>", 0.6) * sphere, 0.75 * 1.36, 1e-14);
  EXPECT_NEAR(value(draine + R"(<float name="alpha" value="6"/></phase>)", 0.5) * sphere, 2.5 / 3,
              1e-14);
  EXPECT_NEAR(value(R"(<phase type="rayleigh"/>)", 0.6) * sphere, 0.75 * 1.36, 1e-14);
  const std::string table = R"(<phase type="tabphase"><string name="values" value=" 1, 2
      6,"/></phase>)";
  EXPECT_NEAR(value(table, 0.5) * sphere, 4 / 2.75, 1e-14);
  EXPECT_NEAR(value(table, -1) * sphere, 1 / 2.75, 1e-14);
  // Droplets far smaller than the wavelength.
  const auto mie = [](const std::string& properties) {
    return R"(<phase type="mie"><float name="radius" value="0.001"/>)"
           R"(<float name="spread" value="0"/>)" +
           properties + "</phase>";
  };
  EXPECT_NEAR(value(mie(""), 0.6) * sphere, 0.75 * 1.36, 1e-3);
  EXPECT_NEAR(value(mie(R"(<rgb name="wavelengths" value="650 550 450"/>
      <float name="index" value="1.5"/><rgb name="k" value="0, 0.1, 0"/>)"),
                    0.6) *
                  sphere,
              0.75 * 1.36, 1e-3);
  // Henyey and Greenstein's mean cosine of 0.8 in Draine's function with alpha = 1 (Draine 2003).
  EXPECT_NEAR(load_medium(folder, R"(<phase type="draine"/>)")->phase().mean_cosine(),
              0.8 * (1 + (3 + 2 * 0.64) / 5) / (1 + (1 + 2 * 0.64) / 3), 1e-12);
  // Each channel has a wavelength, an index and an absorption of its own.
  const auto expect_droplets = [&](const std::string& properties, const DropletSettings& s) {
    const auto medium = load_medium(folder, R"(<phase type="mie"><float name="radius" value="0.3"/>
        <float name="spread" value="0.1"/>)" + properties +
                                                "</phase>");
    const auto expected = make_table_phase(Droplets(s).table());
    for (const double cosine : {-0.9, 0.1, 0.8}) {
      const Vec3 to(std::sqrt(1 - cosine * cosine), 0, -cosine);
      EXPECT_EQ(medium->phase().f_p({0, 0, 1}, to), expected->f_p({0, 0, 1}, to)) << properties;
    }
  };
  expect_droplets("", water_droplets(0.3, 0.1));
  DropletSettings soot = water_droplets(0.3, 0.1);
  soot.index[0] = {1.5, 0.1};
  soot.index[1] = {1.6, 0.4};
  soot.index[2] = {1.7, 0};
  expect_droplets(R"(<rgb name="index" value="1.5 1.6 1.7"/><rgb name="k" value="0.1 0.4 0"/>)",
                  soot);
  // The compact form is not exact, and the same in all channels.
  const std::string compact =
      R"(<phase type="mie"><float name="radius" value="1"/><boolean name="compact" value="true"/>)";
  const auto fit = load_medium(folder, compact + "</phase>");
  EXPECT_NEAR(fit->phase().mean_cosine(), 0.76, 0.1);
  const RGB ahead = fit->phase().f_p({0, 0, 1}, {0, 0, -1});
  EXPECT_TRUE(ahead.x == ahead.y && ahead.y == ahead.z) << ahead.x;
  EXPECT_NEAR(load_medium(folder, R"(<phase type="mie"><float name="radius" value="1"/></phase>)")
                  ->phase()
                  .mean_cosine(),
              0.76, 0.03);
  // The first in the file weighs 1 − weight.
  const auto blend = [](const std::string& phases) {
    return R"(<phase type="blendphase"><float name="weight" value="0.25"/>)" + phases + "</phase>";
  };
  EXPECT_NEAR(value(blend(table + R"(<phase type="isotropic"/>)"), -1) * sphere, 0.75 / 2.75 + 0.25,
              1e-14);
  EXPECT_NEAR(
      value(blend(blend(table + table) + R"(<phase name="a" type="rayleigh"/>)"), -1) * sphere,
      0.75 / 2.75 + 0.25 * 1.5, 1e-14);
  EXPECT_TRUE(folder.warnings.empty());
}

TEST(Phase, RefusesWhatItCannotMean) {
  SceneFolder folder;
  const auto expect_error = [&](const std::string& phase, const std::string& message) {
    const std::string error = folder.error(phase);
    EXPECT_NE(error.find(message), std::string::npos) << error;
  };
  const auto table = [](const std::string& values) {
    return "<phase type=\"tabphase\"><string name=\"values\" value=\"" + values + "\"/></phase>";
  };
  expect_error(R"(<phase type="tabphase"/>)",
               "2:1: phase \"tabphase\" needs the string \"values\"");
  expect_error(table("1"), "2:24: a phase function needs at least two values");
  expect_error(table(""), "2:24: a phase function needs at least two values");
  expect_error(table("0, 0"), "2:24: the values of a phase function must not all be zero");
  expect_error(table("1, -1"), "2:24: the values of a phase function must be finite and not neg");
  expect_error(table("1, nan"), "2:24: the values of a phase function must be finite");
  expect_error(table("1, 2x"), "2:24: expected a number in \"values\", found \"2x\"");
  expect_error(table("1e308 1e308 1e308"), "2:24: the values of a phase function");
  expect_error(R"(<phase type="draine"><float name="g" value="1"/></phase>)",
               "2:22: \"g\" must lie strictly between -1 and 1");
  expect_error(R"(<phase type="draine"><float name="alpha" value="-1"/></phase>)",
               "2:22: \"alpha\" must not be negative");
  const auto mie = [](const std::string& tag, const std::string& name, const std::string& value) {
    return "<phase type=\"mie\"><" + tag + " name=\"" + name + "\" value=\"" + value +
           "\"/></phase>";
  };
  expect_error(mie("float", "radius", "0"), "2:19: \"radius\" must be greater than zero");
  expect_error(mie("float", "radius", "1e9"), "2:1: droplets of such a radius and spread are too");
  expect_error(mie("float", "spread", "2"), "2:19: \"spread\" must lie between 0 and 1");
  expect_error(mie("rgb", "wavelengths", "600, 500, 40"), "2:19: \"wavelengths\" must lie between");
  expect_error(mie("rgb", "index", "1.3, 1.3, 0"), "2:19: \"index\" must be greater than zero");
  expect_error(mie("float", "index", "1e9"), "2:1: no scattering can be computed");
  expect_error(mie("float", "k", "-1"), "2:19: \"k\" must not be negative");
  const auto blend = [](const std::string& content) {
    return "<phase type=\"blendphase\">" + content + "</phase>";
  };
  const std::string hg = R"(<phase type="hg"/>)";
  expect_error(blend(hg + hg), "2:1: phase \"blendphase\" needs the float \"weight\"");
  const std::string weight = R"(<float name="weight" value="0.5"/>)";
  expect_error(blend(weight + hg), "2:1: phase \"blendphase\" needs two nested phase functions");
  expect_error(blend(weight + hg + hg + hg), "functions, found 3");
  expect_error(blend(R"(<float name="weight" value="1.5"/>)" + hg + hg),
               "2:26: \"weight\" must lie between 0 and 1");
  expect_error(blend(R"(<string name="weight" value="a"/>)" + hg + hg),
               "2:26: \"weight\" must be of type float");
}

TEST(HomogeneousMedium, RefusesWhatItCannotMean) {
  SceneFolder folder;
  const auto error = [&](const std::string& properties) {
    return folder.error("<medium type=\"homogeneous\">" + properties + "</medium>");
  };
  EXPECT_NE(error(R"(<string name="material" value="skin1"/>)")
                .find("2:28: \"material\" is not supported yet"),
            std::string::npos);
  EXPECT_NE(
      error(R"(<rgb name="sigma_s" value="1"/>)").find("give either \"sigma_t\" and \"albedo\""),
      std::string::npos);
  EXPECT_NE(
      error(R"(<rgb name="albedo" value="2"/>)").find("2:28: \"albedo\" must lie between 0 and 1"),
      std::string::npos);
  EXPECT_NE(
      error(R"(<rgb name="sigma_t" value="-1"/>)").find("2:28: \"sigma_t\" must not be negative"),
      std::string::npos);
  EXPECT_NE(error(R"(<float name="scale" value="-1"/>)").find("\"scale\" must not be negative"),
            std::string::npos);
  EXPECT_NE(error(R"(<rgb name="sigma_t" value="1e300"/><float name="scale" value="1e300"/>)")
                .find("scene.xml:2:1: "),
            std::string::npos);
  EXPECT_NE(error(R"(<phase type="hg"/><phase type="isotropic"/>)").find("found 2"),
            std::string::npos);
  for (const char* g : {"1", "-1", "1.5"})
    EXPECT_NE(
        error("<phase type=\"hg\"><float name=\"g\" value=\"" + std::string(g) + "\"/></phase>")
            .find("2:45: \"g\" must lie strictly between -1 and 1"),
        std::string::npos);
}

TEST(Boundary, IsOneIffAMediumIsNamed) {
  SceneFolder folder;
  const auto scene = folder.load(R"(
    <medium type="homogeneous" id="fog"/><medium type="homogeneous" id="smoke"/>
    <shape type="sphere"/>
    <shape type="sphere"><ref name="interior" id="fog"/></shape>
    <shape type="sphere"><ref name="exterior" id="fog"/></shape>
    <shape type="sphere"><ref name="interior" id="smoke"/><ref name="exterior" id="fog"/></shape>)");
  const auto& s = scene.surfaces;
  EXPECT_FALSE(s[0].medium_boundary);
  EXPECT_TRUE(s[1].medium_boundary && s[2].medium_boundary && s[3].medium_boundary);
  EXPECT_TRUE(s[1].interior && !s[1].exterior && !s[2].interior && s[3].interior);
  EXPECT_EQ(s[1].interior, s[2].exterior);
  EXPECT_EQ(s[1].interior, s[3].exterior);
  EXPECT_NE(s[3].interior, s[3].exterior);
  EXPECT_NE(folder
                .error(R"(<medium type="homogeneous" id="fog"/><shape type="sphere">
      <ref name="interior" id="fog"/><ref name="interior" id="fog"/></shape>)")
                .find("3:38: a second \"interior\" medium"),
            std::string::npos);
}

}  // namespace
}  // namespace fogbow
