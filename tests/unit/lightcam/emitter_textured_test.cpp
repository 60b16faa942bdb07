// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "core/geometry/shapes.h"
#include "core/math/random.h"
#include "core/scene/textures.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/lightcam/emitter_triples.h"

namespace fogbow {
namespace {

using testing::Chart;
using testing::check_triple;

/// Black but for a corner and a bright spot.
std::shared_ptr<const Texture> picture() {
  Image image(8, 4, {"R", "G", "B"});
  for (int column = 4; column < 8; ++column)
    for (int c = 0; c < 3; ++c) image.at(column, 0, c) = 0.5f * static_cast<float>(1 + c);
  image.at(1, 2, 0) = 20;
  BitmapSettings settings;
  settings.wrap = TextureWrap::Clamp;
  return make_bitmap_texture(image, settings);
}

/// Over the shape by its uniform samples, which have tests of their own.
RGB mean_radiance(const Shape& shape, const Texture& texture) {
  constexpr int n = 400;
  RGB sum(0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) sum += texture.color(shape.sample((Vec2(i, j) + 0.5) / double(n)));
  return sum / double(n * n);
}

testing::Triple position_triple(const Emitter& emitter,
                                std::function<EmitterPoint(const Vec3&)> make_point) {
  return {2,
          [&emitter](const Vec3& u) -> std::optional<Vec3> {
            const auto x = emitter.sample_position(u);
            EXPECT_NEAR(x->pdf_position, emitter.pdf_position(*x), 1e-12 * x->pdf_position);
            return x->surface.position;
          },
          [&emitter, make_point](const Vec3& p) { return emitter.pdf_position(make_point(p)); },
          [&emitter, make_point](const Vec3& p, const Vec3& auxiliary) {
            return emitter.invert_position(make_point(p), auxiliary);
          }};
}

/// Of a shape over the plane z = 0, found by looking down.
EmitterPoint below(const Shape& shape, const Vec3& p) {
  EmitterPoint x;
  for (std::uint32_t i = 0; i < shape.primitive_count(); ++i)
    if (const auto hit = shape.intersect(i, {p + Vec3(0, 0, 1), Vec3(0, 0, -1)}, false)) {
      x.surface = shape.surface_point(i, hit->local);
      return x;
    }
  ADD_FAILURE() << "off the shape";
  return x;
}

/// Two triangles of different size with texture coordinates of their own.
std::shared_ptr<const Shape> patch() {
  TriangleMeshData data;
  data.positions = {{0, 0, 0}, {3, 0, 0}, {1, 1, 0}, {3, 1, 0}, {0, 1, 0}};
  data.triangles = {{0, 1, 2}, {1, 3, 2}, {0, 2, 4}};
  data.uvs = {{0, 0}, {1, 0}, {0.2, 0.9}, {1, 1}, {0, 1}};
  return make_mesh(data);
}

TEST(TexturedAreaEmitter, PositionsAreATriple) {
  const auto shape =
      make_rectangle(Transform::translate(Vec3(1.5, 0.5, 0)) * Transform::scale(Vec3(1.5, 0.5, 1)));
  const auto emitter = make_area_emitter(shape, picture());
  const Chart chart = testing::box_chart(Vec2(0), Vec2(3, 1));
  const auto make_point = [&](const Vec3& p) { return below(*shape, p); };
  EXPECT_EQ(check_triple("textured lamp", position_triple(*emitter, make_point), chart), "");
}

/// Mass and counts of samples in strips, where cells of the density are no rectangles.
TEST(TexturedAreaEmitter, PositionsOnAMeshFollowTheirDensity) {
  const auto shape = patch();
  const auto emitter = make_area_emitter(shape, picture());
  constexpr int kStrips = 12, n = 1024, kSamples = 200000;
  const auto strip = [&](const Vec3& p) { return static_cast<int>(p.x / 3 * kStrips); };
  std::array<double, kStrips> expected{}, counted{};
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      EmitterPoint x;
      x.surface = shape->sample((Vec2(i, j) + 0.5) / double(n));
      expected.at(static_cast<std::size_t>(strip(x.surface.position))) +=
          emitter->pdf_position(x) * 3 / (double(n) * n);
    }
  Rng rng(testing::suite_seed(), RngDomain::Test, 721, 0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 u(uniform2(rng), rng.uniform());
    const auto x = emitter->sample_position(u);
    ASSERT_NEAR(x->pdf_position, emitter->pdf_position(*x), 1e-12 * x->pdf_position);
    counted.at(static_cast<std::size_t>(strip(x->surface.position))) += 1.0 / kSamples;
    const auto v = emitter->invert_position(below(*shape, x->surface.position), u);
    ASSERT_TRUE(v);
    ASSERT_LT(length(*v - u), 1e-6);
  }
  double mass = 0;
  for (int s = 0; s < kStrips; ++s) {
    const double p = expected.at(static_cast<std::size_t>(s));
    mass += p;
    EXPECT_NEAR(counted.at(static_cast<std::size_t>(s)), p, 5 * std::sqrt(p / kSamples) + 1e-3 * p);
  }
  EXPECT_NEAR(mass, 1, 1e-6);
}

TEST(TexturedAreaEmitter, BrightPlacesAreLikely) {
  const auto shape = make_rectangle(Transform());
  const auto texture = picture();
  const auto emitter = make_area_emitter(shape, texture);
  const double mean = luminance(mean_radiance(*shape, *texture));
  Rng rng(testing::suite_seed(), RngDomain::Test, 720, 0);
  double sum = 0, squares = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const Vec2 u = uniform2(rng);
    const auto x = emitter->sample_position(Vec3(u, 0));
    ASSERT_TRUE(x);
    EXPECT_EQ(x->surface.shape, shape.get());
    const double ratio = luminance(emitter->L_e(*x, Vec3(0, 0, 1))) / x->pdf_position / 4 / mean;
    sum += ratio;
    squares += sqr(ratio);
  }
  EXPECT_NEAR(sum / n, 1, 0.02);
  // Uniform sampling has 9: a corner of an eighth and a spot.
  EXPECT_LT(squares / n - sqr(sum / n), 0.3);
}

