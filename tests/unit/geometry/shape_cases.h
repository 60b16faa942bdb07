// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "core/geometry/shapes.h"
#include "core/math/random.h"
#include "core/math/warp.h"

namespace fogbow::testing {

struct ShapeCase {
  std::string name;
  std::shared_ptr<const Shape> shape;
};

inline Transform skewed(double scale, const Vec3& offset) {
  Mat4 shear(1.0);
  shear[1][0] = 0.4;
  return Transform::translate(offset) * Transform::rotate({1, 2, 3}, 37) * Transform(shear) *
         Transform::scale(scale * Vec3(1, 0.6, 1.7));
}

inline std::pair<Vec3, Vec3> cylinder_ends(double scale, const Vec3& offset) {
  const Vec3 half = scale * Vec3(0.3, -0.8, 0.6);
  return {offset - half, offset + half};
}

inline std::shared_ptr<const Shape> cylinder(double scale, const Vec3& offset, bool flip = false) {
  const auto [p0, p1] = cylinder_ends(scale, offset);
  return make_cylinder(p0, p1, 0.7 * scale, Transform(), flip);
}

/// The same cylinder as the mirror image of another: its azimuth runs the other way.
inline std::shared_ptr<const Shape> mirrored_cylinder(double scale, const Vec3& offset) {
  const Transform mirror = Transform::scale({-1, 1, 1});
  const auto [p0, p1] = cylinder_ends(scale, offset);
  return make_cylinder(mirror.point(p0), mirror.point(p1), 0.7 * scale, mirror, false);
}

inline TriangleMeshData mesh_data(const Shape& shape) {
  Tessellation t = shape.tessellate();
  return {std::move(t.vertices), {}, {}, std::move(t.triangles)};
}

/// An ellipsoid of triangles, skewed, with smooth normals.
inline TriangleMeshData ellipsoid_data(double scale, const Vec3& offset) {
  TriangleMeshData data = mesh_data(*make_sphere(Vec3(0), 1));
  const Transform to_world = skewed(scale, offset);
  for (Vec3& p : data.positions) p = to_world.point(p);
  data.normals = vertex_normals(data);
  return data;
}

/// Convex closed surfaces, a few units of `scale` across, around `offset`.
inline std::vector<ShapeCase> convex_cases(double scale, const Vec3& offset) {
  const auto cube = make_cube(skewed(scale, offset));
  // Along the axes: its faces stay flat when a mesh rounds the corners to single precision.
  const auto upright = make_cube(Transform::translate(offset) * Transform::scale(Vec3(scale)));
  return {{"sphere", make_sphere(offset, 1.3 * scale)},
          {"cube", cube},
          {"mesh box", make_mesh(mesh_data(*upright))},
          {"mesh ellipsoid", make_mesh(ellipsoid_data(scale, offset))}};
}

inline std::vector<ShapeCase> all_cases(double scale, const Vec3& offset) {
  std::vector<ShapeCase> cases = convex_cases(scale, offset);
  cases.push_back({"rectangle", make_rectangle(skewed(scale, offset))});
  cases.push_back(
      {"mirrored rectangle", make_rectangle(skewed(scale, offset) * Transform::scale({-1, 1, 1}))});
  cases.push_back({"flipped cube", make_cube(skewed(scale, offset), true)});
  cases.push_back({"disk", make_disk(skewed(scale, offset))});
  cases.push_back(
      {"mirrored disk", make_disk(skewed(scale, offset) * Transform::scale({-1, 1, 1}))});
  cases.push_back({"cylinder", cylinder(scale, offset)});
  cases.push_back({"flipped cylinder", cylinder(scale, offset, true)});
  cases.push_back({"mirrored cylinder", mirrored_cylinder(scale, offset)});
  cases.push_back({"flipped sphere", make_sphere(offset, 0.7 * scale, true)});
  TriangleMeshData behind = ellipsoid_data(scale, offset);
  for (Vec3& n : behind.normals) n = -n;
  cases.push_back({"mesh with normals behind", make_mesh(std::move(behind))});
  TriangleMeshData faceted = ellipsoid_data(scale, offset);
  faceted.normals.clear();
  cases.push_back({"faceted mesh", make_mesh(std::move(faceted))});
  return cases;
}

/// 10^x with x uniform on [from, to].
inline double log_uniform(Rng& rng, double from, double to) {
  return std::pow(10, from + (to - from) * rng.uniform());
}

}  // namespace fogbow::testing
