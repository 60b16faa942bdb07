// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/mesh_check.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/math/spread.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/geometry/shape_cases.h"

namespace fogbow {
namespace {

using testing::mesh_data;
using Kind = BoundaryDefect::Kind;

BoundaryGroup group_of(std::initializer_list<std::shared_ptr<const Shape>> shapes) {
  std::vector<const Shape*> list;
  for (const auto& shape : shapes) list.push_back(shape.get());
  return BoundaryGroup(list);
}

TriangleMeshData box(double half, const Vec3& center = Vec3(0)) {
  return mesh_data(*make_cube(Transform::translate(center) * Transform::scale(Vec3(half))));
}

std::shared_ptr<const Shape> cube(double half, const Vec3& center = Vec3(0), bool flip = false) {
  return make_cube(Transform::translate(center) * Transform::scale(Vec3(half)), flip);
}

void expect_one(const BoundaryGroup& group, Kind kind, const std::string& message) {
  ASSERT_EQ(group.defects().size(), 1u);
  EXPECT_EQ(group.defects()[0].kind, kind);
  EXPECT_EQ(group.defects()[0].message, message);
}

TEST(Boundary, OfEveryClosedShapeIsSound) {
  for (const auto& c : testing::convex_cases(2, Vec3(1, 2, 3))) {
    const BoundaryGroup group = group_of({c.shape});
    EXPECT_TRUE(group.defects().empty()) << c.name << ": " << group.defects()[0].message;
    EXPECT_TRUE(group.closed()) << c.name;
  }
}

TEST(Boundary, HasTheVolumeOfItsShape) {
  EXPECT_DOUBLE_EQ(group_of({make_sphere(Vec3(1), 2)}).volume(), 32 * kPi / 3);
  EXPECT_NEAR(
      group_of({make_cube(Transform::translate({5, 5, 5}) * Transform::scale({1, 2, 3}))}).volume(),
      48, 1e-12);
  EXPECT_NEAR(group_of({make_mesh(box(1)), make_mesh(box(0.5, {3, 0, 0}))}).volume(), 9, 1e-12);
  // A hollow: the inner boundary faces inwards.
  EXPECT_NEAR(group_of({cube(1), cube(0.5, Vec3(0), true)}).volume(), 7, 1e-12);
  EXPECT_NEAR(group_of({make_sphere(Vec3(0), 2), make_sphere(Vec3(0), 1, true)}).volume(),
              28 * kPi / 3, 1e-12);
}

/// Triangles of a tessellation wind around the normal that the shape has there.
TEST(Boundary, IsTurnedAsItsShape) {
  for (const auto& c : testing::all_cases(1, Vec3(1, 2, 3))) {
    SCOPED_TRACE(c.name);
    std::vector<SurfacePoint> points;
    for (int i = 0; i < 4096; ++i) points.push_back(c.shape->sample(spread_point(i, 4096)));
    const Tessellation t = c.shape->tessellate();
    for (const auto& [i, j, k] : t.triangles) {
      const Vec3 &a = t.vertices[i], &b = t.vertices[j], &d = t.vertices[k];
      const Vec3 middle = (a + b + d) / 3.0;
      const auto nearest = std::ranges::min_element(
          points, {}, [&](const SurfacePoint& x) { return length_squared(x.position - middle); });
      ASSERT_GT(dot(cross(b - a, d - a), nearest->n_g), 0);
    }
  }
}

/// Within, across, apart and touching: of balls and boxes, in all roles.
TEST(Boundary, TellsWhatLiesWithinWhat) {
  const BoundaryGroup large = group_of({cube(2)}), ball = group_of({make_sphere(Vec3(0), 2.5)});
  struct Case {
    std::shared_ptr<const Shape> shape;
    bool within, crosses;
  };
  const auto reach = [](double x, double radius) { return make_sphere({x, 0, 0}, radius); };
  for (const auto& [shape, within, crosses] :
       {Case{reach(0, 1), true, false}, Case{reach(1.5, 1), false, true},
        Case{reach(1.98, 1), false, true}, Case{reach(3.5, 1), false, false},
        Case{reach(0, 9), false, false}, Case{cube(1), true, false},
        Case{cube(1, {1.5, 0, 0}), false, true}, Case{cube(1, {9, 0, 0}), false, false},
        Case{cube(9), false, false}}) {
    const BoundaryGroup group = group_of({shape});
    EXPECT_EQ(group.lies_within(large), within);
    EXPECT_EQ(group.crosses(large) || large.crosses(group), crosses);
    EXPECT_FALSE(group.lies_within(group_of({make_sphere({0, 0, 50}, 1)})));
  }
  EXPECT_TRUE(large.crosses(ball) || ball.crosses(large));  // at its corners
  EXPECT_FALSE(large.lies_within(ball));
  EXPECT_FALSE(ball.lies_within(large));
}

TEST(Boundary, OfACanIsClosed) {
  const auto side = make_cylinder({0, 0, -1}, {0, 0, 2}, 1.5, Transform());
  const auto lid = [](double z, bool flip) {
    return make_disk(Transform::translate({0, 0, z}) * Transform::scale(Vec3(1.5)), flip);
  };
  const BoundaryGroup can = group_of({side, lid(2, false), lid(-1, true)});
  EXPECT_TRUE(can.closed());
  EXPECT_TRUE(can.defects().empty());
  EXPECT_NEAR(can.volume() / (kPi * sqr(1.5) * 3), 1, 0.002);  // of the inscribed prism
  expect_one(group_of({side, lid(2, false)}), Kind::Open, "64 border edges");
}

/// However can and lids are turned around their common axis.
TEST(Boundary, OfATurnedCanIsClosed) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 21, 0);
  for (int i = 0; i < 20; ++i) {
    const Vec3 p0 = uniform3(rng), p1 = 3.0 * uniform3(rng), axis = normalize(p1 - p0);
    const auto lid = [&](const Vec3& center, const Vec3& n) {
      const Frame frame(n);
      Mat4 m(0.0);
      const double phi = 2 * kPi * rng.uniform();
      m[0] = Vec4(0.7 * (std::cos(phi) * frame.s + std::sin(phi) * frame.t), 0);
      m[1] = Vec4(0.7 * (std::cos(phi) * frame.t - std::sin(phi) * frame.s), 0);
      m[2] = Vec4(n, 0);
      m[3] = Vec4(center, 1);
      return make_disk(Transform(m));
    };
    const BoundaryGroup can =
        group_of({make_cylinder(p0, p1, 0.7, Transform()), lid(p1, axis), lid(p0, -axis)});
    EXPECT_TRUE(can.closed());
    EXPECT_TRUE(can.defects().empty()) << can.defects()[0].message;
    EXPECT_NEAR(can.volume() / (kPi * sqr(0.7) * length(p1 - p0)), 1, 0.002);
  }
}

