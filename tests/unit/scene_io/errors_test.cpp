// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

struct Case {
  const char* body;
  const char* message;  ///< how it starts, without "scene.xml:"
};

/// Line 1 is that of <scene>; columns count bytes from 1.
TEST(Errors, NameLineColumnExpectedAndFound) {
  const Case cases[] = {
      {R"(<shape type="sphere"><float name="radius" value="2.5x"/></shape>)",
       "2:43: expected a finite number, found \"2.5x\""},
      {"<shape type=\"sphere\">\n\t<float name='radius'\n   value='inf'/></shape>",
       "4:4: expected a finite number, found \"inf\""},
      {R"(<shape type="sphere"><float value="1"/></shape>)",
       "2:22: <float> needs the attribute \"name\""},
      {R"(<shape type="sphere"><float name="radius"/></shape>)",
       "2:22: <float> needs the attribute \"value\""},
      {R"(<shape id="a"/>)", "2:1: <shape> needs the attribute \"type\""},
      {R"(  <shape type="spher"/>)",
       "2:3: the shape plugin \"spher\" is not supported (did you mean \"sphere\"?); known: "
       "\"cube\", "},
      {R"(<bsdf type="hair"/>)", "2:1: the bsdf plugin \"hair\" is not supported; known: "},
      {R"(<medium type="heterogenous"/>)",
       "2:1: the medium plugin \"heterogenous\" is not supported (did you mean "
       "\"heterogeneous\"?); known: \"heterogeneous\" and \"homogeneous\""},
      {R"(<medium type="heterogeneous"><volume name="sigma_t" type="vdbvolume"/></medium>)",
       "2:30: the volume plugin \"vdbvolume\" is not supported; known: \"const\", "},
      {R"(<phase type="sggx"/>)",
       "2:1: the phase plugin \"sggx\" is not supported; known: \"blendphase\", "},
      {R"(<emitter type="collimated"/>)",
       "2:1: the emitter plugin \"collimated\" is not supported"},
      {R"(<foo/>)", "2:1: unknown element <foo>"},
      {R"(<shap type="sphere"/>)", "2:1: unknown element <shap> (did you mean \"shape\"?)"},
      {R"(<shape type="sphere"><flaot name="radius" value="1"/></shape>)",
       "2:22: unknown element <flaot> (did you mean \"float\"?)"},
      {R"(<bsdf type="diffuse"><texture name="reflectance" type="bitmap"/></bsdf>)",
       "2:22: texture \"bitmap\" needs the string \"filename\""},
      {R"(<texture type="bitmap" id="t"/>)",
       "2:1: texture \"bitmap\" needs the string \"filename\""},
      {R"(<shape type="sphere"><string name="radius" value="2"/></shape>)",
       "2:22: \"radius\" must be of type float, found string"},
      {R"(<shape type="sphere"><rgb name="radius" value="2"/></shape>)",
       "2:22: \"radius\" must be of type float, found rgb"},
      {R"(<shape type="sphere"><boolean name="flip_normals" value="1"/></shape>)",
       "2:51: expected \"true\" or \"false\", found \"1\""},
      {R"(<shape type="sphere"><float name="radius" value="1"/> <float name="radius" value="3"/></shape>)",
       "2:55: \"radius\" is given twice (first at scene.xml:2:22)"},
      {R"(<shape type="sphere"><float name="radius" value="0"/></shape>)",
       "2:22: \"radius\" must be greater than zero"},
      {R"(<shape type="sphere"><point name="center" value="1, 2"/></shape>)",
       "2:43: expected one or three numbers, found \"1, 2\""},
      {R"(<shape type="sphere"><point name="center" y="2"/></shape>)",
       "2:22: <point> needs the attribute \"x\""},
      {R"(<shape type="sphere"><point name="center" value="1" y="2"/></shape>)",
       "2:53: give either \"value\", or \"x\", \"y\" and \"z\""},
      {R"(<bsdf type="diffuse"><rgb name="reflectance" value="1, 2"/></bsdf>)",
       "2:46: expected one or three numbers, found \"1, 2\""},
      {R"(<bsdf type="diffuse"><rgb name="reflectance" value="1, 2, nan"/></bsdf>)",
       "2:46: expected finite numbers, found \"1, 2, nan\""},
      {R"(<bsdf type="diffuse"><rgb name="reflectance" value="2, 0, 0"/></bsdf>)",
       "2:22: \"reflectance\" must lie between 0 and 1"},
      {R"(<bsdf type="diffuse"><spectrum name="reflectance" value="400:1, 700"/></bsdf>)",
       "2:51: expected pairs \"wavelength:value\""},
      {R"(<bsdf type="diffuse"><spectrum name="reflectance" value="500:1, 400:1"/></bsdf>)",
       "2:51: the wavelengths of a spectrum must increase"},
      {R"(<bsdf type="diffuse"><spectrum name="reflectance" filename="a.spd"/></bsdf>)", "2:51: "},
      {R"(<emitter type="point"><blackbody name="intensity" temperature="-1K"/></emitter>)",
       "2:51: a temperature must lie between"},
      {R"(<emitter type="constant"><rgb name="radiance" value="-1"/></emitter>)",
       "2:26: \"radiance\" must not be negative"},
      {R"(<emitter type="area"/>)", "2:1: the emitter \"area\" must stand inside a shape"},
      {R"(<shape type="sphere"><emitter type="point"/></shape>)",
       "2:22: the emitter plugin \"point\" is not supported; known: \"area\""},
      {R"(<shape type="sphere"><emitter type="area"/><emitter type="area"/></shape>)",
       "2:44: a second <emitter> in a shape"},
      {R"(<shape type="sphere"><bsdf type="null"/><bsdf type="null"/></shape>)",
       "2:1: shape \"sphere\" takes only one nested object of this kind, found 2"},
      {R"(<integrator type="path"/><integrator type="path"/>)", "2:26: a second integrator"},
      {R"(<shape type="obj"/>)", "2:1: shape \"obj\" needs the string \"filename\""},
      {R"(<shape type="obj"><string name="filename" value="no.obj"/></shape>)",
       "2:19: file not found: \"no.obj\""},
      {R"(<shape type="sphere" type="cube"/>)", "2:22: attribute \"type\" is given twice"},
      {R"(<shape type="sphere"></shap>)", "2:24: malformed XML"},
  };
  SceneFolder folder;
  for (const Case& c : cases) {
    const std::string expected = std::string("scene.xml:") + c.message;
    EXPECT_EQ(folder.error(c.body).substr(0, expected.size()), expected) << c.body;
  }
}

