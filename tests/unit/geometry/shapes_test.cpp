// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <map>

#include "core/geometry/accel.h"
#include "core/math/random.h"
#include "core/math/spread.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/geometry/shape_cases.h"

namespace fogbow {
namespace {

using testing::all_cases;
using testing::ShapeCase;
using testing::suite_seed;

constexpr double kScale = 2.5;
const Vec3 kOffset(1, -2, 0.5);

double tessellated_area(const Shape& shape) {
  const Tessellation soup = shape.tessellate();
  double sum = 0;
  for (const auto& [a, b, c] : soup.triangles)
    sum += 0.5 *
           length(cross(soup.vertices[b] - soup.vertices[a], soup.vertices[c] - soup.vertices[a]));
  return sum;
}

TEST(Shapes, AreaIsThatOfTheTessellation) {
  for (const ShapeCase& c : all_cases(kScale, kOffset)) {
    const bool curved = c.shape->primitive_kind() == PrimitiveKind::Analytic;
    const double area = tessellated_area(*c.shape);
    EXPECT_NEAR(c.shape->area() / area, 1, curved ? 0.01 : 1e-12) << c.name;
  }
  EXPECT_DOUBLE_EQ(make_sphere(kOffset, 2)->area(), 16 * kPi);
  EXPECT_DOUBLE_EQ(make_cube(Transform::scale({1, 2, 3}))->area(), 8 * (2 + 3 + 6));
  EXPECT_DOUBLE_EQ(make_rectangle(Transform::scale({1, 2, 3}))->area(), 8);
  EXPECT_DOUBLE_EQ(make_disk(Transform::scale({2, 3, 5}))->area(), 6 * kPi);
  EXPECT_DOUBLE_EQ(make_cylinder({1, 0, 0}, {1, 0, 2}, 0.5, Transform::scale({3, 3, 7}))->area(),
                   2 * kPi * 1.5 * 14);
}

/// Which cell of equal or known area a point lies in, from its position alone.
struct Cells {
  std::vector<double> share;
  std::function<std::size_t(const SurfacePoint&)> of;
};

Cells sphere_cells() {
  constexpr int kRings = 16, kSectors = 16;
  return {
      std::vector<double>(kRings * kSectors, 1.0 / (kRings * kSectors)), [](const SurfacePoint& x) {
        const Vec3 n = normalize(x.position - kOffset);
        const int ring = std::min(static_cast<int>((n.z + 1) / 2 * kRings), kRings - 1);
        const double turn = std::atan2(n.y, n.x) / (2 * kPi) + 0.5;
        return static_cast<std::size_t>(ring * kSectors +
                                        std::min(static_cast<int>(turn * kSectors), kSectors - 1));
      }};
}

/// Rings of equal area on the unit disk, sixteen of sixteen sectors.
Cells disk_cells() {
  constexpr int kRings = 16, kSectors = 16;
  const Transform to_disk = testing::skewed(kScale, kOffset).inverse();
  return {std::vector<double>(kRings * kSectors, 1.0 / (kRings * kSectors)),
          [to_disk](const SurfacePoint& x) {
            const Vec3 p = to_disk.point(x.position);
            EXPECT_NEAR(p.z, 0, 1e-13);
            const int ring = std::min(static_cast<int>((p.x * p.x + p.y * p.y) * kRings), 15);
            const double turn = std::atan2(p.y, p.x) / (2 * kPi) + 0.5;
            return static_cast<std::size_t>(ring * kSectors +
                                            std::min(static_cast<int>(turn * kSectors), 15));
          }};
}

Cells cylinder_cells() {
  constexpr int kSlices = 16, kSectors = 16;
  const auto [p0, p1] = testing::cylinder_ends(kScale, kOffset);
  const Vec3 axis = normalize(p1 - p0), a = normalize(cross(axis, Vec3(0.3, -0.7, 0.2)));
  return {std::vector<double>(kSlices * kSectors, 1.0 / (kSlices * kSectors)),
          [=, p0 = p0, p1 = p1](const SurfacePoint& x) {
            const Vec3 p = x.position - p0;
            const double z = dot(p, axis) / length(p1 - p0);
            EXPECT_NEAR(length(cross(p, axis)), 0.7 * kScale, 1e-13 * kScale);
            const double turn = std::atan2(dot(p, cross(axis, a)), dot(p, a)) / (2 * kPi) + 0.5;
            return static_cast<std::size_t>(std::min(static_cast<int>(z * kSlices), 15) * kSectors +
                                            std::min(static_cast<int>(turn * kSectors), 15));
          }};
}

/// The triangles of the tessellation, each cut in four at the middles of its edges.
Cells triangle_cells(const Shape& shape) {
  const auto soup = std::make_shared<Tessellation>(shape.tessellate());
  const std::size_t per_primitive = soup->triangles.size() / shape.primitive_count();
  Cells cells;
  for (const auto& [a, b, c] : soup->triangles) {
    const double area = 0.5 * length(cross(soup->vertices[b] - soup->vertices[a],
                                           soup->vertices[c] - soup->vertices[a]));
    cells.share.insert(cells.share.end(), 4, area / 4 / tessellated_area(shape));
  }
  cells.of = [soup, per_primitive](const SurfacePoint& x) -> std::size_t {
    std::size_t best = 0;
    double best_inside = -kInfinity;
    for (std::size_t k = 0; k < per_primitive; ++k) {
      const std::size_t t = x.primitive * per_primitive + k;
      const Vec3 &a = soup->vertices[soup->triangles[t][0]],
                 &b = soup->vertices[soup->triangles[t][1]],
                 &c = soup->vertices[soup->triangles[t][2]];
      const Vec3 n = cross(b - a, c - a);
      const auto weight = [&](const Vec3& p, const Vec3& q) {
        return dot(n, cross(q - p, x.position - p)) / dot(n, n);
      };
      const Vec3 bary(weight(b, c), weight(c, a), weight(a, b));
      const double inside = std::fmin(bary.x, std::fmin(bary.y, bary.z));
      if (inside <= best_inside) continue;
      best_inside = inside;
      best = 4 * t + (bary.x > 0.5 ? 0 : bary.y > 0.5 ? 1 : bary.z > 0.5 ? 2 : 3);
    }
    EXPECT_GT(best_inside, -1e-12);
    return best;
  };
  return cells;
}

TEST(Shapes, SamplesAreUniform) {
  const auto cases = all_cases(kScale, kOffset);
  const double level = testing::sidak(testing::kSuiteFalseAlarm, static_cast<int>(cases.size()));
  for (const ShapeCase& c : cases) {
    const bool curved = c.shape->primitive_kind() == PrimitiveKind::Analytic;
    const Cells cells = !curved                                        ? triangle_cells(*c.shape)
                        : c.name.find("disk") != std::string::npos     ? disk_cells()
                        : c.name.find("cylinder") != std::string::npos ? cylinder_cells()
                                                                       : sphere_cells();
    constexpr int kSamples = 200000;
    std::vector<std::uint64_t> counts(cells.share.size(), 0);
    std::vector<double> expected;
    for (const double share : cells.share) expected.push_back(kSamples * share);
    Rng rng(suite_seed(), RngDomain::Test, 10, 0);
    for (int i = 0; i < kSamples; ++i) ++counts[cells.of(c.shape->sample(uniform2(rng)))];
    EXPECT_GT(testing::chi2_test(counts, expected), level) << c.name;
  }
}

TEST(Shapes, InvertIsTheInverseOfSample) {
  for (const ShapeCase& c : all_cases(kScale, kOffset)) {
    Rng rng(suite_seed(), RngDomain::Test, 11, 0);
    for (int i = 0; i < 5000; ++i) {
      const Vec2 u = uniform2(rng);
      const SurfacePoint x = c.shape->sample(u);
      const Vec2 back = c.shape->invert(x);
      ASSERT_TRUE(back.x >= 0 && back.x < 1 && back.y >= 0 && back.y < 1);
      EXPECT_LT(length(Vec3(back - u, 0)), 1e-10) << c.name;
      const SurfacePoint again = c.shape->sample(back);
      EXPECT_EQ(again.primitive, x.primitive) << c.name;
      EXPECT_LT(length(again.position - x.position), 1e-10 * kScale) << c.name;
    }
  }
}

TEST(Shapes, PointsCarryConsistentFrames) {
  for (const ShapeCase& c : all_cases(kScale, kOffset)) {
    Rng rng(suite_seed(), RngDomain::Test, 12, 0);
    for (int i = 0; i < 2000; ++i) {
      const SurfacePoint x = c.shape->sample(uniform2(rng));
      EXPECT_NEAR(length(x.n_g), 1, 1e-14);
      EXPECT_NEAR(length(x.shading.n), 1, 1e-14);
      EXPECT_GT(dot(x.n_g, x.shading.n), 0) << c.name;
      const SurfaceDerivatives d = c.shape->derivatives(x);
      EXPECT_NEAR(dot(normalize(d.dp_du), x.n_g), 0, 1e-13) << c.name;
      EXPECT_NEAR(dot(normalize(d.dp_dv), x.n_g), 0, 1e-13) << c.name;
    }
  }
}

TEST(Shapes, NormalsPointOutwardsUnlessFlipped) {
  Rng rng(suite_seed(), RngDomain::Test, 13, 0);
  for (const ShapeCase& c : all_cases(kScale, kOffset)) {
    if (c.name.find("rectangle") != std::string::npos || c.name.find("disk") != std::string::npos)
      continue;
    const double side = c.name.find("flipped") == 0 ? -1 : 1;
    for (int i = 0; i < 500; ++i) {
      const SurfacePoint x = c.shape->sample(uniform2(rng));
      EXPECT_GT(side * dot(x.n_g, x.position - kOffset), 0) << c.name;
    }
  }
  // The normal of a rectangle is that of its image, mirrored or not.
  for (const Vec3& s : {Vec3(1), Vec3(-1, 1, 1), Vec3(1, 1, -1)}) {
    const auto rectangle = make_rectangle(Transform::scale(s));
    EXPECT_EQ(rectangle->sample(Vec2(0.5)).n_g, Vec3(0, 0, s.z));
    EXPECT_EQ(make_rectangle(Transform::scale(s), true)->sample(Vec2(0.5)).n_g, Vec3(0, 0, -s.z));
    EXPECT_EQ(make_disk(Transform::scale(s))->sample(Vec2(0.5)).n_g, Vec3(0, 0, s.z));
    EXPECT_EQ(make_disk(Transform::scale(s), true)->sample(Vec2(0.5)).n_g, Vec3(0, 0, -s.z));
  }
}

/// Moves by (du, dv) in the coordinates that the derivatives refer to.
SurfacePoint moved(const Shape& shape, const SurfacePoint& x, const Vec2& step) {
  if (shape.primitive_kind() != PrimitiveKind::Analytic)
    return shape.surface_point(x.primitive, x.local + step);
  // Down from above the tangent plane, so that nothing of the shape's own coordinates is used.
  const SurfaceDerivatives d = shape.derivatives(x);
  const Vec3 above = x.position + step.x * d.dp_du + step.y * d.dp_dv + 0.1 * kScale * x.n_g;
  const auto hit = shape.intersect(0, {above, -x.n_g}, false);
  return shape.surface_point(0, hit.value().local);
}

TEST(Shapes, DerivativesAreThoseOfFiniteDifferences) {
  for (const ShapeCase& c : all_cases(kScale, kOffset)) {
    const bool curved = c.shape->primitive_kind() == PrimitiveKind::Analytic;
    Rng rng(suite_seed(), RngDomain::Test, 14, 0);
    const double h = 1e-5;
    double largest_turn = 0;
    for (int i = 0; i < 300; ++i) {
      const SurfacePoint x = c.shape->sample(Vec2(0.05) + 0.9 * uniform2(rng));
      const SurfaceDerivatives d = c.shape->derivatives(x);
      const auto difference = [&](const Vec2& step, bool normal) {
        const SurfacePoint a = moved(*c.shape, x, -h * step), b = moved(*c.shape, x, h * step);
        return (normal ? b.shading.n - a.shading.n : b.position - a.position) / (2 * h);
      };
      const double tolerance = 1e-8 * (curved ? 1 : length(d.dp_du) + 1);
      EXPECT_LT(length(difference({1, 0}, false) - d.dp_du), tolerance) << c.name;
      EXPECT_LT(length(difference({0, 1}, false) - d.dp_dv), tolerance) << c.name;
      EXPECT_LT(length(difference({1, 0}, true) - d.dn_du), tolerance) << c.name;
      EXPECT_LT(length(difference({0, 1}, true) - d.dn_dv), tolerance) << c.name;
      largest_turn = std::fmax(largest_turn, length(d.dn_du));
    }
    const bool flat = c.name.find("cube") != std::string::npos ||
                      c.name.find("rectangle") != std::string::npos ||
                      c.name.find("disk") != std::string::npos || c.name == "mesh box" ||
                      c.name == "faceted mesh";
    EXPECT_EQ(largest_turn > 0.01, !flat) << c.name;
  }
}

TEST(Sphere, ResolvesBothPoles) {
  const auto sphere = make_sphere(Vec3(0), 1);
  for (const double side : {-1.0, 1.0})
    for (const double x : {1e-3, 1e-6, 1e-9, 1e-12, 0.0}) {
      const auto hit = sphere->intersect(0, {{x, 0, 3 * side}, {0, 0, -side}}, false);
      ASSERT_TRUE(hit);
      const SurfacePoint p = sphere->surface_point(0, hit->local);
      EXPECT_NEAR(p.position.x, x, 1e-15 * x) << x;
      EXPECT_NEAR(p.position.z, side, 1e-6);
    }
}

TEST(Sphere, LeavingExcludesTheRootAtZeroAndNoOther) {
  const auto sphere = make_sphere({3, 2, 1}, 0.7);
  Rng rng(suite_seed(), RngDomain::Test, 15, 0);
  for (int i = 0; i < 100000; ++i) {
    const SurfacePoint x = sphere->sample(uniform2(rng));
    const double sine = testing::log_uniform(rng, -9, 0);
    const double phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - sine * sine);
    const Vec3 w = x.shading.to_world({r * std::cos(phi), r * std::sin(phi), -sine});
    const auto chord = sphere->intersect(0, {x.position, w}, true);
    ASSERT_TRUE(chord);
    EXPECT_NEAR(chord->t, 2 * 0.7 * sine, 1e-14);
    EXPECT_FALSE(sphere->intersect(0, {x.position, w - 2 * dot(w, x.n_g) * x.n_g}, true));
  }
}

/// Mitsuba 3.9.1 (scalar_rgb): `mi.load_dict({'type': 'scene', 's': {...}}).ray_intersect(...)`.
TEST(Disk, IsMitsubas) {
  const auto disk = make_disk(Transform::scale({2, 1, 1}));
  const auto hit = disk->intersect(0, {{1.2, 0.4, 2}, {0, 0, -1}}, false);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->t, 2);
  const SurfacePoint x = disk->surface_point(0, hit->local);
  EXPECT_LT(length(x.position - Vec3(1.2, 0.4, 0)), 1e-15);
  EXPECT_EQ(x.n_g, Vec3(0, 0, 1));
  EXPECT_NEAR(x.uv.x, 0.72111, 1e-6);
  EXPECT_NEAR(x.uv.y, 0.0935835, 1e-7);
}

