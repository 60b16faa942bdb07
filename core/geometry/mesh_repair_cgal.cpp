// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/border.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Polygon_mesh_processing/triangulate_hole.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "core/geometry/mesh_repair.h"
#include "core/geometry/welder.h"
#include "core/util/check.h"

namespace fogbow {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Triangle = std::array<std::uint32_t, 3>;

/// Vertices nearer than this times the radius of the mesh are one: files round coordinates.
constexpr double kWeld = 1e-6;
/// So are vertices on borders up to this, but not up to half the length of their edges.
constexpr double kCrack = 5e-3, kPartOfEdge = 0.4;
/// Holes larger than this, in radii of the mesh, are meant to be there, unless one triangle fills
/// them.
constexpr double kLargestHole = 0.25;

Vec3 to_vec3(const Point& p) { return {p.x(), p.y(), p.z()}; }

/// A mesh in two views: triangles over the vertices of the file, which carry attributes, and the
/// same over places.
class Repair {
 public:
  Repair(TriangleMeshData mesh, MeshRepair& done) : mesh_(std::move(mesh)), done_(done) {
    Bounds bounds;
    for (const Vec3& p : mesh_.positions) bounds.extend(p);
    radius_ = bounds.radius();
    source_.resize(mesh_.triangles.size());
    std::iota(source_.begin(), source_.end(), 0u);
    Welder welder(std::max(kWeld * radius_, 1e-300));
    for (const Vec3& p : mesh_.positions) place_.push_back(welder.add(p));
    places_ = std::move(welder.vertices);
  }

  TriangleMeshData run() {
    const TriangleMeshData original = mesh_;
    remove_useless();
    stitch();
    remove_useless();
    orient();
    fill_holes();
    done_.closed = CGAL::is_closed(surface_);
    if (done_.closed && !PMP::does_self_intersect(surface_))
      PMP::orient_to_bound_a_volume(surface_);
    collect();
    return done_.changed() ? std::move(mesh_) : original;
  }

 private:
  Triangle places(const Triangle& t) const { return {place_[t[0]], place_[t[1]], place_[t[2]]}; }

  void remove_useless() {
    std::set<Triangle> seen;
    const auto is_useless = [&](const Triangle& t) {
      Triangle p = places(t);
      std::ranges::sort(p);
      if (p[0] == p[1] || p[1] == p[2] || !seen.insert(p).second) return true;
      const Vec3 e1 = places_[p[1]] - places_[p[0]], e2 = places_[p[2]] - places_[p[0]];
      return length(cross(e1, e2)) == 0;
    };
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      if (is_useless(mesh_.triangles[i])) continue;
      mesh_.triangles[kept] = mesh_.triangles[i];
      source_[kept++] = source_[i];
    }
    done_.removed += mesh_.triangles.size() - kept;
    mesh_.triangles.resize(kept);
    source_.resize(kept);
  }

  // --- Cracks

  std::vector<std::pair<std::uint32_t, std::uint32_t>> borders() const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
    for (const Triangle& t : mesh_.triangles) {
      const Triangle p = places(t);
      for (int k = 0; k < 3; ++k) ++uses[std::minmax(p[k], p[(k + 1) % 3])];
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> result;
    for (const auto& [edge, count] : uses)
      if (count == 1) result.push_back(edge);
    return result;
  }

  /// Lets places on borders that nearly coincide be one; no two ends of an edge are.
  void stitch() {
    const auto before = borders();
    if (before.empty()) return;
    std::map<std::uint32_t, double> reach;
    for (const auto& [a, b] : before)
      for (const std::uint32_t v : {a, b}) {
        const double limit =
            std::min(kCrack * radius_, kPartOfEdge * length(places_[a] - places_[b]));
        const auto [entry, fresh] = reach.try_emplace(v, limit);
        entry->second = std::min(entry->second, limit);
      }
    std::vector<std::uint32_t> to(places_.size());
    for (std::uint32_t i = 0; i < to.size(); ++i) to[i] = i;
    std::vector<std::pair<double, std::uint32_t>> sorted;  // along x
    for (const auto& [v, limit] : reach) sorted.emplace_back(places_[v].x, v);
    std::ranges::sort(sorted);
    for (std::size_t i = 0; i < sorted.size(); ++i) {
      const std::uint32_t v = sorted[i].second;
      std::uint32_t nearest = v;
      double best = kInfinity;
      for (std::size_t j = i; j-- > 0 && sorted[i].first - sorted[j].first <= reach[v];) {
        const std::uint32_t w = sorted[j].second;
        const double distance = length(places_[w] - places_[v]);
        if (to[w] != w || distance > std::min(reach[v], reach[w]) || distance >= best) continue;
        best = distance;
        nearest = w;
      }
      to[v] = nearest;
    }
    for (std::uint32_t& place : place_) place = to[place];
    const std::size_t after = borders().size();
    done_.stitched = before.size() > after ? before.size() - after : 0;
  }

  // --- Orientation

