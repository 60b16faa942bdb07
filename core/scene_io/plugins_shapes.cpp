// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "core/geometry/mesh_repair.h"
#include "core/geometry/shapes.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/mesh_file.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

constexpr std::uint64_t kMaxMeshBytes = std::uint64_t{8} << 30;

std::shared_ptr<const Shape> sphere(Properties& p, const FileContext& context) {
  const Vec3 center = p.point("center", Vec3(0));
  const double radius = p.positive_number("radius", 1);
  const Transform to_world = p.transform("to_world");
  const double scale = to_world.similarity_scale();
  if (!(scale > 0))
    p.fail("to_world", "a sphere's \"to_world\" must scale alike in all directions");
  const bool flip = p.boolean("flip_normals", false);
  // A mirror image shows the inside, as in Mitsuba; a mirrored instance does not.
  const bool inside_out = to_world.flips_orientation() != context.mirrored;
  return make_sphere(to_world.point(center), scale * radius, flip != inside_out,
                     scale * Mat3(to_world.inverse_matrix()));
}

std::shared_ptr<const Shape> rectangle(Properties& p, const FileContext&) {
  const Transform to_world = p.transform("to_world");
  return make_rectangle(to_world, p.boolean("flip_normals", false));
}

std::shared_ptr<const Shape> cube(Properties& p, const FileContext&) {
  const Transform to_world = p.transform("to_world");
  return make_cube(to_world, p.boolean("flip_normals", false));
}

std::shared_ptr<const Shape> disk(Properties& p, const FileContext&) {
  const Transform to_world = p.transform("to_world");
  return make_disk(to_world, p.boolean("flip_normals", false));
}

std::shared_ptr<const Shape> cylinder(Properties& p, const FileContext&) {
  const Vec3 p0 = p.point("p0", Vec3(0)), p1 = p.point("p1", Vec3(0, 0, 1));
  const double radius = p.positive_number("radius", 1);
  const Transform to_world = p.transform("to_world");
  return make_cylinder(p0, p1, radius, to_world, p.boolean("flip_normals", false));
}

void flip_winding(TriangleMeshData& mesh) {
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
}

/// Whether most of the surface winds against the normals that the file brings.
bool winds_against_normals(const TriangleMeshData& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 area =
        cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
    sum += dot(area, mesh.normals[a] + mesh.normals[b] + mesh.normals[c]);
  }
  return sum < 0;
}

void to_world_space(TriangleMeshData& mesh, const Transform& to_world) {
  for (Vec3& p : mesh.positions) p = to_world.point(p);
  for (Vec3& n : mesh.normals)
    if (!is_black(n)) n = normalize(to_world.normal(n));
}

/// Normals for vertices that have none among others that do.
void fill_normals(TriangleMeshData& mesh) {
  bool missing = mesh.normals.empty();
  for (const Vec3& n : mesh.normals) missing = missing || is_black(n);
  if (!missing) return;
  const std::vector<Vec3> computed = vertex_normals(mesh);
  mesh.normals.resize(computed.size(), Vec3(0));
  for (std::size_t i = 0; i < computed.size(); ++i)
    if (is_black(mesh.normals[i])) mesh.normals[i] = computed[i];
}

std::shared_ptr<const Shape> mesh_shape(Properties& p, const FileContext& context,
                                        TriangleMeshData mesh, bool flip_uvs, bool flat = false) {
  const Transform to_world = p.transform("to_world");
  const bool face_normals = p.boolean("face_normals", false) || flat;
  const bool flip_normals = p.boolean("flip_normals", false);
  if (p.boolean("flip_tex_coords", flip_uvs))
    for (Vec2& uv : mesh.uvs) uv.y = 1 - uv.y;
  if (face_normals) mesh.normals.clear();
  to_world_space(mesh, to_world);
  // The front is where the file's normals point, as in Mitsuba, also after a reflection.
  if (mesh.normals.empty() ? context.mirrored : winds_against_normals(mesh)) flip_winding(mesh);
  if (p.boolean("repair", false) || context.repair) {
    MeshRepair done;
    mesh = repair_mesh(std::move(mesh), done);
    if (done.changed() || done.left_open > 0) context.repaired(done.text());
  }
  if (!face_normals) fill_normals(mesh);
  if (flip_normals) {
    flip_winding(mesh);
    for (Vec3& n : mesh.normals) n = -n;
  }
  return make_mesh(std::move(mesh));
}

std::string read_mesh_bytes(Properties& p, const FileContext& context, std::string& path) {
  const std::string name = p.required_string("filename");
  const SourceLocation& where = p.where("filename");
  const auto file = context.files.resolve(name, where);
  std::string bytes = read_file(file, kMaxMeshBytes, where);
  context.hash.add(bytes);
  path = file.string();
  return bytes;
}

std::shared_ptr<const Shape> ply(Properties& p, const FileContext& context) {
  std::string path;
  const std::string bytes = read_mesh_bytes(p, context, path);
  return mesh_shape(p, context, parse_ply(bytes, path), false);
}

std::shared_ptr<const Shape> obj(Properties& p, const FileContext& context) {
  std::string path;
  const std::string bytes = read_mesh_bytes(p, context, path);
  return mesh_shape(p, context, parse_obj(bytes, path), true);
}

std::shared_ptr<const Shape> serialized(Properties& p, const FileContext& context) {
  const std::int64_t index = p.integer("shape_index", 0);
  if (index < 0) p.fail("shape_index", "\"shape_index\" must not be negative");
  std::string path;
  const std::string bytes = read_mesh_bytes(p, context, path);
  SerializedMesh file = parse_serialized(bytes, path, index);
  return mesh_shape(p, context, std::move(file.mesh), false, file.face_normals);
}

}  // namespace

const PluginTable<std::shared_ptr<const Shape>(Properties&, const FileContext&)>& shape_plugins() {
  static const PluginTable<std::shared_ptr<const Shape>(Properties&, const FileContext&)> table{
      {"sphere", sphere}, {"rectangle", rectangle},  {"cube", cube},
      {"disk", disk},     {"cylinder", cylinder},    {"ply", ply},
      {"obj", obj},       {"serialized", serialized}};
  return table;
}

}  // namespace fogbow