TEST(Disk, EndsAtItsRim) {
  const Transform to_world = testing::skewed(1, Vec3(3, 2, 1));
  const auto disk = make_disk(to_world);
  Rng rng(suite_seed(), RngDomain::Test, 16, 0);
  for (int i = 0; i < 20000; ++i) {
    const double r = 2 * rng.uniform(), phi = 2 * kPi * rng.uniform();
    if (std::fabs(r - 1) < 1e-12) continue;
    const Vec3 target = to_world.point({r * std::cos(phi), r * std::sin(phi), 0});
    const Vec3 o = target + 3.0 * warp::sample_sphere(uniform2(rng));
    EXPECT_EQ(disk->intersect(0, {o, normalize(target - o)}, false).has_value(), r < 1);
  }
}

TEST(Cylinder, IsMitsubas) {
  struct Expected {
    Vec3 p0, p1;
    double radius;
    Transform to_world;
    Vec3 origin;
    double t;
    Vec3 n;
    Vec2 uv;
  };
  const Vec3 o(0), z(0, 0, 1);
  const std::vector<Expected> all{
      {o, z, 1, Transform(), {5, 0.3, 0.5}, 4.04606, {0.953939, 0.3, 0}, {0.0484933, 0.5}},
      {z, 3.0 * z, 2, Transform(), {5, 0.3, 1.5}, 3.02263, {0.988686, 0.15, 0}, {0.0239637, 0.25}},
      {o,
       z,
       1,
       Transform::scale({-1, 1, 1}),
       {5, 0.3, 0.5},
       4.04606,
       {0.953939, 0.3, 0},
       {0.451507, 0.5}},
      {o,
       z,
       1,
       Transform::scale({1, 1, 3}),
       {5, 0.3, 0.5},
       4.04606,
       {0.953939, 0.3, 0},
       {0.0484933, 0.166667}}};
  for (const Expected& e : all)
    for (const bool flip : {false, true}) {
      const auto cylinder = make_cylinder(e.p0, e.p1, e.radius, e.to_world, flip);
      const auto hit = cylinder->intersect(0, {e.origin, {-1, 0, 0}}, false);
      ASSERT_TRUE(hit);
      EXPECT_NEAR(hit->t, e.t, 1e-5);
      const SurfacePoint x = cylinder->surface_point(0, hit->local);
      EXPECT_LT(length(x.n_g - (flip ? -1.0 : 1.0) * e.n), 2e-6);
      EXPECT_LT(length(Vec3(x.uv - e.uv, 0)), 1e-6);
    }
  // eval_parameterization([0.25, 0.5]) of p0 = 0, p1 = (1, 2, 3), radius 0.5
  const SurfacePoint x =
      make_cylinder(o, {1, 2, 3}, 0.5, Transform())->surface_point(0, {0.25, 0.5});
  EXPECT_LT(length(x.position - Vec3(0.460357, 1.42071, 1.23274)), 1e-5);
}

