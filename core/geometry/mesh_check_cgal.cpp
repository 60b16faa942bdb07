// SPDX-License-Identifier: GPL-3.0-or-later
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Side_of_triangle_mesh.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <map>
#include <unordered_map>

#include "core/geometry/mesh_check.h"
#include "core/geometry/sphere.h"
#include "core/geometry/welder.h"
#include "core/math/spread.h"
#include "core/util/check.h"

namespace fogbow {

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
using Side = CGAL::Side_of_triangle_mesh<SurfaceMesh, Kernel>;
using Triangle = std::array<std::uint32_t, 3>;

/// Vertices nearer than this times the radius of the group are one: files round coordinates.
constexpr double kWeld = 1e-6;
constexpr std::size_t kMostIntersections = 10000;
/// Points of a group and of each shape that are looked at, and how far from the surface, in parts
/// of the shape's size.
constexpr int kMostPoints = 4096, kLeastPoints = 16, kPointsOfShape = 256;
constexpr double kAside = 1e-4;

Point to_point(const Vec3& p) { return {p.x, p.y, p.z}; }

/// How often an edge is run through in each direction, and a triangle that has it.
struct EdgeUse {
  std::uint32_t forward = 0, backward = 0;
  std::uint32_t triangle = 0;
};

using Counts = std::map<std::uint32_t, std::size_t>;  ///< by shape

}  // namespace

struct BoundaryGroup::Impl {
  std::vector<BoundaryDefect> defects;
  std::vector<BorderEdge> borders;
  Bounds bounds;
  std::vector<std::array<Vec3, 2>> both_sides;  ///< of points spread over the surface
  std::vector<const Sphere*> spheres;           ///< all shapes of the group, where all are spheres
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> shape_of;  ///< of each triangle
  SurfaceMesh mesh;            ///< consistently oriented; faces in the order of `triangles`
  std::unique_ptr<Side> side;  ///< only if closed
  bool closed = false;
  double volume = 0;

  void report(BoundaryDefect::Kind kind, const Counts& counts, const std::string& one,
              const std::string& many) {
    for (const auto& [shape, count] : counts)
      defects.push_back({kind, shape, std::to_string(count) + " " + (count == 1 ? one : many)});
  }

  void spread_points(std::span<const Shape* const> shapes) {
    const int count =
        std::clamp(kMostPoints / static_cast<int>(shapes.size()), kLeastPoints, kPointsOfShape);
    for (const Shape* shape : shapes) {
      bounds.extend(shape->bounds());
      const double aside = kAside * shape->bounds().radius();
      for (int i = 0; i < count; ++i) {
        const SurfacePoint x = shape->sample(spread_point(i, count));
        both_sides.push_back({x.position + aside * x.n_g, x.position - aside * x.n_g});
      }
    }
  }

  // --- Spheres

  /// The number of other spheres around sphere i.
  std::size_t depth(std::size_t i) const {
    return static_cast<std::size_t>(std::ranges::count_if(spheres, [&](const Sphere* s) {
      return s != spheres[i] &&
             length(s->center() - spheres[i]->center()) + spheres[i]->radius() < s->radius();
    }));
  }

