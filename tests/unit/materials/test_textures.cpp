// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/textures.h"

namespace fogbow {
namespace {

SurfacePoint at(const Vec2& uv) {
  SurfacePoint x;
  x.uv = uv;
  return x;
}

/// An 8-bit picture of 4 × 2 pixels, as read_image gives it.
Image picture() {
  Image image(4, 2, {"R", "G", "B"});
  image.integers = true;
  const int values[2][4][3] = {{{0, 0, 0}, {50, 0, 0}, {100, 0, 0}, {200, 0, 10}},
                               {{0, 60, 0}, {0, 120, 0}, {30, 180, 0}, {0, 255, 0}}};
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < 4; ++column)
      for (int c = 0; c < 3; ++c)
        image.at(column, row, c) = static_cast<float>(values[row][column][c]) / 255;
  return image;
}

const BitmapSettings kRaw{TextureFilter::Bilinear, TextureWrap::Repeat, true, {}};
const Transform kToUv = Transform::translate({0.25, 0.1, 0}) * Transform::rotate({0, 0, 1}, 30) *
                        Transform::scale({2, -3, 1});

struct Lookup {
  TextureFilter filter;
  TextureWrap wrap;
  bool raw;
  Transform to_uv;
  Vec2 uv;
  RGB color;
  double number;
  Vec2 gradient;
};

/// Mitsuba 3.9.1 (scalar_rgb): eval, eval_1 and eval_1_grad of a `bitmap` with these parameters and
/// this picture as PNG, at random texture coordinates.
const std::vector<Lookup>& mitsuba_lookups() {
  static const std::vector<Lookup> lookups{
      {TextureFilter::Bilinear,
       TextureWrap::Repeat,
       true,
       Transform(),
       {0.547, 2.302},
       {0.3049763, 0.065777, 0},
       0.1119007,
       {0.2298635, 0.7982832}},
      {TextureFilter::Bilinear,
       TextureWrap::Repeat,
       true,
       Transform(),
       {-0.923, 2.295},
       {0.1370352, 0.03439064, 0.006851761},
       0.05423271,
       {-0.8143362, 0.4814122}},
      {TextureFilter::Bilinear,
       TextureWrap::Repeat,
       true,
       kToUv,
       {-0.253, 0.193},
       {0.06016332, 0.05883659, 0.003008166},
       0.05508967,
       {-0.8586279, -1.785498}},
      {TextureFilter::Bilinear,
       TextureWrap::Repeat,
       false,
       Transform(),
       {1.811, 0.137},
       {0.3586055, 0.1945501, 0.001747878},
       0.2155256,
       {0.6460022, -1.035712}},
      {TextureFilter::Bilinear,
       TextureWrap::Repeat,
       false,
       Transform(),
       {0.698, -1.39},
       {0.07910451, 0.4429002, 0.0002481637},
       0.3335856,
       {1.219122, 0.7735153}},
      {TextureFilter::Bilinear,
       TextureWrap::Repeat,
       false,
       kToUv,
       {1.514, 0.653},
       {0.1802643, 0.631573, 0.0009223164},
       0.4900793,
       {-0.2596413, 3.803528}},
      {TextureFilter::Bilinear,
       TextureWrap::Mirror,
       true,
       Transform(),
       {-0.181, 1.654},
       {0.03548863, 0.05529598, 0},
       0.04709287,
       {-0.2640086, -0.3932505}},
      {TextureFilter::Bilinear,
       TextureWrap::Mirror,
       true,
       Transform(),
       {-0.287, 0.314},
       {0.1107953, 0.04963389, 0},
       0.05905912,
       {-0.2316061, 0.5005842}},
      {TextureFilter::Bilinear,
       TextureWrap::Mirror,
       true,
       kToUv,
       {-0.964, 0.112},
       {0.0596221, 0.8509448, 0},
       0.6212415,
       {1.283942, 0.5559631}},
      {TextureFilter::Bilinear,
       TextureWrap::Mirror,
       false,
       Transform(),
       {-0.686, -0.451},
       {0.1458348, 0.2367968, 0.0004428823},
       0.2003944,
       {-0.8501907, -0.7456713}},
      {TextureFilter::Bilinear,
       TextureWrap::Mirror,
       false,
       Transform(),
       {1.501, -0.378},
       {0.06063635, 0.08218665, 0},
       0.07167219,
       {-0.2599918, -0.4282081}},
      {TextureFilter::Bilinear,
       TextureWrap::Mirror,
       false,
       kToUv,
       {0.441, 2.423},
       {0.1694532, 0, 0.0002833061},
       0.03605823,
       {0.6647708, 0.2878542}},
      {TextureFilter::Bilinear,
       TextureWrap::Clamp,
       true,
       Transform(),
       {2.347, 1.399},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Bilinear,
       TextureWrap::Clamp,
       true,
       Transform(),
       {0.665, -0.392},
       {0.4549021, 0, 0.006274513},
       0.09719729,
       {0.3449222, 0}},
      {TextureFilter::Bilinear,
       TextureWrap::Clamp,
       true,
       kToUv,
       {-0.857, 2.38},
       {0.7843138, 0, 0.03921569},
       0.169631,
       {0, 0}},
      {TextureFilter::Bilinear,
       TextureWrap::Clamp,
       false,
       Transform(),
       {0.564, -1.037},
       {0.1041256, 0, 0},
       0.02214449,
       {0.08127586, 0}},
      {TextureFilter::Bilinear,
       TextureWrap::Clamp,
       false,
       Transform(),
       {0.994, 1.607},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Bilinear,
       TextureWrap::Clamp,
       false,
       kToUv,
       {0.952, 2.169},
       {0.5775807, 0, 0.00303527},
       0.1230537,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Repeat,
       true,
       Transform(),
       {-1.342, 0.614},
       {0.1176471, 0.7058824, 0},
       0.529839,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Repeat,
       true,
       Transform(),
       {0.337, -1.251},
       {0, 0.4705883, 0},
       0.3365459,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Repeat,
       true,
       kToUv,
       {1.065, 1.911},
       {0.7843138, 0, 0.03921569},
       0.169631,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Repeat,
       false,
       Transform(),
       {0.872, -0.46},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Repeat,
       false,
       Transform(),
       {1.86, 0.538},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Repeat,
       false,
       kToUv,
       {0.544, 1.512},
       {0, 0.1878208, 0},
       0.1343219,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Mirror,
       true,
       Transform(),
       {-0.908, 1.779},
       {0.7843138, 0, 0.03921569},
       0.169631,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Mirror,
       true,
       Transform(),
       {1.233, 1.648},
       {0.7843138, 0, 0.03921569},
       0.169631,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Mirror,
       true,
       kToUv,
       {-0.734, 1.709},
       {0, 0.4705883, 0},
       0.3365459,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Mirror,
       false,
       Transform(),
       {-0.735, -1.174},
       {0.01298306, 0.4564111, 0},
       0.3291681,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Mirror,
       false,
       Transform(),
       {1.921, 1.945},
       {0, 0, 0},
       0,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Mirror,
       false,
       kToUv,
       {2.006, 0.388},
       {0, 0.1878208, 0},
       0.1343219,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Clamp,
       true,
       Transform(),
       {-0.404, -1.472},
       {0, 0, 0},
       0,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Clamp,
       true,
       Transform(),
       {1.083, 1.38},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Clamp,
       true,
       kToUv,
       {1.842, -0.372},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Clamp,
       false,
       Transform(),
       {-0.639, 1.057},
       {0, 0.04518617, 0},
       0.03231534,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Clamp,
       false,
       Transform(),
       {1.72, 2.355},
       {0, 1, 0},
       0.71516,
       {0, 0}},
      {TextureFilter::Nearest,
       TextureWrap::Clamp,
       false,
       kToUv,
       {-0.898, 0.429},
       {0, 0, 0},
       0,
       {0, 0}},
  };
  return lookups;
}

TEST(BitmapTexture, LooksUpWhatMitsubaDoes) {
  for (const Lookup& l : mitsuba_lookups()) {
    const auto texture = make_bitmap_texture(picture(), {l.filter, l.wrap, l.raw, l.to_uv});
    const SurfacePoint x = at(l.uv);
    constexpr double kSingle = 2e-5;
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(texture->color(x)[i], l.color[i], kSingle);
    EXPECT_NEAR(texture->number(x), l.number, kSingle);
  }
}

/// Mitsuba's eval_1_grad where there is no to_uv: with one it leaves out a factor of the chain rule
/// where axes are mixed; the derivative of number() itself decides.
TEST(BitmapTexture, GradientIsTheDerivative) {
  for (const Lookup& l : mitsuba_lookups()) {
    const auto texture = make_bitmap_texture(picture(), {l.filter, l.wrap, l.raw, l.to_uv});
    const Vec2 gradient = texture->gradient(at(l.uv));
    constexpr double h = 1e-6;
    for (int i = 0; i < 2; ++i) {
      Vec2 step(0);
      step[i] = h;
      const double difference = texture->number(at(l.uv + step)) - texture->number(at(l.uv - step));
      EXPECT_NEAR(gradient[i], difference / (2 * h), 1e-5);
      if (l.to_uv.matrix() == Mat4(1.0)) {
        EXPECT_NEAR(gradient[i], l.gradient[i], 1e-4);
      }
    }
  }
}

TEST(BitmapTexture, RangeAndMean) {
  const auto raw = make_bitmap_texture(picture(), kRaw);
  EXPECT_EQ(raw->range().least, 0);
  EXPECT_EQ(raw->range().greatest, 1);
  EXPECT_NEAR(raw->mean().y, (60 + 120 + 180 + 255) / (8 * 255.0), 1e-7);
  const auto linear = make_bitmap_texture(picture());
  EXPECT_NEAR(luminance(linear->mean()), 0.17098810, 1e-6) << "Mitsuba's mean()";
}

TEST(BitmapTexture, TakesOneChannelAsGrey) {
  Image image(2, 2, {"Y"});
  image.integers = true;
  image.pixels = {0, 64 / 255.0f, 128 / 255.0f, 1};
  const auto raw = make_bitmap_texture(image, kRaw), linear = make_bitmap_texture(image);
  EXPECT_NEAR(raw->number(at({0.7, 0.3})), 0.29831374, 1e-6) << "Mitsuba";
  EXPECT_NEAR(linear->number(at({0.7, 0.3})), 0.13368687, 1e-6);
  EXPECT_EQ(raw->color(at({0.7, 0.3})), RGB(raw->number(at({0.7, 0.3}))));
  EXPECT_NEAR(linear->gradient(at({0.7, 0.3})).y, 1.75089, 1e-5);
  // Floating-point files are linear already.
  image.integers = false;
  EXPECT_EQ(make_bitmap_texture(image)->number(at({0.25, 0.75})), 128 / 255.0f);
}

TEST(BitmapTexture, FindsChannelsByName) {
  Image image(1, 1, {"A", "B", "G", "R"});
  image.pixels = {0.5f, 3, 2, 1};
  EXPECT_EQ(make_bitmap_texture(image)->color(at({0, 0})), RGB(1, 2, 3));
}

TEST(BitmapTexture, SurvivesAnyCoordinates) {
  for (const TextureWrap wrap : {TextureWrap::Repeat, TextureWrap::Mirror, TextureWrap::Clamp})
    for (const TextureFilter filter : {TextureFilter::Bilinear, TextureFilter::Nearest})
      for (const double u : {1e300, -1e300, 1e17, kInfinity, std::nan("")}) {
        const auto texture = make_bitmap_texture(picture(), {filter, wrap, true, {}});
        texture->color(at({u, 0.5}));
        texture->color(at({0.5, u}));
      }
}

TEST(BitmapTexture, RefusesWhatIsNoPicture) {
  EXPECT_THROW(make_bitmap_texture(Image()), std::domain_error);
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Image image(2, 2, {"R", "G", "B"});
    image.pixels[7] = bad;
    EXPECT_THROW(make_bitmap_texture(image), std::domain_error);
  }
}

