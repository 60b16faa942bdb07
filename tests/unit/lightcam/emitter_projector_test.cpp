// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/math/random.h"
#include "core/scene/textures.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/lightcam/emitter_triples.h"

namespace fogbow {
namespace {

using testing::Chart;
using testing::check_triple;
using testing::direction_triple;

/// Half of the first row, and two more pixels.
std::shared_ptr<const Texture> picture() {
  Image image(8, 4, {"R", "G", "B"});
  for (int column = 0; column < 4; ++column)
    for (int c = 0; c < 3; ++c) image.at(column, 0, c) = static_cast<float>(1 + c);
  image.at(5, 2, 0) = 4;
  image.at(5, 2, 2) = 1;
  for (int c = 0; c < 3; ++c) image.at(7, 3, c) = 0.5f;
  BitmapSettings settings;
  settings.filter = TextureFilter::Nearest;
  return make_bitmap_texture(image, settings);
}

EmitterPoint start(const Emitter& emitter) { return *emitter.sample_position(Vec3(0.5)); }

/// Tangents of a picture that is twice as wide as high; the middle half of the chart in both.
Chart picture_chart(const Frame& frame, double tangent) {
  const Vec2 extent = 2 * tangent * Vec2(1, 0.5);
  Chart chart;
  chart.point = [=](const Vec2& c) {
    return frame.to_world(normalize(Vec3((1.0 - 2.0 * c) * extent, 1)));
  };
  chart.coordinates = [=](const Vec3& w) {
    const Vec3 v = frame.to_local(w);
    return 0.5 - 0.5 * Vec2(v) / v.z / extent;
  };
  chart.jacobian = [=](const Vec2& c) {
    return 4 * extent.x * extent.y * std::pow(frame.to_local(chart.point(c)).z, 3);
  };
  return chart;
}

TEST(ProjectorEmitter, DirectionsAreATriple) {
  const Transform to_world = Transform::translate(Vec3(1, -2, 0.5)) *
                             Transform::rotate(Vec3(1, 2, -0.5), 70) * Transform::scale(Vec3(2));
  const auto emitter = make_projector_emitter(picture(), to_world, 50);
  EXPECT_EQ(emitter->kind(), EmitterKind::Point);
  const EmitterPoint x = start(*emitter);
  EXPECT_LT(length(x.surface.position - Vec3(1, -2, 0.5)), 1e-14);
  const auto axis = [&](const Vec3& v) { return normalize(to_world.vector(v)); };
  const Frame frame(axis({1, 0, 0}), axis({0, 1, 0}), axis({0, 0, 1}));
  const Chart chart = picture_chart(frame, std::tan(25 * kPi / 180));
  EXPECT_EQ(check_triple("projector", direction_triple(*emitter, x), chart), "");
  EXPECT_EQ(emitter->pdf_direction(x, -frame.n), 0);
  EXPECT_EQ(emitter->L_e(x, -frame.n), RGB(0));
}

/// sample_direction() of Mitsuba 3.9.1 (scalar_rgb), times the squared distance: fov 60, the same
/// pixels.
TEST(ProjectorEmitter, ShinesAsMitsubas) {
  struct Value {
    double scale;
    Vec3 towards;
    RGB intensity;
  };
  const Value values[] = {{1, {0.5, 0.25, 1}, {4.72388023, 9.44776046, 14.17164069}},
                          {1, {0.55, 0.27, 1}, {5.06749633, 10.13499265, 15.20248964}},
                          {1, {0.3, 0.1, 1}, {0, 0, 0}},
                          {1, {0.6, 0, 1}, {0, 0, 0}}};
  for (const Value& v : values) {
    const auto emitter = make_projector_emitter(picture(), {}, 60, v.scale);
    const RGB ours = emitter->L_e(start(*emitter), normalize(v.towards));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(ours[c], v.intensity[c], 3e-6 * v.intensity[c]);
  }
  const Vec3 w = normalize(Vec3(0.1, 0.05, 1));
  for (const double scale : {1.0, 2.0}) {
    const auto white = make_projector_emitter(RGB(1), Transform::scale(Vec3(scale)), 60);
    EXPECT_NEAR(white->L_e(start(*white), w).x, scale * 3.20068125, 1e-5);
  }
}

/// ∫ L_e dσ, and what each sample is worth: the law follows the picture.
TEST(ProjectorEmitter, PowerIsTheIntegral) {
  const auto emitter = make_projector_emitter(picture(), {}, 60, 1.5);
  const EmitterPoint x = start(*emitter);
  const Chart chart = picture_chart(Frame(), std::tan(kPi / 6));
  RGB sum(0);
  constexpr int n = 512;  // pixels end on lines of this grid
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec2 c = (Vec2(i, j) + 0.5) / double(n);
      sum += emitter->L_e(x, chart.point(c)) * chart.jacobian(c) / double(n * n);
    }
  testing::expect_near(emitter->power(), sum, 1e-9);
  Rng rng(testing::suite_seed(), RngDomain::Test, 730, 0);
  for (int i = 0; i < 1000; ++i) {
    const EmitterDirection d = emitter->sample_direction(x, uniform2(rng));
    const double worth = luminance(emitter->L_e(x, d.w)) / d.pdf_direction;
    EXPECT_TRUE(worth == 0 || worth < 1.2 * luminance(sum)) << worth;
  }
}

TEST(ProjectorEmitter, RefusesWhatCannotBe) {
  const auto shear = Transform::scale(Vec3(1, 2, 1));
  EXPECT_THROW(make_projector_emitter(RGB(1), shear, 60), std::domain_error);
  EXPECT_THROW(make_projector_emitter(RGB(0), {}, 60), std::domain_error);
  EXPECT_THROW(make_projector_emitter(RGB(-1), {}, 60), std::domain_error);
  EXPECT_THROW(make_projector_emitter(RGB(1), {}, 180), std::domain_error);
  EXPECT_THROW(make_projector_emitter(RGB(1), {}, 60, 0), std::domain_error);
}

}  // namespace
}  // namespace fogbow