  void check_spheres() {
    closed = true;
    Counts inside_out, intersecting;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      const Sphere& a = *spheres[i];
      const bool hollow = depth(i) % 2 == 1;
      if (a.flipped() != hollow) ++inside_out[static_cast<std::uint32_t>(i)];
      volume += (hollow ? -4 : 4) * kPi / 3 * a.radius() * sqr(a.radius());
      for (std::size_t j = i + 1; j < spheres.size(); ++j) {
        const Sphere& b = *spheres[j];
        const double d = length(a.center() - b.center());
        if (d <= a.radius() + b.radius() && d >= std::fabs(a.radius() - b.radius()))
          ++intersecting[static_cast<std::uint32_t>(i)];
      }
    }
    report(BoundaryDefect::Kind::InsideOut, inside_out, "sphere is inside out",
           "spheres are inside out");
    report(BoundaryDefect::Kind::SelfIntersecting, intersecting, "other sphere meets its surface",
           "other spheres meet its surface");
  }

  // --- Polygons

  void weld(std::span<const Shape* const> shapes) {
    Bounds bounds;
    for (const Shape* shape : shapes) bounds.extend(shape->bounds());
    Welder welder(kWeld * bounds.radius());
    for (std::uint32_t s = 0; s < shapes.size(); ++s) {
      const Tessellation soup = shapes[s]->tessellate();
      std::vector<std::uint32_t> index;
      index.reserve(soup.vertices.size());
      for (const Vec3& p : soup.vertices) index.push_back(welder.add(p));
      for (const Triangle& t : soup.triangles) {
        const Triangle welded{index[t[0]], index[t[1]], index[t[2]]};
        if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;
        triangles.push_back(welded);
        shape_of.push_back(s);
      }
    }
    vertices = std::move(welder.vertices);
  }

  void add_border(std::uint64_t edge, std::uint32_t triangle) {
    const Vec3 &a = vertices[edge >> 32], &b = vertices[edge & 0xFFFFFFFFu];
    Vec3 inward(0);
    for (const std::uint32_t v : triangles[triangle]) inward += vertices[v] - a;
    const Vec3 along = normalize(b - a);
    inward -= dot(inward, along) * along;
    borders.push_back({shape_of[triangle], a, b, normalize(inward), normalize(normal(triangle))});
  }

  /// False if the orientation is inconsistent.
  bool check_edges() {
    std::unordered_map<std::uint64_t, EdgeUse> edges;
    edges.reserve(2 * triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = triangles[i][k], b = triangles[i][(k + 1) % 3];
        EdgeUse& use = edges[std::uint64_t{std::min(a, b)} << 32 | std::max(a, b)];
        ++(a < b ? use.forward : use.backward);
        use.triangle = static_cast<std::uint32_t>(i);
      }
    Counts open, crowded, inconsistent;
    for (const auto& [edge, use] : edges) {
      const std::uint32_t shape = shape_of[use.triangle];
      if (use.forward + use.backward == 1) {
        ++open[shape];
        add_border(edge, use.triangle);
      } else if (use.forward + use.backward > 2)
        ++crowded[shape];
      else if (use.forward != use.backward)
        ++inconsistent[shape];
    }
    report(BoundaryDefect::Kind::Open, open, "border edge", "border edges");
    report(BoundaryDefect::Kind::NonManifold, crowded, "edge of more than two triangles",
           "edges of more than two triangles");
    report(BoundaryDefect::Kind::InconsistentOrientation, inconsistent,
           "edge between triangles of opposite orientation",
           "edges between triangles of opposite orientation");
    return inconsistent.empty();
  }

  void build_mesh() {
    std::vector<Point> points;
    points.reserve(vertices.size());
    for (const Vec3& p : vertices) points.push_back(to_point(p));
    std::vector<std::vector<std::size_t>> polygons;
    polygons.reserve(triangles.size());
    for (const Triangle& t : triangles) polygons.push_back({t[0], t[1], t[2]});
    PMP::orient_polygon_soup(points, polygons);  // doubles vertices where it is not a manifold
    PMP::polygon_soup_to_polygon_mesh(points, polygons, mesh);
    FOGBOW_CHECK(mesh.number_of_faces() == triangles.size());
    closed = CGAL::is_closed(mesh);
  }

  bool share_vertex(std::uint32_t i, std::uint32_t j) const {
    return std::ranges::find_first_of(triangles[i], triangles[j]) != triangles[i].end();
  }
  bool adjacent_in_mesh(std::uint32_t i, std::uint32_t j) const {
    for (const auto v : mesh.vertices_around_face(mesh.halfedge(SurfaceMesh::Face_index(i))))
      for (const auto w : mesh.vertices_around_face(mesh.halfedge(SurfaceMesh::Face_index(j))))
        if (v == w) return true;
    return false;
  }

  /// False if it meets itself.
  bool check_self_intersection() {
    std::vector<std::pair<SurfaceMesh::Face_index, SurfaceMesh::Face_index>> pairs;
    PMP::self_intersections(mesh, std::back_inserter(pairs),
                            CGAL::parameters::maximum_number(kMostIntersections));
    Counts counts;
    for (const auto& [f, g] : pairs) {
      // Surfaces that touch in a vertex or an edge, which the mesh had to double, do not intersect.
      if (share_vertex(f, g) && !adjacent_in_mesh(f, g)) continue;
      ++counts[shape_of[f]];
    }
    report(BoundaryDefect::Kind::SelfIntersecting, counts, "pair of intersecting triangles",
           "pairs of intersecting triangles");
    return counts.empty();
  }

  Vec3 normal(std::size_t i) const {
    const auto& [a, b, c] = triangles[i];
    return cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
  }

  /// A point just outside every piece must be outside of the whole.
  void check_outside() {
    auto component = mesh.add_property_map<SurfaceMesh::Face_index, std::size_t>("f:c").first;
    const std::size_t count = PMP::connected_components(mesh, component);
    std::vector<std::size_t> largest(count, triangles.size());
    for (const auto f : mesh.faces()) {
      std::size_t& best = largest[component[f]];
      if (best == triangles.size() || length(normal(f)) > length(normal(best))) best = f;
    }
    Counts counts;
    for (const std::size_t f : largest) {
      const auto& [a, b, c] = triangles[f];
      const Vec3 n = normal(f);
      const Vec3 outside = (vertices[a] + vertices[b] + vertices[c]) / 3.0 +
                           1e-6 * std::sqrt(length(n)) * normalize(n);
      if ((*side)(to_point(outside)) == CGAL::ON_BOUNDED_SIDE) ++counts[shape_of[f]];
    }
    report(BoundaryDefect::Kind::InsideOut, counts, "closed piece is inside out",
           "closed pieces are inside out");
  }

  double signed_volume() const {
    double sum = 0;
    const Vec3& o = vertices.front();
    for (const auto f : mesh.faces()) {
      std::array<Vec3, 3> p;
      int k = 0;
      for (const auto v : mesh.vertices_around_face(mesh.halfedge(f)))
        p[k++] = Vec3(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z()) - o;
      sum += dot(p[0], cross(p[1], p[2])) / 6;
    }
    return sum;
  }

  void check_polygons(std::span<const Shape* const> shapes) {
    weld(shapes);
    const bool consistent = check_edges();
    build_mesh();
    const bool simple = check_self_intersection();
    if (!closed) return;
    volume = std::fabs(signed_volume());
    side = std::make_unique<Side>(mesh);
    // Of pieces that intersect, either side of a triangle may lie inside another.
    if (consistent && simple) check_outside();
  }
};

