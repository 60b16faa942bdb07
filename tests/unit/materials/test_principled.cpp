// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "tests/helpers/statistics.h"
#include "tests/unit/materials/bsdf_cases.h"
#include "tests/unit/materials/mitsuba_values.h"

namespace fogbow {
namespace {

using testing::bsdf_triple;
using testing::check_triple;
using testing::direction;
using testing::kAnyPoint;
using testing::MitsubaValue;
using testing::sphere_chart;

struct Case {
  PrincipledSettings settings;
  std::vector<MitsubaValue> values;
};

/// As in mitsuba_values.h, of Mitsuba 3.9.1's `principled`; `specular` 0.8 is η = 1.6775.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {{},
       {
           {0.618, 3.236, 0.732, 6.394, {0.1808038, 0.1808038, 0.1808038}, 0.8222602},
           {1.117, 0.306, 1.478, 6.275, {0.01951549, 0.01951549, 0.01951549}, 0.02092291},
           {0.837, 2.731, 0.857, 5.613, {0.1613848, 0.1613848, 0.1613848}, 0.6426394},
           {1.134, 4.25, 1.026, 0.382, {0.08728942, 0.08728942, 0.08728942}, 0.1271956},
           {0.955, 5.524, 0.996, 8.79, {0.2021786, 0.2021786, 0.2021786}, 0.9220966},
           {1.302, 5.477, 0.449, 0.116, {0.1529315, 0.1529315, 0.1529315}, 0.1676866},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.3},
       {
           {0.764, 3.161, 0.659, 6.243, {0.3627814, 0.4382544, 0.5137274}, 3.506669},
           {0.617, 0.936, 1.213, 4.387, {0.02469329, 0.05709133, 0.08948937}, 0.08144209},
           {1.075, 1.479, 0.965, 4.626, {0.9258567, 0.9792426, 1.032629}, 5.535231},
           {1.011, 0.091, 1.293, 5.861, {0.01774953, 0.04427008, 0.07079062}, 0.04452975},
           {1.439, 2.31, 1.406, 5.326, {0.0763766, 0.0859327, 0.09548879}, 0.1161246},
           {0.954, 4.656, 1.289, 4.235, {0.01800307, 0.04490736, 0.07181165}, 0.04511219},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.4, .metallic = 0.7},
       {
           {0.795, 1.393, 0.93, 4.475, {0.4808061, 1.111319, 1.741831}, 2.328284},
           {0.858, 5.015, 1.151, 1.218, {0.0165182, 0.03915462, 0.06179104}, 0.07250531},
           {1.136, 2.389, 1.226, 5.336, {0.1705482, 0.3180254, 0.4655028}, 0.6049493},
           {0.126, 5.08, 0.741, 0.96, {0.03125865, 0.07608935, 0.1209201}, 0.1414345},
           {0.756, 2.52, 0.629, 5.754, {0.462062, 1.09385, 1.725637}, 2.29775},
           {1.212, 0.006, 1.124, 2.639, {0.02164485, 0.04726864, 0.07289245}, 0.08690032},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.3, .anisotropic = 0.8, .metallic = 1},
       {
           {0.863, 5.801, 0.679, 8.912, {1.070362, 2.661512, 4.252663}, 5.332833},
           {0.588, 2.544, 1.37, 0.461, {0.000106682, 0.0002636519, 0.0004206219}, 0.000591812},
           {0.525, 0.878, 0.535, 4.305, {0.4888693, 1.222014, 1.955158}, 2.445305},
           {0.958, 5.428, 1.419, 1.75, {0.0006663732, 0.001444755, 0.002223137}, 0.002830462},
           {1.076, 0.017, 1.013, 3.01, {0.07124751, 0.164106, 0.2569644}, 0.324598},
           {0.462, 2.856, 1.04, 4.189, {0.0005310755, 0.001327583, 0.002124091}, 0.002672186},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.5, .sheen = 0.9, .sheen_tint = 0.6},
       {
           {0.524, 4.984, 0.418, 7.972, {0.1108786, 0.1981559, 0.2854332}, 0.7908746},
           {1.017, 4.379, 0.787, 0.036, {0.04818403, 0.1159359, 0.1836878}, 0.143299},
           {1.484, 1.342, 1.45, 4.758, {0.04793342, 0.07069586, 0.0934583}, 0.05217614},
           {0.901, 2.195, 0.47, 2.301, {0.05858951, 0.1440311, 0.2294726}, 0.1623158},
           {1.109, 4.932, 1.11, 7.854, {0.1334504, 0.1821266, 0.2308029}, 0.5400536},
           {1.187, 1.448, 0.587, 5.47, {0.0606919, 0.1408377, 0.2209834}, 0.1975144},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.5, .flatness = 0.7},
       {
           {1.012, 3.36, 1.171, 6.383, {0.1619247, 0.2062983, 0.250672}, 0.7628615},
           {1.48, 2.997, 0.984, 5.232, {0.04472518, 0.1035328, 0.1623404}, 0.1223831},
           {1.502, 3.081, 1.387, 6.24, {2.318491, 2.339318, 2.360144}, 3.133147},
           {0.946, 3.863, 1.027, 1.558, {0.04006358, 0.09352536, 0.1469871}, 0.122689},
           {0.958, 1.2, 0.719, 4.259, {0.120264, 0.1889793, 0.2576947}, 0.814274},
           {1.235, 1.642, 1.08, 0.293, {0.04071526, 0.1004045, 0.1600938}, 0.08627132},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.6, .clearcoat = 0.9, .clearcoat_gloss = 0.4},
       {
           {1.505, 5.409, 1.412, 8.954, {0.01889201, 0.02736678, 0.03584155}, 0.06106804},
           {1.336, 3.15, 0.804, 3.448, {0.05359305, 0.1305242, 0.2074554}, 0.1226096},
           {1.07, 3.067, 1.095, 6.49, {0.08208197, 0.1250198, 0.1679576}, 0.3598263},
           {1.278, 2.034, 1.335, 0.583, {0.01750222, 0.04192141, 0.0663406}, 0.04966477},
           {0.352, 1.104, 0.471, 4.093, {0.135986, 0.2210819, 0.3061778}, 0.5913548},
           {1.108, 6.161, 0.9, 5.592, {0.04293135, 0.104501, 0.1660707}, 0.1073497},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.4, .eta = 1.7, .spec_tint = 0.8},
       {
           {1.287, 5.787, 1.401, 8.907, {1.849447, 2.014387, 2.179328}, 3.592115},
           {0.656, 3.93, 1.206, 3.184, {0.02340046, 0.05837189, 0.09334333}, 0.06009222},
           {1.421, 5.168, 1.402, 8.485, {0.06580035, 0.07942403, 0.0930477}, 0.1163887},
           {1.153, 2.629, 0.483, 2.346, {0.0578596, 0.1443116, 0.2307636}, 0.1492889},
           {1.167, 1.742, 1.13, 4.802, {0.4924661, 0.6701856, 0.8479052}, 2.251051},
           {1.081, 0.979, 1.497, 5.769, {0.004625331, 0.01148362, 0.01834191}, 0.01453851},
       }},
      {{.base_color = {0.2, 0.5, 0.8}, .roughness = 0.4, .spec_trans = 0.8, .eta = 1.4},
       {
           {1.393, 5.971, 1.428, 9.208, {0.2809602, 0.2826934, 0.2844266}, 0.3926362},
           {1.503, 5.84, 1.456, 4.297, {0.001764347, 0.00372362, 0.005682892}, 0.00939673},
           {1.268, 1.563, 1.908, 4.652, {0.07088871, 0.1120849, 0.1417774}, 0.2717464},
           {0.991, 2.54, 1.798, 4.655, {0, 0, 0}, 0},
           {2.391, 5.303, 0.756, 2.087, {0.1964433, 0.3106041, 0.3928865}, 0.2817255},
           {1.949, 0.423, 0.645, 2.771, {0, 0, 0}, 0},
       }},
      {{.base_color = {0.2, 0.5, 0.8},
        .roughness = 0.4,
        .metallic = 0.2,
        .spec_trans = 1,
        .eta = 1.33},
       {
           {1.161, 3.154, 1.028, 6.556, {0.06397291, 0.100656, 0.1373391}, 0.1645917},
           {0.619, 1.988, 1.27, 5.569, {0.004772568, 0.008740357, 0.01270815}, 0.01631431},
           {1.018, 0.873, 2.236, 4.204, {0.1075761, 0.1700927, 0.2151521}, 0.4298843},
           {0.48, 3.231, 1.746, 1.567, {0, 0, 0}, 0},
           {1.949, 5.496, 1.186, 2.5, {0.09470175, 0.1497366, 0.1894035}, 0.1552682},
           {2.311, 2.345, 1.332, 1.195, {0, 0, 0}, 0},
       }},
      {{.base_color = {0.2, 0.5, 0.8},
        .roughness = 0.2,
        .anisotropic = 0.4,
        .metallic = 0.1,
        .eta = 1.67731242054,
        .spec_tint = 0.3,
        .sheen = 0.3,
        .sheen_tint = 0.2,
        .flatness = 0.2,
        .clearcoat = 0.5,
        .clearcoat_gloss = 0.1},
       {
           {1.487, 0.991, 1.45, 3.973, {0.0248354, 0.03457336, 0.04431132}, 0.03821344},
           {0.584, 0.363, 1.515, 0.382, {0.002829066, 0.007034965, 0.01124087}, 0.008865683},
           {0.362, 0.098, 0.571, 3.208, {0.1863903, 0.3307302, 0.47507}, 1.090724},
           {0.921, 6.123, 1.324, 2.3, {0.01544943, 0.03614381, 0.05683818}, 0.03946187},
           {0.937, 1.769, 0.805, 5.213, {0.05828271, 0.1237087, 0.1891348}, 0.2096516},
           {1.441, 4.187, 0.613, 3.076, {0.04320564, 0.1074505, 0.1716953}, 0.1178636},
       }},
  };
  return all;
}