  void orient() {
    std::vector<Point> points;
    std::vector<std::vector<std::size_t>> polygons;
    std::map<std::uint32_t, std::size_t> used;  // CGAL stumbles over vertices of no triangle
    for (const Triangle& t : mesh_.triangles) {
      polygons.emplace_back();
      for (const std::uint32_t place : places(t)) {
        const auto [entry, fresh] = used.try_emplace(place, points.size());
        const Vec3& p = places_[place];
        if (fresh) points.emplace_back(p.x, p.y, p.z);
        polygons.back().push_back(entry->second);
      }
    }
    PMP::orient_polygon_soup(points, polygons);  // doubles vertices where it is not a manifold
    PMP::polygon_soup_to_polygon_mesh(points, polygons, surface_);
    FOGBOW_CHECK(surface_.number_of_faces() == mesh_.triangles.size());
    // Most triangles keep their orientation.
    std::size_t against = 0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) against += is_turned(i);
    if (2 * against > mesh_.triangles.size()) PMP::reverse_face_orientations(surface_);
  }

  std::array<SurfaceMesh::Vertex_index, 3> corners(SurfaceMesh::Face_index face) const {
    std::array<SurfaceMesh::Vertex_index, 3> result;
    int k = 0;
    for (const auto v : surface_.vertices_around_face(surface_.halfedge(face))) result[k++] = v;
    return result;
  }

  /// The vertex of the file at a corner of one of its triangles.
  std::uint32_t vertex_at(std::size_t triangle, SurfaceMesh::Vertex_index corner) const {
    const Vec3 p = to_vec3(surface_.point(corner));
    for (const std::uint32_t v : mesh_.triangles[triangle])
      if (places_[place_[v]] == p) return v;
    FOGBOW_CHECK(false && "a corner of a triangle was lost");
    return 0;
  }

  bool is_turned(std::size_t i) const {
    const auto c = corners(SurfaceMesh::Face_index(static_cast<std::uint32_t>(i)));
    const Triangle& t = mesh_.triangles[i];
    const std::uint32_t first = vertex_at(i, c[0]), second = vertex_at(i, c[1]);
    for (int k = 0; k < 3; ++k)
      if (t[k] == first) return t[(k + 1) % 3] != second;
    return false;
  }

  // --- Holes

  void fill_holes() {
    std::vector<SurfaceMesh::Halfedge_index> cycles;
    PMP::extract_boundary_cycles(surface_, std::back_inserter(cycles));
    for (const auto h : cycles) {
      Bounds rim;
      std::size_t edges = 0;
      for (const auto e : CGAL::halfedges_around_face(h, surface_)) {
        rim.extend(to_vec3(surface_.point(surface_.target(e))));
        ++edges;
      }
      std::vector<SurfaceMesh::Face_index> patch;
      if (edges <= 3 || rim.radius() <= kLargestHole * radius_)
        PMP::triangulate_hole(surface_, h, std::back_inserter(patch));
      done_.filled += !patch.empty();
      done_.left_open += patch.empty();
      done_.added += patch.size();
    }
  }

  // --- Back to the file's vertices

  void collect() {
    const std::size_t count = mesh_.triangles.size();
    std::map<SurfaceMesh::Vertex_index, std::uint32_t> known, triangle_at;
    std::vector<Triangle> result;
    for (const auto face : surface_.faces()) {
      const std::size_t i = face;
      Triangle t;
      for (int k = 0; k < 3; ++k) {
        const auto corner = corners(face)[k];
        if (i < count) known[corner] = vertex_at(i, corner);
        if (i < count) triangle_at[corner] = source_[i];
        t[k] = known.at(corner);
      }
      result.push_back(t);
      if (i < count)
        done_.flipped += is_turned(i);
      else
        source_.push_back(triangle_at.at(corners(face)[0]));
    }
    mesh_.triangles = std::move(result);
    for (MeshAttribute& a : mesh_.attributes)
      if (a.per_primitive) follow_triangles(a);
    for (std::size_t v = 0; v < mesh_.positions.size(); ++v)
      mesh_.positions[v] = places_[place_[v]];
  }

  void follow_triangles(MeshAttribute& a) const {
    std::vector<float> values;
    const auto n = static_cast<std::size_t>(a.channels);
    for (const std::uint32_t i : source_)
      values.insert(values.end(), a.values.begin() + static_cast<std::ptrdiff_t>(i * n),
                    a.values.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
    a.values = std::move(values);
  }

  TriangleMeshData mesh_;
  MeshRepair& done_;
  double radius_ = 0;
  /// Of each triangle: the one of the file that it is, or, in a hole, one at its rim.
  std::vector<std::uint32_t> source_;
  std::vector<std::uint32_t> place_;  ///< of each vertex
  std::vector<Vec3> places_;
  SurfaceMesh surface_;  ///< faces in the order of the triangles, then those of holes
};

}  // namespace

TriangleMeshData repair_mesh(TriangleMeshData mesh, MeshRepair& done) {
  // What make_mesh refuses is left to it.
  for (const Vec3& p : mesh.positions)
    if (!is_finite(p)) return mesh;
  for (const Triangle& t : mesh.triangles)
    if (std::ranges::max(t) >= mesh.positions.size()) return mesh;
  if (mesh.triangles.empty()) return mesh;
  return Repair(std::move(mesh), done).run();
}

std::string MeshRepair::text() const {
  std::string all;
  const auto say = [&](std::size_t count, const char* one, const char* many) {
    if (count > 0)
      all += (all.empty() ? "" : ", ") + std::to_string(count) + " " + (count == 1 ? one : many);
  };
  say(stitched, "border edge stitched", "border edges stitched");
  say(removed, "triangle without area or there twice removed",
      "triangles without area or there twice removed");
  say(flipped, "triangle turned", "triangles turned");
  say(filled, "hole filled", "holes filled");
  if (filled > 0)
    all += " with " + std::to_string(added) + (added == 1 ? " triangle" : " triangles");
  say(left_open, "large hole left open", "large holes left open");
  return all.empty() ? "nothing to repair" : all + (closed ? "; now closed" : "; still open");
}

}  // namespace fogbow