TEST(CheckerboardTexture, IsMitsubas) {
  const RGB a(0.1, 0.2, 0.3), b(0.9, 0.8, 0.7);
  const auto plain = make_checkerboard_texture(a, b);
  const std::pair<Vec2, bool> cells[] = {
      {{0.2, 0.2}, true}, {{0.7, 0.2}, false},  {{0.2, 0.7}, false}, {{0.7, 0.7}, true},
      {{0.5, 0.5}, true}, {{-0.2, 0.2}, false}, {{1.2, 0.2}, true}};
  for (const auto& [uv, first] : cells) {
    EXPECT_EQ(plain->color(at(uv)), first ? a : b);
    // eval_1 of Mitsuba 3.9.1 exchanges the two.
    EXPECT_EQ(plain->number(at(uv)), luminance(first ? b : a));
  }
  const auto scaled = make_checkerboard_texture(a, b, Transform::scale({4, 2, 1}));
  EXPECT_EQ(scaled->color(at({0.05, 0.2})), a);
  EXPECT_EQ(scaled->color(at({0.15, 0.2})), b);
  EXPECT_EQ(scaled->color(at({0.05, 0.3})), b);
  EXPECT_EQ(plain->range().least, 0.1);
  EXPECT_EQ(plain->range().greatest, 0.9);
  EXPECT_EQ(plain->mean(), 0.5 * (a + b));
}