TEST(Boundary, WithoutALidIsOpen) {
  TriangleMeshData data = box(1);
  data.triangles.pop_back();
  const BoundaryGroup group = group_of({cube(1, {5, 0, 0}), make_mesh(data)});
  EXPECT_FALSE(group.closed());
  expect_one(group, Kind::Open, "3 border edges");
  EXPECT_EQ(group.defects()[0].shape, 1u);
  expect_one(group_of({make_rectangle(Transform())}), Kind::Open, "4 border edges");
}

TEST(Boundary, WithAFlippedTriangleIsInconsistent) {
  TriangleMeshData data = box(1);
  std::swap(data.triangles[3][0], data.triangles[3][1]);
  const BoundaryGroup group = group_of({make_mesh(data)});
  EXPECT_TRUE(group.closed());
  EXPECT_NEAR(group.volume(), 8, 1e-12);
  expect_one(group, Kind::InconsistentOrientation,
             "3 edges between triangles of opposite orientation");
}

TEST(Boundary, TurnedInsideOutIsNoticed) {
  expect_one(group_of({cube(1, Vec3(0), true)}), Kind::InsideOut, "1 closed piece is inside out");
  expect_one(group_of({make_sphere(Vec3(0), 1, true)}), Kind::InsideOut, "1 sphere is inside out");
  // The inner wall of a hollow that faces outwards.
  const BoundaryGroup hollow = group_of({cube(1), cube(0.5)});
  expect_one(hollow, Kind::InsideOut, "1 closed piece is inside out");
  EXPECT_EQ(hollow.defects()[0].shape, 1u);
  const BoundaryGroup spheres = group_of({make_sphere(Vec3(0), 2), make_sphere(Vec3(0), 1)});
  expect_one(spheres, Kind::InsideOut, "1 sphere is inside out");
  EXPECT_EQ(spheres.defects()[0].shape, 1u);
}

