// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/geometry/shapes.h"
#include "core/math/random.h"
#include "core/scene/emitters.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/lightcam/emitter_triples.h"

namespace fogbow {
namespace {

using testing::Chart;
using testing::check_triple;
using testing::direction_triple;
using testing::oblique_frame;
using testing::Triple;

const RGB kRadiance(3, 0.5, 0);

/// Positions of an emitter whose EmitterPoint `make_point` rebuilds from one Vec3 (`seen` extracts
/// it).
Triple position_triple(const Emitter& emitter, std::function<Vec3(const EmitterPoint&)> seen,
                       std::function<EmitterPoint(const Vec3&)> make_point) {
  return {2,
          [&emitter, seen](const Vec3& u) -> std::optional<Vec3> {
            const auto x = emitter.sample_position(u);
            if (!x) return std::nullopt;
            EXPECT_NEAR(x->pdf_position, emitter.pdf_position(*x), 1e-12 * x->pdf_position);
            return seen(*x);
          },
          [&emitter, make_point](const Vec3& p) { return emitter.pdf_position(make_point(p)); },
          [&emitter, make_point](const Vec3& p, const Vec3& auxiliary) {
            return emitter.invert_position(make_point(p), auxiliary);
          }};
}

Vec3 position_of(const EmitterPoint& x) { return x.surface.position; }

TEST(AreaEmitter, PositionsOnARectangleAreATriple) {
  const Transform to_world = Transform::translate(Vec3(3, -1, 2)) *
                             Transform::rotate(Vec3(1, 2, -0.5), 40) *
                             Transform::scale(Vec3(2, 0.3, 1));
  const auto shape = make_rectangle(to_world);
  const auto emitter = make_area_emitter(shape, kRadiance);
  Chart chart;
  chart.point = [&](const Vec2& c) { return to_world.point(Vec3(2.0 * c - 1.0, 0)); };
  chart.coordinates = [&](const Vec3& p) {
    return 0.5 * (Vec2(to_world.inverse().point(p)) + 1.0);
  };
  chart.jacobian = [](const Vec2&) { return 4 * 0.6; };
  const auto make_point = [&](const Vec3& p) {
    EmitterPoint x;
    const Vec2 c = 0.5 * (Vec2(to_world.inverse().point(p)) + 1.0);
    // local: the rectangle's own coordinates of the same place, found by its own sample(): uniform
    // in area
    x.surface = shape->sample(c);
    EXPECT_LT(length(x.surface.position - p), 1e-12);
    return x;
  };
  EXPECT_EQ(
      check_triple("area rectangle", position_triple(*emitter, position_of, make_point), chart),
      "");
}

TEST(AreaEmitter, PositionsOnASphereAreUniformInArea) {
  const Vec3 center(1, -2, 0.5);
  const double radius = 0.25;
  const auto shape = make_sphere(center, radius);
  const auto emitter = make_area_emitter(shape, kRadiance);
  Chart chart = testing::sphere_chart(oblique_frame(normalize(Vec3(1, 2, 3))));
  const Chart sphere = chart;
  chart.point = [=](const Vec2& c) { return center + radius * sphere.point(c); };
  chart.coordinates = [=](const Vec3& p) { return sphere.coordinates((p - center) / radius); };
  chart.jacobian = [=](const Vec2& c) { return sqr(radius) * sphere.jacobian(c); };
  const auto make_point = [&](const Vec3& p) {
    Ray ray{center, normalize(p - center)};
    const auto hit = shape->intersect(0, ray, false);
    EXPECT_TRUE(hit.has_value());
    EmitterPoint x;
    x.surface = shape->surface_point(0, hit->local);
    return x;
  };
  EXPECT_EQ(check_triple("area sphere", position_triple(*emitter, position_of, make_point), chart),
            "");
}

/// Triangles of very different size that tile [0,4] × [0,1].
TEST(AreaEmitter, PositionsOnAMeshAreUniformInArea) {
  TriangleMeshData data;
  data.positions = {{0, 0, 0}, {0.5, 0, 0}, {4, 0, 0}, {0, 1, 0}, {0.5, 1, 0}, {4, 1, 0}};
  data.triangles = {{0, 1, 4}, {0, 4, 3}, {1, 2, 5}, {1, 5, 4}};
  const auto shape = make_mesh(data);
  const auto emitter = make_area_emitter(shape, kRadiance);
  const Chart chart = testing::box_chart(Vec2(0), Vec2(4, 1));
  const auto make_point = [&](const Vec3& p) {
    EmitterPoint x;
    for (std::uint32_t t = 0; t < shape->primitive_count(); ++t)
      if (const auto hit = shape->intersect(t, {p + Vec3(0, 0, 1), Vec3(0, 0, -1)}, false)) {
        x.surface = shape->surface_point(t, hit->local);
        return x;
      }
    ADD_FAILURE() << "off the mesh";
    return x;
  };
  EXPECT_EQ(check_triple("area mesh", position_triple(*emitter, position_of, make_point), chart),
            "");
}

TEST(AreaEmitter, DirectionsAreATripleAndOneSided) {
  for (const bool flip : {false, true}) {
    const auto shape = make_rectangle(Transform::rotate(Vec3(1, 1, 0), 70), flip);
    const auto emitter = make_area_emitter(shape, kRadiance);
    const auto x = emitter->sample_position(Vec3(0.3, 0.8, 0.1));
    ASSERT_TRUE(x);
    const Vec3 n = (flip ? -1.0 : 1.0) * Vec3(Transform::rotate(Vec3(1, 1, 0), 70).matrix()[2]);
    ASSERT_LT(length(x->surface.n_g - n), 1e-14);
    EXPECT_EQ(check_triple("area directions", direction_triple(*emitter, *x),
                           testing::sphere_chart(oblique_frame(n))),
              "");
    const Vec3 slanted = normalize(n + 0.9 * oblique_frame(n).s);
    EXPECT_EQ(emitter->L_e(*x, slanted), kRadiance);
    EXPECT_NEAR(emitter->pdf_direction(*x, slanted), dot(slanted, n) / kPi, 1e-15);
    EXPECT_EQ(emitter->L_e(*x, -slanted), RGB(0));
    EXPECT_EQ(emitter->pdf_direction(*x, -slanted), 0);
    testing::expect_near(4.0 * testing::emitted_flux_density(*emitter, *x, n), emitter->power(),
                         1e-6);
  }
}

TEST(AreaEmitter, NamesThePrimitiveItSampled) {
  const auto emitter = make_area_emitter(make_cube(Transform()), kRadiance);
  EXPECT_EQ(emitter->kind(), EmitterKind::Area);
  emitter->bind_shape(17);
  Rng rng(testing::suite_seed(), RngDomain::Test, 800, 0);
  bool several = false;
  for (int i = 0; i < 100; ++i) {
    const auto x = emitter->sample_position(uniform3(rng));
    EXPECT_EQ(x->id.shape, 17u);
    EXPECT_EQ(x->id.primitive, x->surface.primitive);
    several |= x->id.primitive != 0;
  }
  EXPECT_TRUE(several);
}

TEST(PointEmitter, IsDiracAndIsotropic) {
  const Vec3 place(5, -3, 2);
  const auto emitter = make_point_emitter(place, kRadiance);
  EXPECT_EQ(emitter->kind(), EmitterKind::Point);
  const auto x = emitter->sample_position(Vec3(0.1, 0.2, 0.3));
  ASSERT_TRUE(x);
  EXPECT_EQ(x->surface.position, place);
  EXPECT_EQ(x->pdf_position, 1);
  EXPECT_EQ(emitter->pdf_position(*x), 1);
  EXPECT_EQ(x->id, kNoPrimitive);
  EXPECT_EQ(*emitter->invert_position(*x, Vec3(0.7, 0.8, 0.9)), Vec3(0.7, 0.8, 0.9));
  EXPECT_EQ(check_triple("point directions", direction_triple(*emitter, *x),
                         testing::sphere_chart(oblique_frame(normalize(Vec3(1, -2, 1))))),
            "");
  testing::expect_near(testing::emitted_flux_density(*emitter, *x, Vec3(0)), emitter->power(),
                       1e-9);
}

class ConstantEmitterTest : public ::testing::Test {
 protected:
  void SetUp() override { emitter_->bind(center_, radius_); }
  static EmitterPoint travelling(const Vec3& d) {
    EmitterPoint x;
    x.surface.n_g = d;
    return x;
  }
  const Vec3 center_{10, -4, 3};
  const double radius_ = 2.5;
  std::shared_ptr<Emitter> emitter_ = make_constant_emitter(kRadiance);
};

TEST_F(ConstantEmitterTest, DirectionsOfTravelAreATriple) {
  EXPECT_EQ(emitter_->kind(), EmitterKind::Infinite);
  EXPECT_EQ(
      check_triple("constant positions",
                   position_triple(
                       *emitter_, [](const EmitterPoint& x) { return x.surface.n_g; }, travelling),
                   testing::sphere_chart(oblique_frame(normalize(Vec3(2, 1, 1))))),
      "");
}

TEST_F(ConstantEmitterTest, OriginsAreATripleOnADiskAcrossThem) {
  for (const Vec3& d : {Vec3(0, 0, 1), normalize(Vec3(1, -2, -3))}) {
    const EmitterPoint x = travelling(d);
    const Frame frame = oblique_frame(d);
    Chart chart;  // the disk alone; c.x ∝ r²
    chart.point = [&](const Vec2& p) {
      const double r = radius_ * std::sqrt(p.x), phi = 2 * kPi * p.y;
      return center_ + frame.to_world({r * std::cos(phi), r * std::sin(phi), 0});
    };
    chart.coordinates = [&](const Vec3& q) {
      const Vec3 p = frame.to_local(q - center_);
      const double turn = std::atan2(p.y, p.x) / (2 * kPi);
      return Vec2((p.x * p.x + p.y * p.y) / sqr(radius_), turn < 0 ? turn + 1 : turn);
    };
    chart.jacobian = [&](const Vec2&) { return kPi * sqr(radius_); };
    const Triple triple{2,
                        [&](const Vec3& u) -> std::optional<Vec3> {
                          const EmitterDirection e = emitter_->sample_direction(x, Vec2(u));
                          EXPECT_EQ(e.w, d);
                          EXPECT_EQ(e.pdf_direction, emitter_->pdf_direction(x, d));
                          const double before = dot(e.origin - center_, d);
                          EXPECT_LT(before, -radius_);  // outside the sphere, the scene ahead
                          return e.origin - before * d;
                        },
                        [&](const Vec3&) { return emitter_->pdf_direction(x, d); },
                        [&](const Vec3& q, const Vec3& auxiliary) -> std::optional<Vec3> {
                          // Any point of the ray names it.
                          const Vec3 origin = q + (auxiliary.x - 0.5) * 3 * radius_ * d;
                          const auto u = emitter_->invert_direction(x, {d, origin, 0});
                          if (!u) return std::nullopt;
                          return Vec3(*u, 0);
                        }};
    EXPECT_EQ(check_triple("constant origins", triple, chart), "");
    const Vec3 outside = center_ + 1.0001 * radius_ * frame.s;
    EXPECT_FALSE(emitter_->invert_direction(x, {d, outside, 0}));
  }
}

/// Rays that carry L_e / (pdf_position · pdf_direction) bring the fluence 4πL to any small ball in
/// the scene.
TEST_F(ConstantEmitterTest, FillsTheSceneEvenly) {
  constexpr int kReplicates = 20, kRays = 40000;
  const std::vector<Vec3> places{center_, center_ + radius_ * normalize(Vec3(1, 1, -2)) * 0.85};
  const double ball = 0.1 * radius_;
  for (const Vec3& place : places) {
    std::vector<double> fluence;
    for (int r = 0; r < kReplicates; ++r) {
      Rng rng(testing::suite_seed(), RngDomain::Test, 801, r);
      double sum = 0;
      for (int i = 0; i < kRays; ++i) {
        const auto x = emitter_->sample_position(uniform3(rng));
        const auto e = emitter_->sample_direction(*x, uniform2(rng));
        if (length(cross(place - e.origin, e.w)) > ball) continue;
        ASSERT_GT(dot(place - e.origin, e.w), 0);
        sum += emitter_->L_e(*x, e.w).x / (x->pdf_position * e.pdf_direction);
      }
      fluence.push_back(sum / (kRays * kPi * sqr(ball)));
    }
    const auto estimate = testing::estimate(fluence);
    EXPECT_LT(estimate.standard_error, 0.02 * 4 * kPi * kRadiance.x);
    EXPECT_GT(testing::compare(estimate, 4 * kPi * kRadiance.x),
              testing::sidak(testing::kSuiteFalseAlarm, 2))
        << estimate.mean << " +- " << estimate.standard_error;
  }
}

TEST_F(ConstantEmitterTest, PowerIsTheFluxThroughTheScenesDisk) {
  const EmitterPoint x = travelling(Vec3(0, 1, 0));
  testing::expect_near(
      emitter_->power(),
      kRadiance / (emitter_->pdf_position(x) * emitter_->pdf_direction(x, Vec3(0, 1, 0))), 1e-14);
  testing::expect_near(emitter_->power(), 4 * kPi * kPi * sqr(radius_) * kRadiance, 1e-14);
  EXPECT_EQ(emitter_->L_e(x, Vec3(0, 1, 0)), kRadiance);
}

TEST(Emitters, RefuseNegativeAndNonFiniteRadiation) {
  const auto shape = make_rectangle(Transform());
  for (const double bad : {-1.0, std::nan(""), kInfinity})
    for (int c = 0; c < 3; ++c) {
      RGB radiance(1);
      radiance[c] = bad;
      EXPECT_THROW(make_area_emitter(shape, radiance), std::domain_error);
      EXPECT_THROW(make_point_emitter(Vec3(0), radiance), std::domain_error);
      EXPECT_THROW(make_constant_emitter(radiance), std::domain_error);
    }
  EXPECT_THROW(make_point_emitter(Vec3(0, std::nan(""), 0), RGB(1)), std::domain_error);
}

}  // namespace
}  // namespace fogbow
