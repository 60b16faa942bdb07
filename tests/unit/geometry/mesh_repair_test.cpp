// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/mesh_repair.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/geometry/mesh_check.h"
#include "core/math/random.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/geometry/shape_cases.h"

namespace fogbow {
namespace {

/// With normals and texture coordinates that tell the vertices apart.
TriangleMeshData ball() {
  TriangleMeshData mesh = testing::mesh_data(*make_sphere({1, 2, 3}, 2));
  mesh.normals.clear();
  for (const Vec3& p : mesh.positions) {
    mesh.normals.push_back(normalize(p - Vec3(1, 2, 3)));
    mesh.uvs.emplace_back(p.x, p.y + 10 * p.z);
  }
  return mesh;
}

double volume(const TriangleMeshData& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles)
    sum += dot(mesh.positions[a], cross(mesh.positions[b], mesh.positions[c])) / 6;
  return sum;
}

/// Every triangle with vertices of its own, up to `crack` away from where they were.
TriangleMeshData cracked(const TriangleMeshData& mesh, double crack) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 60, 0);
  TriangleMeshData result;
  for (const auto& triangle : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (const std::uint32_t v : triangle) {
      result.positions.push_back(mesh.positions[v] + crack * (2.0 * uniform3(rng) - 1.0));
      result.normals.push_back(mesh.normals[v]);
      result.uvs.push_back(mesh.uvs[v]);
    }
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

/// A closed boundary of the volume; all vertices have kept what they had.
void expect_sound(const TriangleMeshData& mesh, const TriangleMeshData& before, double tolerance) {
  const auto shape = make_mesh(mesh);
  const Shape* list[] = {shape.get()};
  const BoundaryGroup group(list);
  EXPECT_TRUE(group.closed());
  for (const BoundaryDefect& defect : group.defects()) ADD_FAILURE() << defect.message;
  EXPECT_NEAR(volume(mesh), volume(ball()), tolerance * volume(ball()));
  EXPECT_EQ(mesh.normals, before.normals);
  EXPECT_EQ(mesh.uvs, before.uvs);
}

TEST(Repair, LeavesASoundMeshAlone) {
  MeshRepair done;
  const TriangleMeshData before = ball(), after = repair_mesh(before, done);
  EXPECT_FALSE(done.changed());
  EXPECT_TRUE(done.closed);
  EXPECT_EQ(after.positions, before.positions);
  EXPECT_EQ(after.triangles, before.triangles);
  EXPECT_EQ(done.text(), "nothing to repair");
}

TEST(Repair, StitchesCracks) {
  MeshRepair done;
  const TriangleMeshData before = cracked(ball(), 1e-3), after = repair_mesh(before, done);
  EXPECT_EQ(done.stitched, 3 * ball().triangles.size());
  EXPECT_EQ(done.filled, 0u);
  expect_sound(after, before, 2e-3);
}

/// What a file says of its triangles stays with them when others go; a hole takes a neighbour's.
TEST(Repair, KeepsWhatTrianglesAndVerticesSay) {
  const auto middle = [](const TriangleMeshData& mesh, const std::array<std::uint32_t, 3>& t) {
    return static_cast<float>(mesh.positions[t[0]].x + mesh.positions[t[1]].x +
                              mesh.positions[t[2]].x);
  };
  TriangleMeshData before = ball();
  before.triangles.insert(before.triangles.begin() + 5, before.triangles[2]);  // a double
  before.triangles.erase(before.triangles.begin() + 40);                       // a hole
  MeshAttribute of_triangles{"face_x", 1, true, {}}, of_vertices{"vertex_p", 3, false, {}};
  for (const auto& t : before.triangles) of_triangles.values.push_back(middle(before, t));
  for (const Vec3& p : before.positions)
    for (int c = 0; c < 3; ++c) of_vertices.values.push_back(static_cast<float>(p[c]));
  before.attributes = {of_triangles, of_vertices};

  MeshRepair done;
  const TriangleMeshData after = repair_mesh(before, done);
  EXPECT_EQ(done.removed, 1u);
  EXPECT_EQ(done.added, 1u);
  ASSERT_EQ(after.attributes.size(), 2u);
  EXPECT_EQ(after.attributes[1].values, of_vertices.values);
  const std::vector<float>& values = after.attributes[0].values;
  const std::size_t count = after.triangles.size();
  ASSERT_EQ(values.size(), count);
  for (std::size_t i = 0; i + 1 < count; ++i)
    EXPECT_EQ(values[i], middle(after, after.triangles[i])) << i;
  const bool of_a_neighbour = std::any_of(after.triangles.begin(), after.triangles.end() - 1,
                                          [&](const std::array<std::uint32_t, 3>& t) {
                                            const auto& last = after.triangles.back();
                                            return middle(after, t) == values.back() &&
                                                   std::ranges::find_first_of(t, last) != t.end();
                                          });
  EXPECT_TRUE(of_a_neighbour);
}

TEST(Repair, TurnsTrianglesOutwards) {
  TriangleMeshData before = ball();
  for (std::size_t i = 0; i < before.triangles.size(); i += 7)
    std::swap(before.triangles[i][0], before.triangles[i][1]);
  MeshRepair done;
  const TriangleMeshData after = repair_mesh(before, done);
  EXPECT_EQ(done.flipped, (before.triangles.size() + 6) / 7);
  expect_sound(after, before, 1e-12);
  before = ball();
  for (auto& t : before.triangles) std::swap(t[0], t[1]);
  MeshRepair all;
  expect_sound(repair_mesh(before, all), before, 1e-12);
  EXPECT_EQ(all.flipped, before.triangles.size());
}

TEST(Repair, FillsSmallHoles) {
  TriangleMeshData before = ball();
  before.triangles.erase(before.triangles.begin() + 1000);
  const std::uint32_t gone = before.triangles[300][0];  // and all around one vertex
  const std::size_t ring = std::erase_if(
      before.triangles, [&](const auto& t) { return std::ranges::count(t, gone) > 0; });
  MeshRepair done;
  const TriangleMeshData after = repair_mesh(before, done);
  EXPECT_EQ(done.filled, 2u);
  EXPECT_EQ(done.added, 1 + ring - 2);
  EXPECT_EQ(done.left_open, 0u);
  expect_sound(after, before, 1e-3);
}

TEST(Repair, RemovesWhatIsNoTriangleOrThereTwice) {
  TriangleMeshData before = ball();
  const auto [a, b, c] = before.triangles[5];
  before.triangles.push_back({a, b, a});
  before.triangles.push_back({b, c, a});
  before.triangles.push_back({c, b, a});
  MeshRepair done;
  const TriangleMeshData after = repair_mesh(before, done);
  EXPECT_EQ(done.removed, 3u);
  expect_sound(after, before, 1e-12);
}

TEST(Repair, DoesAllOfItAtOnceAndNothingTheSecondTime) {
  TriangleMeshData before = cracked(ball(), 5e-4);
  for (std::size_t i = 3; i < before.triangles.size(); i += 11)
    std::swap(before.triangles[i][1], before.triangles[i][2]);
  before.triangles.erase(before.triangles.begin() + 77);
  before.triangles.push_back(before.triangles[500]);
  MeshRepair done, again;
  const TriangleMeshData after = repair_mesh(before, done);
  EXPECT_EQ(done.filled, 1u);
  EXPECT_EQ(done.removed, 1u);
  expect_sound(after, before, 2e-3);
  EXPECT_EQ(done.text(), std::to_string(done.stitched) +
                             " border edges stitched, 1 triangle without area or " +
                             "there twice removed, " + std::to_string(done.flipped) +
                             " triangles turned, 1 hole filled with 1 triangle; now closed");
  EXPECT_EQ(repair_mesh(after, again).triangles, after.triangles);
  EXPECT_FALSE(again.changed());
}

TEST(Repair, LeavesLargeHolesOpen) {
  TriangleMeshData before = ball();
  std::erase_if(before.triangles, [&](const auto& t) { return before.positions[t[0]].z > 3.2; });
  MeshRepair done;
  const TriangleMeshData after = repair_mesh(before, done);
  EXPECT_FALSE(done.changed());
  EXPECT_FALSE(done.closed);
  EXPECT_EQ(done.left_open, 1u);
  EXPECT_EQ(after.triangles, before.triangles);
  EXPECT_EQ(done.text(), "1 large hole left open; still open");
}

}  // namespace
}  // namespace fogbow