TEST(Errors, OfTheDocument) {
  SceneFolder folder;
  const Case cases[] = {
      {"", "malformed XML"},
      {"<scene version=\"3.0.0\">", "malformed XML"},
      {"<scene/>", "1:1: <scene> needs the attribute \"version\""},
      {"<scene version=\"new\"/>", "1:8: expected a version"},
      {"<bsdf type=\"null\"/>", "1:1: expected <scene> as the outermost element, found <bsdf>"},
      {"<scene version=\"3.0.0\"/>", "1:1: the scene has no sensor"},
      {"<scene version=\"3.0.0\"/><scene/>", "1:25: a second root element"},
  };
  for (const Case& c : cases) {
    folder.write("scene.xml", c.body);
    EXPECT_NE(folder.error_of_file("scene.xml").find(c.message), std::string::npos)
        << c.body << ": " << folder.error_of_file("scene.xml");
  }
  EXPECT_NE(folder.error_of_file("absent.xml").find("does not exist"), std::string::npos);
  EXPECT_EQ(folder.kind, ErrorKind::InputOutput);
}

TEST(Warnings, NameWhateverHasNoEffect) {
  const Case cases[] = {
      {R"(<shape type="sphere"><float name="radios" value="2"/></shape>)",
       "2:22: float \"radios\" of shape \"sphere\" has no effect (did you mean \"radius\"?)"},
      {R"(<bsdf type="null"><rgb name="tint" value="2"/></bsdf>)",
       "2:19: rgb \"tint\" of bsdf \"null\" has no effect"},
      {R"(<shape type="sphere" colour="red"/>)",
       "2:22: attribute \"colour\" of <shape> has no effect"},
      {R"(<shape type="sphere"><float name="radius" value="1" unit="m"/></shape>)",
       "2:53: attribute \"unit\" of <float> has no effect"},
      {R"(<shape type="sphere"><medium type="homogeneous"/></shape>)",
       "2:22: the medium nested in shape \"sphere\" has no effect"},
      {R"(<bsdf type="diffuse"><bsdf type="null"/></bsdf>)",
       "2:22: the bsdf nested in bsdf \"diffuse\" has no effect"},
      {R"(<shape type="sphere"><film type="hdrfilm"/></shape>)",
       "2:22: the film nested in shape \"sphere\" has no effect"},
      {R"(<shape type="sphere"> hello </shape>)",
       "2:23: text \"hello\" between elements has no effect"},
      {R"(<float name="a" value="1"/>)", "2:1: <float> directly in <scene> has no effect"},
      {R"(<sensor type="perspective"/>)", "3:1: a second sensor has no effect"},
      {R"(<bsdf type="roughconductor"><boolean name="sample_visible" value="false"/></bsdf>)",
       "2:29: visible normals are sampled always"},
      {R"(<emitter type="point"><float name="sampling_weight" value="2"/></emitter>)",
       "2:23: float \"sampling_weight\" of emitter \"point\" has no effect"},
  };
  SceneFolder folder;
  for (const Case& c : cases) {
    folder.options.strict = false;
    folder.load(c.body);
    ASSERT_EQ(folder.warnings.size(), 1u) << c.body;
    const std::string expected = folder.path("scene.xml").string() + ":" + c.message;
    EXPECT_EQ(folder.warnings[0].substr(0, expected.size()), expected);
    folder.options.strict = true;
    const std::string text = folder.error(c.body);
    EXPECT_EQ(text.find(std::string("scene.xml:") + c.message), 0u) << text;
    EXPECT_EQ(folder.kind, ErrorKind::Scene);
  }
}

}  // namespace
}  // namespace fogbow
