// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>

#include "core/geometry/shape.h"
#include "core/math/transform.h"

namespace fogbow {

/// World-space triangles; `normals` and `uvs` are empty or one per vertex.
struct TriangleMeshData {
  std::vector<Vec3> positions;
  std::vector<Vec3> normals;
  std::vector<Vec2> uvs;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<MeshAttribute> attributes{};
};

/// Smooth where normals are given. Degenerate triangles are dropped and counted in a warning.
/// Throws std::domain_error on indices out of range or non-finite data.
std::shared_ptr<const Shape> make_mesh(TriangleMeshData data);
/// Normals weighted by the angles at each vertex, for meshes that are to look smooth and bring
/// none.
std::vector<Vec3> vertex_normals(const TriangleMeshData& data);
/// `flip_normals` turns the inside out.
/// `to_object`: orthogonal, from the world to the axes of the texture coordinates (azimuth/2π,
/// polar angle/π).
std::shared_ptr<const Shape> make_sphere(const Vec3& center, double radius,
                                         bool flip_normals = false,
                                         const Mat3& to_object = Mat3(1.0));
/// The image of [−1,1]² × {0} with normal +z; exact.
std::shared_ptr<const Shape> make_rectangle(const Transform& to_world, bool flip_normals = false);
/// The image of [−1,1]³, normals outwards; exact.
std::shared_ptr<const Shape> make_cube(const Transform& to_world, bool flip_normals = false);

/// The image of the unit disk in z = 0 with normal +z, an ellipse; exact. uv is (radius,
/// azimuth/2π) on the unit disk.
std::shared_ptr<const Shape> make_disk(const Transform& to_world, bool flip_normals = false);
/// From p0 to p1, without caps, normals outwards; exact. Throws std::domain_error if its image
/// under `to_world` is no cylinder of circular section.
std::shared_ptr<const Shape> make_cylinder(const Vec3& p0, const Vec3& p1, double radius,
                                           const Transform& to_world, bool flip_normals = false);

}  // namespace fogbow