/// Values alone: Mitsuba chooses its lobes after the microfacet and its pdf() says so only nearly.
TEST(Principled, EvalIsMitsubas) {
  int positive = 0;
  for (std::size_t i = 0; i < cases().size(); ++i) {
    const auto bsdf = make_principled(cases()[i].settings);
    for (const MitsubaValue& v : cases()[i].values) {
      const Vec3 eye = direction(v.theta_i, v.phi_i), light = direction(v.theta_o, v.phi_o);
      const RGB f = bsdf->f_s(kAnyPoint, light, eye) * std::fabs(light.z);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(f[c], v.eval[c], 1e-3 * v.eval[c] + 1e-7)
            << "case " << i << " at " << v.theta_i << ' ' << v.theta_o;
      positive += v.eval.x > 0;
    }
  }
  EXPECT_GT(positive, 50);
}

/// Where all is transmitted and nothing tinted it is rough glass, also for light that comes from
/// inside and stays there.
TEST(Principled, ClearGlassIsARoughDielectric) {
  const double roughness = 0.6;
  for (const double eta : {1.5, 0.7}) {
    const auto clear = make_principled(
        {.base_color = RGB(1), .roughness = roughness, .spec_trans = 1.0, .eta = eta});
    const auto glass =
        make_rough_dielectric({MicrofacetKind::Ggx, sqr(roughness), sqr(roughness)}, eta);
    for (const double a : {0.3, 1.2, 2.0, 2.8})
      for (const double b : {0.5, 1.4, 1.9, 2.5}) {
        const Vec3 light = direction(a, 1), eye = direction(b, 3.5);
        const RGB expected = glass->f_s(kAnyPoint, light, eye);
        EXPECT_NEAR(length(clear->f_s(kAnyPoint, light, eye) - expected), 0, 1e-10 * expected.x)
            << eta << ' ' << a << ' ' << b;
      }
  }
}