TEST(Cylinder, IsHitFromInsideAndOutsideAndThroughItsOpenEnds) {
  const auto cylinder = make_cylinder({0, 0, -1}, {0, 0, 1}, 1, Transform());
  const auto t = [&](const Vec3& o, const Vec3& d, bool leaving = false) {
    const auto hit = cylinder->intersect(0, {o, normalize(d)}, leaving);
    return hit ? hit->t : -1;
  };
  EXPECT_DOUBLE_EQ(t({-3, 0, 0}, {1, 0, 0}), 2);
  EXPECT_DOUBLE_EQ(t({0, 0, 0}, {1, 0, 0}), 1);
  EXPECT_EQ(t({0, 0, 0}, {0, 0, 1}), -1);
  EXPECT_EQ(t({0.5, 0, 5}, {0, 0, -1}), -1);
  // In at the top, onto the inside of the far wall.
  EXPECT_NEAR(t({-1, 0, 2}, {1, 0, -1}), 2 * std::sqrt(2), 1e-14);
  EXPECT_DOUBLE_EQ(t({-1, 0, 0}, {1, 0, 0}, true), 2);
  EXPECT_EQ(t({-1, 0, 0}, {-1, 0, 0}, true), -1);
  EXPECT_EQ(t({-1, 0, 0}, {1, 0, 2}, true), -1);
  // It ends where it ends.
  for (const double end : {-1, 1}) {
    EXPECT_DOUBLE_EQ(t({-3, 0, 0.9999 * end}, {1, 0, 0}), 2);
    EXPECT_EQ(t({-3, 0, 1.0001 * end}, {1, 0, 0}), -1);
  }
}