BoundaryGroup::BoundaryGroup(std::span<const Shape* const> shapes)
    : impl_(std::make_unique<Impl>()) {
  FOGBOW_CHECK(!shapes.empty());
  impl_->spread_points(shapes);
  for (const Shape* shape : shapes)
    if (const auto* sphere = dynamic_cast<const Sphere*>(shape)) impl_->spheres.push_back(sphere);
  if (impl_->spheres.size() == shapes.size()) {
    impl_->check_spheres();
  } else {
    impl_->spheres.clear();
    impl_->check_polygons(shapes);
  }
}
BoundaryGroup::~BoundaryGroup() = default;
BoundaryGroup::BoundaryGroup(BoundaryGroup&&) noexcept = default;
BoundaryGroup& BoundaryGroup::operator=(BoundaryGroup&&) noexcept = default;

const std::vector<BoundaryDefect>& BoundaryGroup::defects() const { return impl_->defects; }
const std::vector<BorderEdge>& BoundaryGroup::borders() const { return impl_->borders; }
bool BoundaryGroup::closed() const { return impl_->closed; }

double BoundaryGroup::volume() const {
  FOGBOW_CHECK(impl_->closed);
  return impl_->volume;
}

bool BoundaryGroup::contains(const Vec3& p) const {
  FOGBOW_CHECK(impl_->closed);
  if (impl_->side) return (*impl_->side)(to_point(p)) == CGAL::ON_BOUNDED_SIDE;
  // Spheres within spheres are holes.
  const auto around = std::ranges::count_if(
      impl_->spheres, [&](const Sphere* s) { return length(p - s->center()) < s->radius(); });
  return around % 2 == 1;
}

bool BoundaryGroup::crosses(const BoundaryGroup& other) const {
  if (!impl_->bounds.overlaps(other.impl_->bounds)) return false;
  bool inside = false, outside = false;
  for (const auto& [front, back] : impl_->both_sides) {
    const int sides = other.contains(front) + other.contains(back);
    inside |= sides == 2;
    outside |= sides == 0;
    if (inside && outside) return true;
  }
  return false;
}

bool BoundaryGroup::touches(const BoundaryGroup& other, double distance) const {
  const Bounds reach{impl_->bounds.lo - distance, impl_->bounds.hi + distance};
  if (!reach.overlaps(other.impl_->bounds)) return false;
  return std::ranges::any_of(impl_->both_sides, [&](const auto& sides) {
    const Vec3 x = 0.5 * (sides[0] + sides[1]), n = normalize(sides[0] - sides[1]);
    return other.contains(x + distance * n) != other.contains(x - distance * n);
  });
}

bool BoundaryGroup::lies_within(const BoundaryGroup& other) const {
  if (!impl_->bounds.overlaps(other.impl_->bounds)) return false;
  bool inside = false;
  for (const auto& [front, back] : impl_->both_sides) {
    const int sides = other.contains(front) + other.contains(back);
    if (sides == 0) return false;
    inside |= sides == 2;
  }
  return inside;
}

}  // namespace fogbow