TEST(Principled, SamplePdfAndInvert) {
  for (std::size_t i = 0; i < cases().size(); ++i) {
    const auto bsdf = make_principled(cases()[i].settings);
    for (const double theta : {0.2, 1.3, 2.0, 2.8}) {
      if (theta > 1.6 && bsdf->eta() == 1) continue;
      EXPECT_EQ(
          check_triple("case " + std::to_string(i) + " from " + std::to_string(theta),
                       bsdf_triple(bsdf, direction(theta, 0.8)), sphere_chart(), {.mass = {}}),
          "");
    }
  }
}

TEST(Principled, Reciprocity) {
  std::mt19937_64 engine(testing::suite_seed());
  const auto uniform = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  const auto any = [&] { return direction(std::acos(1 - 2 * uniform()), 2 * kPi * uniform()); };
  for (const Case& c : cases()) {
    const auto bsdf = make_principled(c.settings);
    const auto index = [&](const Vec3& w) { return w.z > 0 ? 1.0 : bsdf->eta(); };
    int positive = 0;
    for (int i = 0; i < 5000; ++i) {
      const Vec3 a = any(), b = any();
      const RGB there = bsdf->f_s(kAnyPoint, a, b) / sqr(index(b));
      const RGB back = bsdf->f_s(kAnyPoint, b, a) / sqr(index(a));
      EXPECT_LE(length(there - back), 1e-9 * length(there) + 1e-300);
      positive += there.y > 0;
    }
    EXPECT_GT(positive, 500);
  }
}

/// Without sheen; whatever is transmitted counts with the (n_light/n_eye)² of radiance taken back.
TEST(Principled, HardlyGainsEnergy) {
  for (const Case& c : cases()) {
    PrincipledSettings s = c.settings;
    s.base_color = RGB(1);
    s.sheen = 0.0;
    const auto bsdf = make_principled(s);
    for (const double theta : {0.1, 0.9}) {
      const Vec3 eye = direction(theta, 0.4);
      double sum = 0;
      constexpr int kRows = 400, kColumns = 200;
      for (int i = 0; i < 2 * kRows; ++i)
        for (int j = 0; j < kColumns; ++j) {
          const double z = (i + 0.5) / kRows - 1;
          const Vec3 light = direction(std::acos(z), 2 * kPi * (j + 0.5) / kColumns);
          const double n2 = z > 0 ? 1.0 : sqr(bsdf->eta());
          sum += bsdf->f_s(kAnyPoint, light, eye).x * std::fabs(z) * n2 *
                 (2 * kPi / (kRows * kColumns));
        }
      // Diffuse and interface are added, not layered: up to the interface's reflectance too much.
      EXPECT_LE(sum, 1.15) << theta;
      EXPECT_GT(sum, 0.5) << theta;
    }
  }
}

TEST(Principled, RefusesWhatMakesNoSense) {
  EXPECT_THROW(make_principled({.roughness = 1.5}), std::domain_error);
  EXPECT_THROW(make_principled({.base_color = RGB(2)}), std::domain_error);
  EXPECT_THROW(make_principled({.eta = 1}), std::domain_error);
  EXPECT_NO_THROW(make_twosided(make_principled()));
  EXPECT_THROW(make_twosided(make_principled({.spec_trans = 0.5})), std::domain_error);
}

}  // namespace
}  // namespace fogbow