/// No point of a primitive lies in a box that it says it avoids.
TEST(Shapes, AvoidNoBoxThatHoldsAPartOfThem) {
  for (const auto& c : testing::all_cases(1, Vec3(1, 2, 3))) {
    SCOPED_TRACE(c.name);
    std::vector<SurfacePoint> points;
    for (int i = 0; i < 512; ++i) points.push_back(c.shape->sample(spread_point(i, 512)));
    int avoided = 0, met = 0;
    for (int i = 0; i < 400; ++i) {
      Rng rng(testing::suite_seed(), RngDomain::Test, static_cast<std::uint64_t>(i), 5);
      const double size = testing::log_uniform(rng, -2, 0.5);
      const Vec3 middle = Vec3(1, 2, 3) + 4.0 * (uniform3(rng) - 0.5);
      const Bounds box{middle - size * uniform3(rng), middle + size * uniform3(rng)};
      for (const SurfacePoint& x : points) {
        if (!Bounds{x.position, x.position}.overlaps(box)) continue;
        ++met;
        ASSERT_FALSE(c.shape->avoids(x.primitive, box));
      }
      avoided += c.shape->avoids(0, box);
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(avoided, 100);
  }
}

TEST(Cylinder, RefusesWhatIsNone) {
  const Vec3 o(0), z(0, 0, 1);
  EXPECT_THROW(make_cylinder(o, o, 1, Transform()), std::domain_error);
  EXPECT_THROW(make_cylinder(o, z, 0, Transform()), std::domain_error);
  EXPECT_THROW(make_cylinder(o, z, std::nan(""), Transform()), std::domain_error);
  EXPECT_THROW(make_cylinder(o, {0, kInfinity, 0}, 1, Transform()), std::domain_error);
  EXPECT_THROW(make_cylinder(o, z, 1, Transform::scale({1, 2, 1})), std::domain_error);
  Mat4 shear(1.0);
  shear[2][0] = 0.3;
  EXPECT_THROW(make_cylinder(o, z, 1, Transform(shear)), std::domain_error);
}

TEST(Mesh, TurnsShadingNormalsToTheGeometricSide) {
  TriangleMeshData data{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {{0, 1, 2}}};
  data.normals = {{0, 0, -1}, normalize(Vec3(0.5, 0, -1)), {0, 0, -1}};
  const auto mesh = make_mesh(data);
  const SurfacePoint x = mesh->surface_point(0, {0.3, 0.3});
  EXPECT_EQ(x.n_g, Vec3(0, 0, 1));
  EXPECT_GT(x.shading.n.z, 0);
  EXPECT_LT(x.shading.n.x, 0);
}

TEST(Mesh, RefusesWhatIsNoMesh) {
  const TriangleMeshData good{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {{0, 1, 2}}};
  EXPECT_NO_THROW(make_mesh(good));
  TriangleMeshData bad = good;
  bad.triangles[0][2] = 3;
  EXPECT_THROW(make_mesh(bad), std::domain_error);
  bad = good;
  bad.positions[1].y = std::nan("");
  EXPECT_THROW(make_mesh(bad), std::domain_error);
  bad = good;
  bad.normals = {{0, 0, 1}};
  EXPECT_THROW(make_mesh(bad), std::domain_error);
  bad = good;
  bad.uvs = {Vec2(0), Vec2(0), Vec2(kInfinity, 0)};
  EXPECT_THROW(make_mesh(bad), std::domain_error);
  bad = good;
  bad.positions[2] = {2, 0, 0};
  EXPECT_THROW(make_mesh(bad), std::domain_error);
}

TEST(Mesh, DropsTrianglesWithoutArea) {
  TriangleMeshData data{
      {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}}, {}, {}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_EQ(make_mesh(data)->primitive_count(), 1u);
}

/// A corner of a cube in a fan of unequal triangles: the normal is the diagonal all the same.
TEST(Mesh, VertexNormalsAreWeightedByAngle) {
  TriangleMeshData data{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}}, {}, {}, {}};
  data.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 1}};
  EXPECT_LT(length(vertex_normals(data)[0] - normalize(Vec3(1))), 1e-15);
}

