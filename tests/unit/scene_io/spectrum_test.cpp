// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of Mitsuba 3.9.1 (scalar_rgb): mi.traverse() of <spectrum value="…"/> as the reflectance
// of a "diffuse" bsdf and as the intensity of a "point" emitter.
#include "core/scene_io/spectrum.h"

#include "core/scene/bsdf.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

const SourceLocation kHere{"here.xml", 3, 7};

TEST(Spectrum, HasMitsubasColours) {
  struct Case {
    const char* text;
    RGB reflectance, emission;
  };
  const Case cases[] = {
      {"400:0.5, 700:0.5", {0.497671, 0.499878, 0.497455}, {0.599847, 0.47476, 0.451722}},
      {"400:0.1, 500:0.2, 600:0.7, 700:0.9",
       {0.856079, 0.404085, 0.112402},
       {0.98816, 0.387351, 0.0956021}},
      {"400:0.1 500:0.2 600:0.7 700:0.9",
       {0.856079, 0.404085, 0.112402},
       {0.98816, 0.387351, 0.0956021}},
      {"550:1, 560:1", {0.0124793, 0.137198, -0.0168271}, {0.0122891, 0.133081, -0.0163274}},
      {"380:0,480:1,580:0", {-0.261957, 0.416242, 0.767577}, {-0.23506, 0.386682, 0.689314}},
      {"300:.4,900:.4", {0.399594, 0.399549, 0.399521}, {0.481953, 0.379291, 0.363707}}};
  for (const Case& c : cases) {
    const auto samples = parse_spectrum(c.text, kHere);
    EXPECT_LT(length(spectrum_to_rgb(samples, false) - c.reflectance), 3e-6) << c.text;
    EXPECT_LT(length(spectrum_to_rgb(samples, true) - c.emission), 3e-6) << c.text;
  }
  EXPECT_LT(length(equal_energy_to_rgb(3) - RGB(3.61438, 2.84487, 2.72675)), 1e-5);
}

/// Y of linear sRGB as Mitsuba's matrix has it, and chromaticities.
Vec3 to_xyz(const RGB& c) {
  return {0.412453 * c.x + 0.357580 * c.y + 0.180423 * c.z,
          0.212671 * c.x + 0.715160 * c.y + 0.072169 * c.z,
          0.019334 * c.x + 0.119193 * c.y + 0.950227 * c.z};
}

/// Published: illuminant A is a black body of 2856 K with (x, y) = (0.4476, 0.4074), that of
/// 5000 K has (0.3451, 0.3516); the candela was 1/60 of what 1 cm² at the freezing point of
/// platinum, 2042 K on the scale of its day, shines with.
TEST(Blackbody, HasThePublishedColourAndLuminance) {
  const std::pair<double, Vec2> cases[] = {{2856, {0.4476, 0.4074}}, {5000, {0.3451, 0.3516}}};
  for (const auto& [temperature, xy] : cases) {
    const Vec3 c = to_xyz(blackbody_to_rgb(temperature));
    EXPECT_NEAR(c.x / (c.x + c.y + c.z), xy.x, 2e-4) << temperature;
    EXPECT_NEAR(c.y / (c.x + c.y + c.z), xy.y, 2e-4) << temperature;
  }
  const double luminous = 683.002 * 106.857 * to_xyz(blackbody_to_rgb(2042)).y;
  EXPECT_NEAR(luminous / 60e4, 1, 0.005);
}

TEST(Spectrum, ListsAndFilesMustBeSound) {
  for (const char* bad : {"", " ", "400", "400:", "400:x", ":1", "400:1;500:2", "500:1, 400:2",
                          "400:1, 400:2", "-5:1", "400:1, 500", "nan:1", "400:inf"})
    EXPECT_THROW(parse_spectrum(bad, kHere), Error) << bad;
  const auto samples = parse_spd("# a lamp\n400 0.5\n\n 500\t1 # peak\r\n600, 0.25", "a.spd");
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_EQ(samples[2].wavelength, 600);
  EXPECT_EQ(samples[1].value, 1);
  try {
    parse_spd("400 1\n500\n", "a.spd");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.where().line, 2);
  }
  EXPECT_THROW(parse_spd("# nothing\n", "a.spd"), Error);
}

RGB intensity(SceneFolder& folder, const std::string& value) {
  const auto scene = folder.load("<emitter type=\"point\">" + value + "</emitter>");
  const Emitter& emitter = *scene.emitters.at(0);
  return emitter.L_e(*emitter.sample_position(Vec3(0)), Vec3(0, 0, 1));
}

TEST(Spectrum, IsReadByWhatItIsFor) {
  SceneFolder folder;
  folder.write("lamp.spd", "400 0.1\n500 0.2\n600 0.7\n700 0.9\n");
  const RGB emission(0.98816, 0.387351, 0.0956021), reflectance(0.856079, 0.404085, 0.112402);
  const std::string list = "value=\"400:0.1, 500:0.2, 600:0.7, 700:0.9\"/>",
                    file = "filename=\"lamp.spd\"/>";
  for (const std::string& source : {list, file}) {
    EXPECT_LT(length(intensity(folder, "<spectrum name=\"intensity\" " + source) - emission), 3e-6);
    const auto scene = folder.load(
        "<shape type=\"sphere\"><bsdf type=\"diffuse\"><spectrum name=\"reflectance\" " + source +
        "</bsdf></shape>");
    const RGB f = scene.surfaces.at(0).bsdf->f_s({}, {0, 0, 1}, {0, 0, 1});
    EXPECT_LT(length(kPi * f - reflectance), 3e-6);
    EXPECT_TRUE(folder.warnings.empty());
  }
  EXPECT_LT(length(intensity(folder, R"(<spectrum name="intensity" value="3"/>)") -
                   RGB(3.61438, 2.84487, 2.72675)),
            1e-5);
  EXPECT_LT(
      length(intensity(folder, R"(<blackbody name="intensity" temperature="5000K" scale="2"/>)") /
                 blackbody_to_rgb(5000) -
             2.0),
      1e-12);
}

TEST(Spectrum, OutOfRangeIsCut) {
  SceneFolder folder;
  const auto scene = folder.load(
      R"(<shape type="sphere"><bsdf type="diffuse"><spectrum name="reflectance"
         value="590:0, 600:1, 780:1"/></bsdf></shape>)");
  const RGB f = kPi * scene.surfaces.at(0).bsdf->f_s({}, {0, 0, 1}, {0, 0, 1});
  EXPECT_LE(max_component(f), 1);
  for (int c = 0; c < 3; ++c) EXPECT_GE(f[c], 0);
  const RGB green = intensity(folder, R"(<spectrum name="intensity" value="550:1, 560:1"/>)");
  EXPECT_EQ(green.z, 0);
  EXPECT_NEAR(green.y, 0.133081, 1e-6);
  ASSERT_EQ(folder.warnings.size(), 1u);
  EXPECT_NE(folder.warnings[0].find("no colour of sRGB"), std::string::npos);
}

}  // namespace
}  // namespace fogbow
