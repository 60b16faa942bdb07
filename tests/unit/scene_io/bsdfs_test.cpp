// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"

#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

// Defaults and named values: probed from Mitsuba 3.9.1 (scalar_rgb, mi.load_string, mi.traverse).

std::shared_ptr<const Bsdf> load_bsdf(SceneFolder& folder, const std::string& bsdf) {
  return folder.load("<shape type=\"sphere\">" + bsdf + "</shape>").surfaces.at(0).bsdf;
}

/// Value of the smooth part for two directions 0.3 and 0.5 off the normal, in one plane.
RGB value(const Bsdf& bsdf) {
  return bsdf.f_s(SurfacePoint{}, Vec3(std::sin(0.3), 0, std::cos(0.3)),
                  Vec3(-std::sin(0.5), 0, std::cos(0.5)));
}
RGB dirac_value(const Bsdf& bsdf) {
  return bsdf.f_dirac(SurfacePoint{}, Vec3(0.6, 0, 0.8), Vec3(-0.6, 0, 0.8));
}

void expect_equal(const RGB& a, const RGB& b) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], 1e-12 * (1 + std::abs(b[i])));
}

TEST(DefaultBsdf, IsGreyAndBlackOnEmitters) {
  SceneFolder folder;
  const auto scene =
      folder.load(R"(<shape type="sphere"/><shape type="sphere"><emitter type="area"/></shape>)");
  expect_equal(value(*scene.surfaces[0].bsdf), RGB(0.5 * kInvPi));
  expect_equal(value(*scene.surfaces[1].bsdf), RGB(0));
  EXPECT_TRUE(scene.surfaces[1].emitter);
  EXPECT_FALSE(scene.surfaces[0].emitter);
}

TEST(Diffuse, TakesColorsInAllSpellings) {
  SceneFolder folder;
  const std::pair<const char*, RGB> cases[] = {
      {"", RGB(0.5)},
      {R"(<rgb name="reflectance" value="0.2, 0.3, 0.4"/>)", {0.2, 0.3, 0.4}},
      {R"(<rgb name="reflectance" value="0.2 0.3 0.4"/>)", {0.2, 0.3, 0.4}},
      {R"(<rgb name="reflectance" value="0.2"/>)", RGB(0.2)},
      {R"(<spectrum name="reflectance" value="0.3"/>)", RGB(0.3)},
      {R"(<float name="reflectance" value="0.3"/>)", RGB(0.3)},
      {R"(<integer name="reflectance" value="1"/>)", RGB(1)},
  };
  for (const auto& [property, expected] : cases) {
    const auto bsdf =
        load_bsdf(folder, "<bsdf type=\"diffuse\">" + std::string(property) + "</bsdf>");
    expect_equal(value(*bsdf), expected * kInvPi);
    EXPECT_TRUE(folder.warnings.empty());
  }
}

TEST(Twosided, TakesOneOrTwo) {
  SceneFolder folder;
  const Vec3 below_a(0.6, 0, -0.8), below_b(-0.6, 0, -0.8);
  const auto one = load_bsdf(folder, R"(<bsdf type="twosided"><bsdf type="diffuse"/></bsdf>)");
  expect_equal(one->f_s(SurfacePoint{}, below_a, below_b), RGB(0.5 * kInvPi));
  const auto two = load_bsdf(folder, R"(<bsdf type="twosided"><bsdf type="diffuse"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.1"/></bsdf></bsdf>)");
  expect_equal(two->f_s(SurfacePoint{}, below_a, below_b), RGB(0.1 * kInvPi));
  expect_equal(value(*two), RGB(0.5 * kInvPi));
  EXPECT_NE(
      folder.error(R"(<bsdf type="twosided"/>)").find("needs one or two nested bsdfs, found 0"),
      std::string::npos);
  EXPECT_NE(folder
                .error(R"(<bsdf type="twosided"><bsdf type="diffuse"/><bsdf type="diffuse"/>
      <bsdf type="diffuse"/></bsdf>)")
                .find("found 3"),
            std::string::npos);
  EXPECT_EQ(folder.error(R"(<bsdf type="twosided"><bsdf type="dielectric"/></bsdf>)")
                .find("scene.xml:2:1: "),
            0u);
}