TEST(Boundary, ThatMeetsItselfIsNoticed) {
  const BoundaryGroup boxes = group_of({cube(1), cube(1, Vec3(0.5, 0.6, 0.7))});
  ASSERT_EQ(boxes.defects().size(), 2u);
  for (const auto& defect : boxes.defects()) {
    EXPECT_TRUE(defect.kind == Kind::SelfIntersecting || defect.kind == Kind::InsideOut);
  }
  EXPECT_EQ(boxes.defects()[0].kind, Kind::SelfIntersecting);
  expect_one(group_of({make_sphere(Vec3(0), 1), make_sphere({1.5, 0, 0}, 1)}),
             Kind::SelfIntersecting, "1 other sphere meets its surface");
}

TEST(Boundary, WithAFinIsNoManifold) {
  TriangleMeshData data = box(1);
  data.positions.push_back({3, 3, 3});
  const auto [a, b, c] = data.triangles[0];
  data.triangles.push_back({a, b, 8});
  const BoundaryGroup group = group_of({make_mesh(data)});
  bool found = false;
  for (const auto& defect : group.defects()) found |= defect.kind == Kind::NonManifold;
  EXPECT_TRUE(found);
  EXPECT_FALSE(group.closed());
}

TEST(Boundary, MadeOfSeveralShapesIsWelded) {
  // Six rectangles around a cube, placed with the rounding of a text file.
  std::vector<std::shared_ptr<const Shape>> walls;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      Mat4 m(0.0);
      m[0][(axis + 1) % 3] = side;
      m[1][(axis + 2) % 3] = 1;
      m[2][axis] = side;
      m[3] = Vec4(0, 0, 0, 1);
      m[3][axis] = side * (1 + 1e-7 * axis);
      walls.push_back(make_rectangle(Transform(m)));
    }
  const BoundaryGroup group =
      group_of({walls[0], walls[1], walls[2], walls[3], walls[4], walls[5]});
  EXPECT_TRUE(group.defects().empty()) << group.defects()[0].message;
  EXPECT_TRUE(group.closed());
  EXPECT_NEAR(group.volume(), 8, 1e-5);
}

TEST(Boundary, CrossesWhatItCutsThrough) {
  const auto a = group_of({cube(1)}), b = group_of({cube(1, Vec3(0.5, 0.6, 0.7))});
  EXPECT_TRUE(a.crosses(b));
  EXPECT_TRUE(b.crosses(a));
  // Nothing of a thin rod lies inside of the cube that it pierces but its own boundary.
  const auto rod = group_of({make_cube(Transform::scale({0.01, 0.01, 5}))});
  EXPECT_TRUE(rod.crosses(a));
  const auto ball = group_of({make_sphere(Vec3(1, 0, 0), 0.5)});
  EXPECT_TRUE(ball.crosses(a));
  EXPECT_TRUE(a.crosses(ball));
  // Nested, apart, or sharing a face.
  const auto inner = group_of({make_sphere(Vec3(0), 0.9)}), beside = group_of({cube(1, {2, 0, 0})}),
             within = group_of({cube(0.5, {0.5, 0, 0})});
  for (const auto* other : {&inner, &beside, &within}) {
    EXPECT_FALSE(other->crosses(a));
    EXPECT_FALSE(a.crosses(*other));
  }
}

TEST(Boundary, ContainsWhatIsInside) {
  const auto hollow_boxes = group_of({cube(1), cube(0.5, Vec3(0), true)});
  const auto hollow_spheres =
      group_of({make_sphere(Vec3(0), 1), make_sphere(Vec3(0.1, 0, 0), 0.5, true)});
  Rng rng(testing::suite_seed(), RngDomain::Test, 20, 0);
  int wrong = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = 2.4 * uniform3(rng) - 1.2;
    const double reach = max_component(glm::abs(p));
    wrong += hollow_boxes.contains(p) != (reach < 1 && reach > 0.5);
    wrong += hollow_spheres.contains(p) != (length(p) < 1 && length(p - Vec3(0.1, 0, 0)) > 0.5);
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace fogbow