// --- In BSDFs

TEST(TexturedBsdf, HasTheValueOfThePoint) {
  const auto texture = make_bitmap_texture(picture(), kRaw);
  const auto diffuse = make_diffuse(texture);
  const Vec3 w(0.6, 0, 0.8);
  for (const Vec2 uv : {Vec2(0.3, 0.6), Vec2(0.9, 0.1)}) {
    EXPECT_EQ(diffuse->f_s(at(uv), w, w), texture->color(at(uv)) * kInvPi);
    EXPECT_EQ(diffuse->albedo(at(uv)), texture->color(at(uv)));
    const double alpha = 0.1 + texture->number(at(uv));
    Image grey(1, 1, {"Y"});
    grey.pixels = {static_cast<float>(alpha)};
    const Textured<double> rough(make_bitmap_texture(grey));
    const auto smooth = make_rough_conductor({MicrofacetKind::Ggx, rough, rough}, RGB(0), RGB(1));
    const auto constant =
        make_rough_conductor({MicrofacetKind::Ggx, grey.pixels[0], grey.pixels[0]}, RGB(0), RGB(1));
    EXPECT_EQ(smooth->f_s(at(uv), w, w), constant->f_s(at(uv), w, w));
    EXPECT_EQ(smooth->roughness(), constant->roughness());
  }
}