/// Texture coordinates of Mitsuba 3.9.1: ray_intersect() of each shape alone.
/// A step along a tangent changes its own coordinate alone, by as much.
TEST(TextureCoordinates, RiseAlongTheirTangents) {
  constexpr double kStep = 1e-6;
  for (const ShapeCase& c : all_cases(1, Vec3(0.2, -0.1, 0.3))) {
    SCOPED_TRACE(c.name);
    const Shape* shapes[] = {c.shape.get()};
    const Accel accel(shapes);
    int compared = 0;
    for (int i = 0; i < 200; ++i) {
      Rng rng(11, RngDomain::Test, 0, static_cast<std::uint64_t>(i));
      const SurfacePoint x = c.shape->sample(uniform2(rng));
      const auto tangents = c.shape->uv_tangents(x);
      for (int k = 0; k < 2; ++k) {
        const Vec3 p = x.position + kStep * tangents[k];
        const auto hit = accel.intersect(Ray{p + 1e-3 * x.n_g, -x.n_g, 0, 2e-3});
        if (!hit || hit->id.primitive != x.primitive) continue;
        const Vec2 change =
            (c.shape->surface_point(hit->id.primitive, hit->local).uv - x.uv) / kStep;
        if (std::fabs(change.x) > 100 || std::fabs(change.y) > 100) continue;  // across the seam
        EXPECT_NEAR(change[k], 1, 2e-3);
        EXPECT_NEAR(change[1 - k], 0, 2e-3);
        ++compared;
      }
    }
    EXPECT_GT(compared, 100);
  }
}