TEST(TexturedAreaEmitter, ShinesAsItsTextureSays) {
  const auto shape = patch();
  const auto texture = picture();
  const auto emitter = make_area_emitter(shape, texture);
  const SurfacePoint x = shape->sample(Vec2(0.3, 0.4));
  EXPECT_EQ(emitter->L_e({x, {}, 0}, x.n_g), texture->color(x));
  EXPECT_EQ(emitter->L_e({x, {}, 0}, -x.n_g), RGB(0));
  testing::expect_near(emitter->power(), kPi * 3 * mean_radiance(*shape, *texture), 2e-3);
  // One value is no texture.
  EXPECT_EQ(make_area_emitter(shape, RGB(2, 1, 0))->pdf_position({x, {}, 0}), 1.0 / 3);
}

TEST(TexturedAreaEmitter, RefusesWhatCannotShine) {
  const auto board = [](double a, double b) {
    return make_checkerboard_texture(RGB(a), RGB(b), Transform());
  };
  const auto shape = make_rectangle(Transform());
  EXPECT_THROW(make_area_emitter(shape, board(0, 0)), std::domain_error);
  EXPECT_THROW(make_area_emitter(shape, board(-1, 2)), std::domain_error);
  EXPECT_THROW(make_area_emitter(shape, board(1, kInfinity)), std::domain_error);
  EXPECT_NO_THROW(make_area_emitter(shape, board(0, 1)));
}

/// u in red, v in green.
std::shared_ptr<const Texture> coordinates() {
  constexpr int n = 256;
  Image image(n, n, {"R", "G", "B"});
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      image.at(x, y, 0) = (static_cast<float>(x) + 0.5f) / n;
      image.at(x, y, 1) = (static_cast<float>(y) + 0.5f) / n;
      image.at(x, y, 2) = 1;
    }
  return make_bitmap_texture(image, BitmapSettings{});
}

/// sample_direction of Mitsuba 3.9.1, cutoff 35 degrees and beam width 20, at distance 1.
TEST(SpotEmitter, ShinesThroughASlideAsMitsubas) {
  const struct {
    Vec3 w;
    RGB value;
  } values[] = {
      {Vec3(0.58274639, 0.61958504, 0.52585286), RGB(2.92161, 2.1612, 4)},
      {Vec3(0.51634198, -0.031175729, 0.85581493), RGB(0.482416, 1.13891, 2.70242)},
      {Vec3(0.7271437, 0.30814448, 0.61344039), RGB(2.13129, 1.46687, 4)},
      {Vec3(0.4992941, 0.26189557, 0.8259033), RGB(1.51744, 2.14515, 4)},
      {Vec3(0.53426868, 0.34382328, 0.77223229), RGB(1.81874, 2.12635, 4)},
      {Vec3(0.48771882, 0.42117313, 0.76468533), RGB(1.97401, 2.33524, 4)},
  };
  const Transform to_world = Transform::translate({1, 2, 3}) * Transform::rotate({0, 0.6, 0.8}, 77);
  const auto emitter = make_spot_emitter(to_world, RGB(4), 35, 20, coordinates());
  const auto x = *emitter->sample_position(Vec3(0.5));
  for (const auto& v : values)
    EXPECT_NEAR(length(emitter->L_e(x, normalize(v.w)) - v.value), 0, 1e-4) << v.value.x;
  EXPECT_EQ(luminance(emitter->L_e(x, -normalize(values[0].w))), 0);
  // A mirror image of the light throws the mirror image of its slide.
  const Transform mirror = Transform::scale({1, -1, 1});
  const auto mirrored = make_spot_emitter(mirror * to_world, RGB(4), 35, 20, coordinates());
  for (const auto& v : values)
    EXPECT_NEAR(length(mirrored->L_e(x, mirror.vector(normalize(v.w))) - v.value), 0, 1e-4);
  EXPECT_THROW(make_spot_emitter(to_world, RGB(4), 35, 20, RGB(-1)), std::domain_error);
}

}  // namespace
}  // namespace fogbow