TEST(Dielectric, KnowsMitsubasIndices) {
  const std::pair<const char*, double> indices[] = {
      {"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
      {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
      {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
      {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
      {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
      {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
      {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
      {"pet", 1.575},       {"diamond", 2.419}};
  SceneFolder folder;
  for (const auto& [name, eta] : indices) {
    const auto bsdf = load_bsdf(
        folder, "<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"" + std::string(name) +
                    "\"/><float name=\"ext_ior\" value=\"1\"/></bsdf>");
    EXPECT_NEAR(bsdf->eta(), eta, 1e-12) << name;
  }
  EXPECT_NE(
      folder.error(R"(<bsdf type="dielectric"><string name="int_ior" value="watr"/></bsdf>)")
          .find("2:25: no index of refraction is known for \"watr\" (did you mean \"water\"?)"),
      std::string::npos);
}

TEST(Dielectric, Defaults) {
  SceneFolder folder;
  for (const char* plugin : {"dielectric", "roughdielectric"}) {
    const std::string open = "<bsdf type=\"" + std::string(plugin) + "\">";
    EXPECT_NEAR(load_bsdf(folder, open + "</bsdf>")->eta(), 1.50418, 5e-6);
    const auto bubble = load_bsdf(folder, open + R"(<float name="int_ior" value="1.0"/>
        <float name="ext_ior" value="1.5"/></bsdf>)");
    EXPECT_NEAR(bubble->eta(), 1 / 1.5, 1e-12);
    EXPECT_EQ(bubble->n_exterior(), 1.5);
    EXPECT_NEAR(load_bsdf(folder, open + R"(<string name="int_ior" value="water"/>
        <integer name="ext_ior" value="1"/></bsdf>)")
                    ->eta(),
                1.333, 1e-12);
    EXPECT_NE(folder.error(open + R"(<float name="int_ior" value="-1"/></bsdf>)")
                  .find("greater than zero"),
              std::string::npos);
  }
  EXPECT_NE(folder
                .error(R"(<bsdf type="roughdielectric"><float name="int_ior" value="1"/>
      <float name="ext_ior" value="1"/></bsdf>)")
                .find("must differ"),
            std::string::npos);
  EXPECT_EQ(load_bsdf(folder, R"(<bsdf type="dielectric"><float name="int_ior" value="1"/>
      <float name="ext_ior" value="1"/></bsdf>)")
                ->eta(),
            1);
}

TEST(Dielectric, TintsReflectionAndTransmission) {
  SceneFolder folder;
  const auto plain = load_bsdf(folder, R"(<bsdf type="dielectric"/>)");
  const auto tinted = load_bsdf(folder, R"(<bsdf type="dielectric">
      <rgb name="specular_reflectance" value="0.5, 0.25, 1"/>
      <rgb name="specular_transmittance" value="0.125"/></bsdf>)");
  expect_equal(dirac_value(*tinted), RGB(0.5, 0.25, 1) * dirac_value(*plain));
  const Vec3 up(0, 0, 1), down(0, 0, -1);
  const RGB through = plain->f_dirac(SurfacePoint{}, up, down);
  EXPECT_GT(through.x, 0);
  expect_equal(tinted->f_dirac(SurfacePoint{}, up, down), 0.125 * through);
}

/// Fresnel reflectance of a conductor at normal incidence.
double normal_reflectance(double eta, double k) {
  return (sqr(eta - 1) + sqr(k)) / (sqr(eta + 1) + sqr(k));
}

TEST(Conductor, IsAMirrorUnlessToldOtherwise) {
  SceneFolder folder;
  const Vec3 n(0, 0, 1);
  const auto reflectance = [&](const std::string& properties) {
    return load_bsdf(folder, "<bsdf type=\"conductor\">" + properties + "</bsdf>")
        ->f_dirac(SurfacePoint{}, n, n);
  };
  const RGB mirror = reflectance("");
  expect_equal(reflectance(R"(<string name="material" value="none"/>)"), mirror);
  expect_equal(reflectance(R"(<string name="material" value="none"/>
      <rgb name="specular_reflectance" value="0.9, 0.75, 0.5"/>)"),
               RGB(0.9, 0.75, 0.5) * mirror);
  expect_equal(
      reflectance(
          R"(<rgb name="eta" value="0.2, 0.9, 1.1"/><rgb name="k" value="3.9, 2.4, 2.2"/>)"),
      mirror * RGB(normal_reflectance(0.2, 3.9), normal_reflectance(0.9, 2.4),
                   normal_reflectance(1.1, 2.2)));
  expect_equal(reflectance(R"(<float name="eta" value="0.2"/><float name="k" value="3.9"/>)"),
               mirror * normal_reflectance(0.2, 3.9));
  expect_equal(reflectance(R"(<float name="eta" value="0.2"/>)"),
               mirror * normal_reflectance(0.2, 1));
  EXPECT_NE(
      folder.error(R"(<bsdf type="conductor"><string name="material" value="Unobtainium"/></bsdf>)")
          .find("2:24: no index of refraction is known for \"Unobtainium\"; known: \"none\""),
      std::string::npos);
  EXPECT_NE(folder
                .error(R"(<bsdf type="conductor"><string name="material" value="none"/>
      <rgb name="eta" value="1"/></bsdf>)")
                .find("either \"material\", or \"eta\" and \"k\""),
            std::string::npos);
}

TEST(Rough, DefaultsAndSpellingsOfRoughness) {
  SceneFolder folder;
  for (const std::string plugin : {"roughconductor", "roughdielectric"}) {
    const auto at = [&](const std::string& properties) {
      return value(*load_bsdf(folder, "<bsdf type=\"" + plugin + "\">" + properties + "</bsdf>"));
    };
    const RGB standard = at("");
    EXPECT_GT(standard.x, 0);
    expect_equal(
        at(R"(<float name="alpha" value="0.1"/><string name="distribution" value="beckmann"/>)"),
        standard);
    expect_equal(at(R"(<float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.1"/>)"),
                 standard);
    expect_equal(at(R"(<boolean name="sample_visible" value="true"/>)"), standard);
    const RGB ggx = at(R"(<string name="distribution" value="ggx"/>)");
    EXPECT_GT(std::abs(ggx.x / standard.x - 1), 0.01);
    expect_equal(at(R"(<string name="distribution" value="GGX"/>)"), ggx);
    EXPECT_GT(std::abs(at(R"(<float name="alpha" value="0.3"/>)").x / standard.x - 1), 0.01);
    const RGB u = at(R"(<float name="alpha_u" value="0.3"/><float name="alpha_v" value="0.1"/>)");
    const RGB v = at(R"(<float name="alpha_u" value="0.1"/><float name="alpha_v" value="0.3"/>)");
    EXPECT_GT(std::abs(u.x / v.x - 1), 0.01);
    const auto error = [&](const std::string& properties) {
      return folder.error("<bsdf type=\"" + plugin + "\">" + properties + "</bsdf>");
    };
    EXPECT_NE(error(R"(<float name="alpha_u" value="0.1"/>)").find("both \"alpha_u\" and"),
              std::string::npos);
    EXPECT_NE(
        error(R"(<float name="alpha" value="1"/><float name="alpha_v" value="1"/>)").find("either"),
        std::string::npos);
    EXPECT_NE(
        error(R"(<string name="distribution" value="phong"/>)").find("\"beckmann\" or \"ggx\""),
        std::string::npos);
    EXPECT_NE(error(R"(<float name="alpha" value="0"/>)").find("greater than zero"),
              std::string::npos);
  }
}

TEST(Null, PassesLight) {
  SceneFolder folder;
  const auto bsdf = load_bsdf(folder, R"(<bsdf type="null"/>)");
  EXPECT_EQ(bsdf->passage(SurfacePoint{}, Vec3(0, 0, 1)), RGB(1));
}

/// Defaults as Mitsuba 3.9.1 prints them: polypropylene over air, diffuse 0.5, linear.
TEST(Plastics, Defaults) {
  SceneFolder folder;
  const double eta = 1.49 / 1.000277;
  expect_equal(value(*load_bsdf(folder, R"(<bsdf type="plastic"/>)")), value(*make_plastic(eta)));
  expect_equal(value(*load_bsdf(folder, R"(<bsdf type="roughplastic"/>)")),
               value(*make_rough_plastic({}, eta)));
  const auto bsdf =
      load_bsdf(folder, R"(<bsdf type="plastic"><boolean name="nonlinear" value="true"/>
      <rgb name="diffuse_reflectance" value="0.2 0.5 0.8"/><float name="int_ior" value="1.9"/>
      <rgb name="specular_reflectance" value="0.5 0.4 0.9"/><float name="ext_ior" value="1"/></bsdf>)");
  const auto expected = make_plastic(1.9, true, {0.2, 0.5, 0.8}, {0.5, 0.4, 0.9});
  expect_equal(value(*bsdf), value(*expected));
  expect_equal(dirac_value(*bsdf), dirac_value(*expected));
  const auto rough =
      load_bsdf(folder, R"(<bsdf type="roughplastic"><float name="alpha" value="0.3"/>
      <string name="distribution" value="ggx"/></bsdf>)");
  expect_equal(value(*rough), value(*make_rough_plastic({MicrofacetKind::Ggx, 0.3, 0.3}, eta)));
  EXPECT_TRUE(folder.warnings.empty());
}

TEST(Mask, DefaultsAndErrors) {
  SceneFolder folder;
  const auto half = load_bsdf(folder, R"(<bsdf type="mask"><bsdf type="diffuse"/></bsdf>)");
  expect_equal(half->passage(SurfacePoint{}, Vec3(0, 0, 1)), RGB(0.5));
  expect_equal(value(*half), RGB(0.25 * kInvPi));
  const auto board = load_bsdf(folder, R"(<bsdf type="mask"><bsdf type="diffuse"/>
      <texture type="checkerboard" name="opacity"><float name="color0" value="0"/>
      <float name="color1" value="1"/></texture></bsdf>)");
  SurfacePoint x;
  x.uv = {0.25, 0.75};
  expect_equal(board->passage(x, Vec3(0, 0, 1)), RGB(1));
  // Of a colour the mean, as Mitsuba 3.9.1 shows (0.2 for this one).
  const auto colored = load_bsdf(folder, R"(<bsdf type="mask"><bsdf type="diffuse"/>
      <rgb name="opacity" value="0.3, 0.2, 0.1"/></bsdf>)");
  expect_equal(colored->passage(SurfacePoint{}, Vec3(0, 0, 1)), RGB(0.8));
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_NE(folder.error(R"(<bsdf type="mask"/>)").find("needs a nested bsdf"), std::string::npos);
  EXPECT_NE(
      folder
          .error(
              R"(<bsdf type="mask"><bsdf type="diffuse"/><float name="opacity" value="2"/></bsdf>)")
          .find("2:41: \"opacity\" must lie between 0 and 1"),
      std::string::npos);
}

TEST(ThinDielectric, Defaults) {
  SceneFolder folder;
  const auto pane = load_bsdf(folder, R"(<bsdf type="thindielectric"/>)");
  const auto expected = make_thin_dielectric(1.5046 / 1.000277);
  expect_equal(dirac_value(*pane), dirac_value(*expected));
  expect_equal(pane->passage(SurfacePoint{}, Vec3(0.6, 0, 0.8)),
               expected->passage(SurfacePoint{}, Vec3(0.6, 0, 0.8)));
  EXPECT_EQ(pane->eta(), 1) << "nothing refracts";
}

TEST(Blend, TakesTwoAndAWeight) {
  SceneFolder folder;
  const auto blend = load_bsdf(folder, R"(<bsdf type="blendbsdf"><float name="weight" value="0.25"/>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.8"/></bsdf>
      <bsdf type="diffuse"><rgb name="reflectance" value="0.4"/></bsdf></bsdf>)");
  expect_equal(value(*blend), RGB(0.7 * kInvPi));
  const std::string one = R"(<bsdf type="diffuse"/>)";
  EXPECT_NE(folder.error("<bsdf type=\"blendbsdf\">" + one + "</bsdf>")
                .find("needs two nested bsdfs, found 1"),
            std::string::npos);
  EXPECT_NE(folder.error("<bsdf type=\"blendbsdf\">" + one + one + "</bsdf>")
                .find("needs the float or texture \"weight\""),
            std::string::npos);
}

/// Named materials: what Mitsuba 3.9.1 has for gold, and that the names end up in what they name.
TEST(Conductor, KnowsMitsubasMaterials) {
  SceneFolder folder;
  const auto gold =
      load_bsdf(folder, R"(<bsdf type="conductor"><string name="material" value="Au"/></bsdf>)");
  expect_equal(dirac_value(*gold), dirac_value(*make_conductor({0.143036, 0.3753071, 1.442045},
                                                               {3.982997, 2.385556, 1.603359})));
  for (const char* name : {"Ag", "Al", "Cu", "Cr", "W", "AlSb", "TiO2_palik"})
    EXPECT_TRUE(is_finite(dirac_value(
        *load_bsdf(folder, "<bsdf type=\"conductor\"><string name=\"material\" value=\"" +
                               std::string(name) + "\"/></bsdf>"))))
        << name;
  EXPECT_NE(folder.error(R"(<bsdf type="conductor"><string name="material" value="au"/></bsdf>)")
                .find("2:24: no index of refraction is known for \"au\""),
            std::string::npos);
}

TEST(OldBsdfs, Defaults) {
  SceneFolder folder;
  expect_equal(value(*load_bsdf(folder, R"(<bsdf type="phong"/>)")), value(*make_phong()));
  expect_equal(value(*load_bsdf(folder, R"(<bsdf type="roughdiffuse"/>)")),
               value(*make_rough_diffuse()));
}

TEST(Principled, Defaults) {
  SceneFolder folder;
  expect_equal(value(*load_bsdf(folder, R"(<bsdf type="principled"/>)")),
               value(*make_principled()));
  PrincipledSettings s;
  s.metallic = 0.3;
  s.eta = 1.4;
  expect_equal(value(*load_bsdf(folder, R"(<bsdf type="principled"><float name="eta" value="1.4"/>
      <float name="metallic" value="0.3"/></bsdf>)")),
               value(*make_principled(s)));
  EXPECT_TRUE(folder.warnings.empty());
  EXPECT_NE(folder.error(R"(<bsdf type="principled"><float name="sheen" value="1.1"/></bsdf>)")
                .find("2:25: \"sheen\" must lie between 0 and 1"),
            std::string::npos);
}

}  // namespace
}  // namespace fogbow
