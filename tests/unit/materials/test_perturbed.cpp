// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "core/geometry/accel.h"
#include "core/geometry/shapes.h"
#include "core/scene/textures.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/materials/bsdf_cases.h"

namespace fogbow {
namespace {

using testing::check_triple;
using testing::direction;
using testing::sphere_chart;

std::shared_ptr<const Texture> picture(int channels, std::vector<int> values) {
  Image image(
      3, 2,
      channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"});
  image.integers = true;
  for (std::size_t i = 0; i < values.size(); ++i)
    image.pixels[i] = static_cast<float>(values[i]) / 255;
  return make_bitmap_texture(image, {TextureFilter::Bilinear, TextureWrap::Repeat, true, {}});
}
std::shared_ptr<const Texture> normals() {
  return picture(
      3, {128, 128, 255, 200, 128, 200, 90, 60, 220, 128, 200, 200, 150, 100, 240, 60, 128, 190});
}
std::shared_ptr<const Texture> heights() { return picture(1, {0, 60, 120, 200, 90, 30}); }

std::shared_ptr<const Bsdf> nested(int which) {
  if (which == 0) return make_diffuse({0.2, 0.5, 0.8});
  return make_rough_conductor({MicrofacetKind::Ggx, 0.3, 0.3}, {0.2, 0.9, 1.1}, {3.9, 2.4, 2.2});
}

std::shared_ptr<const Bsdf> perturbed(int kind, bool flags, std::shared_ptr<const Bsdf> inside) {
  const PerturbationSettings settings{flags, flags};
  return kind == 0 ? make_normal_map(std::move(inside), normals(), settings)
                   : make_bump_map(std::move(inside), heights(), 0.7, settings);
}

std::shared_ptr<const Shape> shape(int which) {
  if (which == 0)
    return make_rectangle(Transform::rotate({0, 0, 1}, 30) * Transform::scale({2, 1, 1}));
  return make_sphere(Vec3(0), 1, false, Mat3(Transform::rotate({1, 0, 0}, 40).inverse_matrix()));
}

/// The point under (x, y, 5).
SurfacePoint point_below(const Shape& shape, const Vec2& xy) {
  const Shape* shapes[] = {&shape};
  const Accel accel(shapes);
  const auto hit = accel.intersect(Ray{Vec3(xy, 5), Vec3(0, 0, -1), 0, kInfinity});
  SurfacePoint x = shape.surface_point(hit->id.primitive, hit->local);
  x.shape = &shape;
  return x;
}

struct Row {
  int shape, kind;
  bool flags;
  int nested;
  Vec2 xy;
  Vec3 eye, light;
  RGB eval;
  double pdf;
};

/// Mitsuba 3.9.1 (scalar_rgb): eval and pdf of a normalmap (kind 0) and a bumpmap of scale 0.7,
/// with and without both flip_invalid_normals and use_shadowing_function, at the points of a
/// rectangle and a sphere below (x, y, 5); directions in the world.
TEST(PerturbedValues, AreMitsubas) {
  const Row rows[] = {
      {0,
       0,
       true,
       0,
       {-0.497221, -0.3158274},
       {-0.2970047, -0.503708, 0.811213},
       {-0.9850827, -0.1008982, 0.1393976},
       {0, 0, 0},
       0},
      {0,
       0,
       true,
       0,
       {-0.02513844, -0.4083133},
       {0.2172124, 0.6273358, 0.7478427},
       {-0.7341959, -0.5320971, 0.4216977},
       {0, 0, 0},
       0},
      {0,
       0,
       true,
       0,
       {-0.08324638, 0.1041583},
       {0.6405271, 0.1607068, 0.7509317},
       {-0.1095955, -0.9410617, 0.319987},
       {0.01178902, 0.02947254, 0.04715607},
       0.06198282},
      {0,
       0,
       true,
       0,
       {0.2354592, -0.2487351},
       {0.9368224, 0.3460082, 0.05140123},
       {-0.7526764, 0.5676822, 0.3334895},
       {0, 0, 0},
       0},
      {0,
       0,
       true,
       1,
       {0.4700533, 0.1021955},
       {0.5368288, -0.6812364, 0.4977266},
       {0.2475887, -0.9656557, 0.07879639},
       {0.008703831, 0.005630331, 0.004794484},
       0.01647176},
      {0,
       0,
       true,
       1,
       {-0.1509074, -0.4909767},
       {0.7325713, 0.06609742, 0.6774735},
       {-0.2226113, -0.9431478, 0.2468125},
       {0, 0, 0},
       0},
      {0,
       0,
       true,
       1,
       {-0.2422043, 0.290108},
       {-0.2169924, 0.6411777, 0.7360744},
       {-0.03200027, -0.5441045, 0.838407},
       {0.1355401, 0.08773467, 0.07488757},
       0.1444214},
      {0,
       0,
       true,
       1,
       {0.2193587, 0.3840909},
       {0.4843354, -0.7459545, 0.4571334},
       {0.1835912, 0.4287795, 0.8845578},
       {0.3994659, 0.2586862, 0.2210193},
       0.4242379},
      {0,
       0,
       false,
       0,
       {0.419722, -0.1272872},
       {0.1103028, 0.8556214, 0.5057126},
       {-0.4959186, 0.4949186, 0.7135268},
       {0.02776081, 0.06940203, 0.1110433},
       0.1388041},
      {0,
       0,
       false,
       0,
       {0.445367, -0.2695507},
       {-0.8072197, 0.08760214, 0.5837142},
       {-0.144601, 0.7611054, 0.6323045},
       {0.03586904, 0.0896726, 0.1434762},
       0.1793452},
      {0,
       0,
       false,
       0,
       {-0.383655, 0.2962325},
       {-0.3787021, -0.5215029, 0.7646042},
       {-0.09220038, 0.3686015, 0.9250038},
       {0.05582389, 0.1395597, 0.2232956},
       0.2791194},
      {0,
       0,
       false,
       0,
       {0.4210813, -0.3972152},
       {-0.06930333, -0.2485119, 0.9661464},
       {0.7359388, 0.2566135, 0.626533},
       {0.0615816, 0.153954, 0.2463264},
       0.307908},
      {0,
       0,
       false,
       1,
       {0.3444393, 0.347901},
       {-0.9507462, 0.2929142, 0.1014049},
       {-0.165907, 0.977441, 0.1307055},
       {0, 0, 0},
       0},
      {0,
       0,
       false,
       1,
       {-0.3433596, 0.4303703},
       {-0.718079, 0.6747802, 0.170395},
       {0.7791959, -0.3525982, 0.5181972},
       {0, 0, 0},
       0},
      {0,
       0,
       false,
       1,
       {0.5582777, 0.2497737},
       {-0.6709252, -0.6970263, 0.2530095},
       {0.4578759, 0.5205727, 0.7206621},
       {0.4026667, 0.2653402, 0.2306029},
       0.4372493},
      {0,
       0,
       false,
       1,
       {0.215861, -0.1580618},
       {0.01260047, -0.7921296, 0.6102228},
       {-0.5719862, -0.4501891, 0.6856834},
       {0.01425931, 0.009224138, 0.007855508},
       0.02019265},
      {0,
       1,
       true,
       0,
       {0.06568492, -0.3622203},
       {0.2192017, 0.8253063, 0.520404},
       {-0.6310174, -0.5874163, 0.506714},
       {0.03708839, 0.09272099, 0.1483536},
       0.1857887},
      {0,
       1,
       true,
       0,
       {0.3289258, -0.1276022},
       {-0.7653943, -0.6398952, 0.06859948},
       {0.4359022, -0.8660044, 0.2450013},
       {0.01745365, 0.04363414, 0.06981461},
       0.08749761},
      {0,
       1,
       true,
       0,
       {-0.1335633, -0.1434322},
       {-0.4011916, 0.06069873, 0.9139809},
       {-0.8393129, 0.387406, 0.3814059},
       {0.01585688, 0.03964221, 0.06342754},
       0.07961588},
      {0,
       1,
       true,
       0,
       {-0.02308132, -0.4880495},
       {0.8217735, 0.02219928, 0.5693817},
       {0.3767014, -0.7184027, 0.5848022},
       {0.04545257, 0.1136314, 0.1818103},
       0.2277956},
      {0,
       1,
       true,
       1,
       {0.5365688, 0.4105385},
       {0.5191991, -0.3970993, 0.7567987},
       {-0.2905008, 0.4777013, 0.8291023},
       {0.6969873, 0.45114, 0.3850415},
       0.7380328},
      {0,
       1,
       true,
       1,
       {-0.02164434, -0.1887399},
       {-0.5384052, -0.7880077, 0.2986029},
       {-0.2798002, -0.8932008, 0.3520003},
       {0.02113145, 0.01366944, 0.01163903},
       0.02432314},
      {0,
       1,
       true,
       1,
       {0.09889984, -0.4747212},
       {-0.8698282, 0.1490048, 0.4703153},
       {0.3282054, 0.6099101, 0.7213119},
       {0.04299178, 0.02784513, 0.02379819},
       0.04702028},
      {0,
       1,
       true,
       1,
       {-0.3972502, 0.01511695},
       {-0.009399755, -0.9006765, 0.4343886},
       {-0.1770076, 0.9135394, 0.3662158},
       {0.1330379, 0.0895456, 0.07880709},
       0.1891194},
      {0,
       1,
       false,
       0,
       {0.5182145, -0.3073242},
       {-0.6404218, 0.7442254, 0.1897065},
       {-0.3325994, 0.8662984, 0.3726994},
       {0.02303514, 0.05758784, 0.09214055},
       0.1151757},
      {0,
       1,
       false,
       0,
       {0.04357974, 0.5243206},
       {-0.9854377, 0.0106004, 0.1697065},
       {0.7137432, -0.1473089, 0.6847414},
       {0.04727812, 0.1181953, 0.1891125},
       0.2363906},
      {0,
       1,
       false,
       0,
       {0.5997636, -0.4276357},
       {0.8072177, -0.1853041, 0.5604123},
       {-0.4719847, -0.8758716, 0.1003967},
       {0.01051994, 0.02629985, 0.04207977},
       0.0525997},
      {0,
       1,
       false,
       0,
       {-0.3913064, 0.3213963},
       {-0.2452136, -0.234213, 0.9407521},
       {0.5991164, 0.7985219, 0.0585016},
       {0.01240198, 0.03100494, 0.04960791},
       0.06200988},
      {0,
       1,
       false,
       1,
       {-0.1011577, 0.4167648},
       {0.01289983, -0.9613873, 0.2748964},
       {-0.5216987, 0.7338982, 0.4349989},
       {0.06383647, 0.04251172, 0.03719435},
       0.07577119},
      {0,
       1,
       false,
       1,
       {0.2446669, -0.2300919},
       {0.5296874, -0.7461823, 0.4032904},
       {0.5721161, -0.6339178, 0.5204147},
       {0.02256524, 0.01459691, 0.01242868},
       0.02486244},
      {0,
       1,
       false,
       1,
       {0.01956064, -0.408034},
       {0.8478776, -0.2424936, 0.4714876},
       {0.7737781, 0.2388933, 0.5866835},
       {0.02255414, 0.01458977, 0.01242326},
       0.02488726},
      {0,
       1,
       false,
       1,
       {-0.5986219, -0.1915602},
       {0.07500069, -0.6205058, 0.7806072},
       {-0.01659965, -0.8123831, 0.5828878},
       {0.0455599, 0.02947162, 0.02509402},
       0.0488728},
      {1,
       0,
       true,
       0,
       {0.4517171, 0.2202617},
       {0.9883803, 0.09519811, 0.1184976},
       {0.4056156, -0.5615216, 0.7212278},
       {0.04693503, 0.1173376, 0.1877401},
       0.2347381},
      {1,
       0,
       true,
       0,
       {0.2033222, 0.13801},
       {0.7262753, -0.08699703, 0.6818768},
       {0.9904801, 0.03109938, -0.1340973},
       {0, 0, 0},
       0},
      {1,
       0,
       true,
       0,
       {0.429226, 0.1680228},
       {0.6360956, -0.5495962, 0.5415962},
       {0.5913246, 0.8064334, -0.0006000249},
       {0.02102507, 0.05256268, 0.0841003},
       0.1052005},
      {1,
       0,
       true,
       0,
       {-0.5066665, 0.4397271},
       {-0.8518143, 0.2923049, 0.4347073},
       {-0.6175765, -0.7424717, 0.2594901},
       {0.02515548, 0.0628887, 0.1006219},
       0.1364327},
      {1,
       0,
       true,
       1,
       {0.4728262, -0.1186495},
       {0.3006942, -0.9518816, 0.05919886},
       {-0.2848107, -0.3887146, 0.8762328},
       {0.0372142, 0.02408421, 0.02054776},
       0.04040449},
      {1,
       0,
       true,
       1,
       {-0.01540333, 0.1920609},
       {-0.6868899, 0.07959882, 0.7223893},
       {0.5134736, -0.06069689, 0.8559561},
       {0.6169327, 0.399359, 0.3409222},
       0.6614119},
      {1,
       0,
       true,
       1,
       {-0.07704116, 0.07483303},
       {-0.7854182, 0.5810134, 0.213405},
       {0.8885992, 0.3508997, 0.2953997},
       {0.007302272, 0.004793144, 0.004153894},
       0.0234992},
      {1,
       0,
       true,
       1,
       {-0.39835, 0.1393396},
       {-0.7167322, 0.266712, 0.6443289},
       {0.3232865, 0.9257613, 0.1960918},
       {0, 0, 0},
       0},
      {1,
       0,
       false,
       0,
       {0.4710628, -0.3596695},
       {0.9615892, 0.2545971, 0.1025989},
       {0.4904289, -0.8263487, 0.2768163},
       {0.0505419, 0.1263548, 0.2021676},
       0.2527095},
      {1,
       0,
       false,
       0,
       {0.1663423, 0.2027027},
       {0.6824933, 0.719093, 0.1307987},
       {0.4520971, 0.8106948, 0.3719976},
       {0.0342155, 0.08553874, 0.136862},
       0.1710775},
      {1,
       0,
       false,
       0,
       {0.01397403, -0.1962827},
       {-0.7647151, 0.3357066, 0.5500109},
       {-0.5975078, -0.7977104, 0.08150107},
       {0.02367833, 0.05919581, 0.0947133},
       0.1183916},
      {1,
       0,
       false,
       0,
       {-0.5854165, 0.4225757},
       {-0.5661917, 0.2985956, 0.7682887},
       {-0.277892, -0.7163795, 0.6399816},
       {0.02761152, 0.06902881, 0.1104461},
       0.1380576},
      {1,
       0,
       false,
       1,
       {0.1202309, -0.01786991},
       {-0.1168944, -0.5292745, 0.8403596},
       {0.538, -0.1863, 0.8221},
       {0.1326767, 0.08582737, 0.07309864},
       0.1407036},
      {1,
       0,
       false,
       1,
       {0.3694402, 0.3624967},
       {0.705502, 0.2027006, 0.6791019},
       {0.9409881, 0.2570967, 0.2200972},
       {0.03111735, 0.02012913, 0.01714021},
       0.03420994},
      {1,
       0,
       false,
       1,
       {-0.3716368, 0.00182604},
       {-0.6818985, 0.05979986, 0.7289983},
       {0.0947988, 0.9891875, 0.1118986},
       {0, 0, 0},
       0},
      {1,
       0,
       false,
       1,
       {-0.207874, -0.4368735},
       {-0.8443992, 0.4760996, 0.2455998},
       {-0.01980022, -0.2532028, 0.9672106},
       {0.06898009, 0.04468035, 0.03819142},
       0.07343195},
      {1,
       1,
       true,
       0,
       {-0.1397755, 0.01186436},
       {-0.1916079, 0.5505228, 0.8125337},
       {-0.08919784, -0.989776, 0.1112973},
       {0, 0, 0},
       0},
      {1,
       1,
       true,
       0,
       {0.4412458, -0.008304069},
       {0.5069864, 0.6954813, 0.5091863},
       {0.6693247, 0.6220229, 0.406315},
       {0.0236568, 0.05914199, 0.09462719},
       0.1189943},
      {1,
       1,
       true,
       0,
       {0.05477066, -0.3248069},
       {-0.9431188, 0.07870156, 0.3230065},
       {0.4943063, 0.8107103, 0.313704},
       {0.01426791, 0.03566977, 0.05707163},
       0.1083898},
      {1,
       1,
       true,
       0,
       {0.4567851, -0.3223102},
       {0.04829878, -0.9578757, -0.2830928},
       {0.4860705, -0.8585479, -0.1631901},
       {0.03538454, 0.08846133, 0.1415381},
       0.1801873},
      {1,
       1,
       true,
       1,
       {-0.087101, 0.5304293},
       {-0.9450708, 0.3112904, -0.09969692},
       {-0.9353195, 0.3057064, -0.1781037},
       {0, 0, 0},
       0},
      {1,
       1,
       true,
       1,
       {-0.2003992, 0.2725037},
       {0.9484013, -0.1207002, 0.2932004},
       {0.2782045, 0.7705125, 0.5735092},
       {0.03836326, 0.02482767, 0.02118162},
       0.04212727},
      {1,
       1,
       true,
       1,
       {0.3676427, -0.4158919},
       {0.9644002, -0.2616, -0.03870001},
       {0.4392223, 0.8399427, 0.3187162},
       {0.01618149, 0.01047785, 0.008950501},
       0.02569832},
      {1,
       1,
       true,
       1,
       {-0.1005147, -0.3047056},
       {0.3323942, 0.7616866, 0.5561903},
       {0.1931966, -0.9628832, -0.1884967},
       {0, 0, 0},
       0},
      {1,
       1,
       false,
       0,
       {-0.2352993, -0.2898098},
       {0.1239002, 0.3289005, 0.9362015},
       {-0.2957054, 0.1327024, 0.9460172},
       {0.0620555, 0.1551387, 0.248222},
       0.3102775},
      {1,
       1,
       false,
       0,
       {-0.2466532, -0.2109182},
       {0.3273925, -0.9434785, 0.05159883},
       {-0.3934916, 0.604787, 0.6923851},
       {0, 0, 0},
       0},
      {1,
       1,
       false,
       0,
       {-0.244923, -0.1869239},
       {-0.7572823, -0.212395, 0.6175856},
       {-0.6551961, -0.7346957, -0.175899},
       {0, 0, 0},
       0},
      {1,
       1,
       false,
       0,
       {0.3110502, -0.005178251},
       {0.8929011, 0.4094005, 0.1874002},
       {-0.3614983, -0.05589973, 0.9306956},
       {0.03701861, 0.09254653, 0.1480744},
       0.1850931},
      {1,
       1,
       false,
       1,
       {0.5541725, 0.5496804},
       {0.963737, -0.2539097, 0.08210315},
       {0.8793063, 0.1776013, -0.4419031},
       {0.009699135, 0.006274228, 0.005343307},
       0.01717},
      {1,
       1,
       false,
       1,
       {-0.3538224, 0.04152878},
       {0.03639979, 0.2077988, 0.9774942},
       {-0.3354928, -0.512889, 0.7901831},
       {0.8221434, 0.5318511, 0.4530571},
       0.8689135},
      {1,
       1,
       false,
       1,
       {0.4602211, -0.45217},
       {0.9648259, 0.2389064, -0.1097029},
       {-0.5867013, 0.02550006, 0.8094018},
       {0.122739, 0.0824194, 0.0724455},
       0.1489437},
      {1,
       1,
       false,
       1,
       {-0.4958446, 0.3519582},
       {-0.7530131, -0.6511113, -0.09500165},
       {-0.5871042, 0.569604, 0.5752041},
       {0.09698038, 0.06287542, 0.05382829},
       0.1028077},
  };
  int positive = 0;
  for (const Row& row : rows) {
    const auto bsdf = perturbed(row.kind, row.flags, nested(row.nested));
    const auto on = shape(row.shape);
    const SurfacePoint x = point_below(*on, row.xy);
    const Vec3 eye = x.shading.to_local(row.eye), light = x.shading.to_local(row.light);
    const RGB f = bsdf->f_s(x, light, eye) * std::fabs(light.z);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(f[i], row.eval[i], 2e-3 * row.eval[i] + 1e-5);
    EXPECT_NEAR(bsdf->pdf_sigma(x, eye, light), row.pdf, 2e-3 * row.pdf + 1e-5);
    positive += row.pdf > 0;
  }
  EXPECT_GT(positive, 40);
}

TEST(PerturbedTriples, SamplePdfAndInvert) {
  for (const int kind : {0, 1})
    for (const int which : {0, 1})
      for (const double theta : {0.2, 0.9, 1.4}) {
        const auto bsdf = perturbed(kind, true, nested(which));
        const auto on = shape(1);
        const SurfacePoint x = point_below(*on, {0.2, -0.3});
        const Vec3 from = direction(theta, 2);
        const testing::Triple triple{3,
                                     [&](const Vec3& u) -> std::optional<Vec3> {
                                       const auto s = bsdf->sample(x, from, u);
                                       if (!s) return std::nullopt;
                                       return s->w;
                                     },
                                     [&](const Vec3& to) { return bsdf->pdf_sigma(x, from, to); },
                                     [&](const Vec3& to, const Vec3& auxiliary) {
                                       return bsdf->invert(x, from, to, false, auxiliary);
                                     }};
        EXPECT_EQ(check_triple("kind " + std::to_string(kind) + " nested " + std::to_string(which) +
                                   " from " + std::to_string(theta),
                               triple, sphere_chart(), {.mass = {}}),
                  "");
      }
}

/// Seen from a point and lit along its mirror image at the tilted normal, as a tilted surface is.
TEST(Perturbed, FlatMapsChangeNothing) {
  Image flat(1, 1, {"R", "G", "B"});
  flat.pixels = {0.5f, 0.5f, 1.0f};
  const auto bsdf = make_normal_map(nested(1), make_bitmap_texture(flat));
  const auto level = make_bump_map(nested(1), picture(1, {90, 90, 90, 90, 90, 90}));
  const auto on = shape(1);
  const SurfacePoint x = point_below(*on, {0.2, -0.3});
  const Vec3 a = direction(0.7, 1), b = direction(0.6, 4);
  const RGB f = nested(1)->f_s(x, a, b);
  EXPECT_NEAR(length(bsdf->f_s(x, a, b) - f), 0, 1e-6 * f.x);
  EXPECT_NEAR(length(level->f_s(x, a, b) - f), 0, 1e-12 * f.x);
  EXPECT_EQ(bsdf->roughness(), 1) << "facets are not those of the shading normal: nothing to hold";
}

/// Nor a flat height where the shading normal leans away from the surface: it is what bumps turn.
TEST(Perturbed, LevelHeightsKeepInterpolatedNormals) {
  TriangleMeshData leaning;
  leaning.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  leaning.triangles = {{0, 1, 2}};
  leaning.normals = {{0.3, -0.2, 1}, {0.4, 0.1, 1}, {-0.1, 0.3, 1}};
  const auto level = make_bump_map(nested(1), picture(1, {90, 90, 90, 90, 90, 90}));
  const auto on = make_mesh(leaning);
  SurfacePoint x = on->surface_point(0, {0.3, 0.2});
  x.shape = on.get();
  const Vec3 a = direction(0.7, 1), b = direction(0.6, 4);
  const RGB f = nested(1)->f_s(x, a, b);
  EXPECT_NEAR(length(level->f_s(x, a, b) - f), 0, 1e-12 * f.x);
}

/// A surface that is alike on both sides looks from behind as through a reflection at the point,
/// if its normals are turned to the viewer there as well.
TEST(Perturbed, LooksAlikeFromBehind) {
  const auto bsdf = perturbed(0, true, make_twosided(nested(1)));
  const auto on = shape(0);
  int turned = 0;
  for (const Vec2 xy : {Vec2(0.2, -0.3), Vec2(-0.5, 0.1), Vec2(0.6, 0.3)}) {
    const SurfacePoint x = point_below(*on, xy);
    for (const double theta : {0.3, 0.9, 1.5})
      for (const double phi : {0.5, 2.5, 4.5}) {
        const Vec3 light = direction(0.6, phi + 2.8), eye = direction(theta, phi);
        const RGB f = bsdf->f_s(x, light, eye);
        EXPECT_EQ(bsdf->f_s(x, -light, -eye), f);
        EXPECT_EQ(bsdf->pdf_sigma(x, -eye, -light), bsdf->pdf_sigma(x, eye, light));
        turned += !is_black(f);
      }
  }
  EXPECT_GT(turned, 20);
}

/// ∂p/∂u and ∂p/∂v against differences of what the shapes say themselves.
TEST(UvTangents, AreDerivatives) {
  TriangleMeshData mesh;
  mesh.positions = {{0, 0, 0}, {2, 0.5, 0.1}, {-0.3, 1, 0.4}};
  mesh.uvs = {{0.1, 0.2}, {0.7, 0.4}, {0.3, 0.9}};
  mesh.triangles = {{0, 1, 2}};
  for (const auto& on : {shape(0), shape(1), make_mesh(mesh),
                         make_cube(Transform::rotate({1, 2, 3}, 50) * Transform::scale({1, 2, 3}))})
    for (const Vec2 local : {Vec2(0.3, 0.2), Vec2(0.1, 0.45)}) {
      const SurfacePoint x = on->surface_point(0, local);
      const auto [u, v] = on->uv_tangents(x);
      constexpr double h = 1e-6;
      for (const Vec2 step : {Vec2(h, 0), Vec2(0, h)}) {
        const SurfacePoint a = on->surface_point(0, local - step),
                           b = on->surface_point(0, local + step);
        const Vec2 duv = b.uv - a.uv;
        EXPECT_NEAR(length(u * duv.x + v * duv.y - (b.position - a.position)), 0, 1e-9);
      }
    }
}

TEST(Perturbed, RefusesWhatItCannotDo) {
  EXPECT_THROW(make_normal_map(make_plastic(1.5), normals()), std::domain_error);
  EXPECT_THROW(make_bump_map(make_dielectric(1.5), heights()), std::domain_error);
  EXPECT_THROW(make_bump_map(nullptr, heights()), std::domain_error);
  EXPECT_THROW(make_bump_map(nested(0), nullptr), std::domain_error);
  EXPECT_THROW(make_bump_map(nested(0), heights(), kInfinity), std::domain_error);
  EXPECT_NO_THROW(make_twosided(make_bump_map(nested(0), heights())));
  EXPECT_THROW(make_twosided(make_bump_map(make_rough_dielectric({}, 1.5), heights())),
               std::domain_error);
}

}  // namespace
}  // namespace fogbow