TEST(TextureCoordinates, AreMitsubas) {
  const auto expect_uv = [](const Shape& shape, const Vec3& position, const Vec2& uv) {
    const Vec3 out = 5.0 * normalize(position);
    const Shape* shapes[] = {&shape};
    const Accel accel(shapes);
    const auto hit = accel.intersect(Ray{position + out, -normalize(out), 0, kInfinity});
    ASSERT_TRUE(hit);
    const SurfacePoint x = shape.surface_point(hit->id.primitive, hit->local);
    EXPECT_NEAR(length(x.position - position), 0, 1e-5);
    EXPECT_NEAR(length(x.uv - uv), 0, 1e-5) << position.x << ' ' << position.y << ' ' << position.z;
  };
  const auto cube = make_cube(Transform());
  expect_uv(*cube, {1, -0.4, 0.6}, {0.3, 0.2});
  expect_uv(*cube, {-1, -0.4, 0.6}, {0.3, 0.8});
  expect_uv(*cube, {0.3, 1, 0.6}, {0.35, 0.2});
  expect_uv(*cube, {0.3, -1, 0.6}, {0.8, 0.65});
  expect_uv(*cube, {0.3, -0.4, 1}, {0.3, 0.65});
  expect_uv(*cube, {0.3, -0.4, -1}, {0.7, 0.65});
  const auto rectangle = make_rectangle(Transform::translate({0, 0, 1}));
  expect_uv(*rectangle, {-0.5, 0.3, 1}, {0.25, 0.65});
  const auto sphere = make_sphere(Vec3(0), 1);
  expect_uv(*sphere, normalize(Vec3(-0.0398964, 0.99741, 0.0598446)), {0.256363, 0.480939});
  expect_uv(*sphere, normalize(Vec3(0.0399601, -0.999002, 0.01998)), {0.756363, 0.49364});
  // Rotated by 90° about x, then 30° of it about its own axis, and as a mirror image.
  const Transform turned = Transform::rotate({1, 0, 0}, 90) * Transform::rotate({0, 0, 1}, 30);
  expect_uv(*make_sphere(Vec3(0), 1, false, Mat3(turned.inverse_matrix())),
            normalize(Vec3(0.980589, 0, 0.196077)), {0.948077, 0.5});
  expect_uv(*make_sphere(Vec3(0), 1, true, Mat3(Transform::scale({-1, 1, 1}).matrix())),
            normalize(Vec3(0.960777, 0.2, 0.192114)), {0.467336, 0.438466});
}

}  // namespace
}  // namespace fogbow