/// One of two roughnesses that are the same on average, and what only the mirror of a coat has.
TEST(TexturedBsdf, HasTheValueOfThePointInOnePlaceAlone) {
  const RGB dark(0.1), bright(0.5);
  const auto board = make_checkerboard_texture(dark, bright, Transform());
  const Vec3 light(0.6, 0, 0.8), eye(0, 0.28, 0.96);
  for (const Vec2 uv : {Vec2(0.2, 0.3), Vec2(0.7, 0.3)}) {
    const double here = board->number(at(uv));
    const auto metal = [&](const Textured<double>& u, const Textured<double>& v) {
      return make_rough_conductor({MicrofacetKind::Ggx, u, v}, RGB(0), RGB(1))
          ->f_s(at(uv), light, eye);
    };
    const Textured<double> varying(board);
    const double average = varying.mean();
    EXPECT_EQ(metal(varying, average), metal(here, average));
    EXPECT_EQ(metal(average, varying), metal(average, here));
    EXPECT_NE(metal(average, varying), metal(average, average));
    const RGB tint = board->color(at(uv));
    const Vec3 mirror(-light.x, -light.y, light.z);
    EXPECT_EQ(
        make_plastic(1.5, false, RGB(0.5), Textured<RGB>(board))->f_dirac(at(uv), light, mirror),
        make_plastic(1.5, false, RGB(0.5), tint)->f_dirac(at(uv), light, mirror));
  }
}

TEST(TexturedBsdf, RefusesMoreThanAllLight) {
  Image bright(1, 1, {"R", "G", "B"});
  bright.pixels = {0.5f, 1.5f, 0};
  EXPECT_THROW(make_diffuse(make_bitmap_texture(bright)), std::domain_error);
  bright.pixels = {0.5f, -0.5f, 0};
  EXPECT_THROW(make_diffuse(make_bitmap_texture(bright)), std::domain_error);
  const Textured<double> negative(make_bitmap_texture(bright));
  EXPECT_THROW(make_rough_dielectric({MicrofacetKind::Ggx, negative, negative}, 1.5),
               std::domain_error);
}

}  // namespace
}  // namespace fogbow
