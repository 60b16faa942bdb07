// SPDX-License-Identifier: GPL-3.0-or-later
#include <limits>
#include <stdexcept>

#include "core/geometry/planar.h"
#include "core/geometry/shapes.h"
#include "core/math/discrete_distribution.h"
#include "core/math/warp.h"
#include "core/util/log.h"

namespace fogbow {

namespace {

/// Sine of a corner below which a triangle's normal is made of rounding.
constexpr double kDegenerate = 64 * 0x1p-53;

void validate(const TriangleMeshData& data) {
  const std::size_t n = data.positions.size();
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
  if (n > kMost || data.triangles.size() > kMost)
    throw std::domain_error("mesh has more vertices or triangles than 32 bits can name");
  if (!data.normals.empty() && data.normals.size() != n)
    throw std::domain_error("mesh has " + std::to_string(data.normals.size()) + " normals for " +
                            std::to_string(n) + " vertices");
  if (!data.uvs.empty() && data.uvs.size() != n)
    throw std::domain_error("mesh has " + std::to_string(data.uvs.size()) +
                            " texture coordinates for " + std::to_string(n) + " vertices");
  for (std::size_t i = 0; i < n; ++i) {
    if (!is_finite(data.positions[i]))
      throw std::domain_error("mesh vertex " + std::to_string(i) + " is not finite");
    if (!data.normals.empty() && !is_finite(data.normals[i]))
      throw std::domain_error("mesh normal " + std::to_string(i) + " is not finite");
    if (!data.uvs.empty() && !is_finite(Vec3(data.uvs[i], 0)))
      throw std::domain_error("mesh texture coordinate " + std::to_string(i) + " is not finite");
  }
  for (const MeshAttribute& a : data.attributes) {
    const std::size_t count = a.per_primitive ? data.triangles.size() : n;
    if ((a.channels != 1 && a.channels != 3) ||
        a.values.size() != count * static_cast<std::size_t>(a.channels))
      throw std::domain_error("mesh attribute " + a.name + " has the wrong number of values");
    for (const float value : a.values)
      if (!std::isfinite(value))
        throw std::domain_error("a value of mesh attribute " + a.name + " is not finite");
  }
  for (std::size_t i = 0; i < data.triangles.size(); ++i)
    for (const std::uint32_t v : data.triangles[i])
      if (v >= n)
        throw std::domain_error("mesh triangle " + std::to_string(i) + " names vertex " +
                                std::to_string(v) + " of " + std::to_string(n));
}

using Triangle = std::array<std::uint32_t, 3>;

struct Corners {
  Vec3 p, e1, e2;
};

/// Of positions in either precision; all arithmetic is in double.
template <class Position>
Corners corners(const std::vector<Position>& positions, const Triangle& triangle) {
  const Vec3 p(positions[triangle[0]]);
  return {p, Vec3(positions[triangle[1]]) - p, Vec3(positions[triangle[2]]) - p};
}

bool degenerate(const Corners& c) {
  const double edge = std::max({length(c.e1), length(c.e2), length(c.e2 - c.e1)});
  return !(length(cross(c.e1, c.e2)) > kDegenerate * edge * edge);
}

/// Vertices are kept in the single precision that Embree sees: the surface is one and the same for
/// both, and half as much memory is missed in caches.
class Mesh final : public Shape {
 public:
  explicit Mesh(TriangleMeshData data) {
    validate(data);
    positions_.reserve(data.positions.size() + 1);
    for (const Vec3& p : data.positions) positions_.emplace_back(p);
    normals_.reserve(data.normals.size());
    for (const Vec3& n : data.normals)
      normals_.emplace_back(length(n) > 0 ? normalize(n) : Vec3(0));
    triangles_ = std::move(data.triangles);
    uvs_ = std::move(data.uvs);
    attributes_ = std::move(data.attributes);
    drop_degenerate();
    std::vector<double> areas;
    areas.reserve(triangles_.size());
    for (const Triangle& triangle : triangles_) {
      const Corners c = corners(positions_, triangle);
      areas.push_back(0.5 * length(cross(c.e1, c.e2)));
      for (const std::uint32_t v : triangle) bounds_.extend(Vec3(positions_[v]));
    }
    area_ = DiscreteDistribution(areas);
    positions_.emplace_back(0.0f);  // padding, see PrimitiveBuffers
  }

  PrimitiveKind primitive_kind() const override { return PrimitiveKind::Triangles; }
  std::uint32_t primitive_count() const override {
    return static_cast<std::uint32_t>(triangles_.size());
  }
  PrimitiveBuffers buffers() const override {
    return {{positions_.data(), positions_.size() - 1},
            {triangles_.data()->data(), 3 * triangles_.size()}};
  }
  Bounds bounds() const override { return bounds_; }
  Bounds primitive_bounds(std::uint32_t primitive) const override {
    Bounds b;
    for (const std::uint32_t v : triangles_[primitive]) b.extend(Vec3(positions_[v]));
    return b;
  }
  bool polygonal() const override { return true; }

  std::optional<PrimitiveHit> intersect(std::uint32_t primitive, const Ray& ray,
                                        bool leaving) const override {
    if (leaving) return std::nullopt;
    const Corners c = corners(positions_, triangles_[primitive]);
    return detail::intersect_planar<detail::Outline::Triangle>(c.p, c.e1, c.e2, ray);
  }

  SurfacePoint surface_point(std::uint32_t primitive, const Vec2& local) const override {
    const Triangle& triangle = triangles_[primitive];
    const Corners c = corners(positions_, triangle);
    SurfacePoint x;
    x.position = c.p + local.x * c.e1 + local.y * c.e2;
    x.n_g = normalize(cross(c.e1, c.e2));
    x.shading = Frame(normals_.empty() ? x.n_g : shading_normal(triangle, local, x.n_g).n);
    x.uv = uvs_.empty() ? local : interpolate<Vec2>(uvs_, triangle, local);
    x.local = local;
    x.primitive = primitive;
    return x;
  }

  SurfaceDerivatives derivatives(const SurfacePoint& x) const override {
    const Triangle& triangle = triangles_[x.primitive];
    const Corners c = corners(positions_, triangle);
    SurfaceDerivatives d{c.e1, c.e2, Vec3(0), Vec3(0)};
    if (normals_.empty()) return d;
    const ShadingNormal s = shading_normal(triangle, x.local, x.n_g);
    if (s.scale == 0) return d;
    // d(N/|N|) = (dN − n (n·dN))/|N|, with N linear in the barycentrics.
    const Vec3 du = s.scale * (Vec3(normals_[triangle[1]]) - Vec3(normals_[triangle[0]]));
    const Vec3 dv = s.scale * (Vec3(normals_[triangle[2]]) - Vec3(normals_[triangle[0]]));
    d.dn_du = du - s.n * dot(s.n, du);
    d.dn_dv = dv - s.n * dot(s.n, dv);
    return d;
  }

  std::array<Vec2, 2> uv_derivatives(const SurfacePoint& x) const override {
    if (uvs_.empty()) return Shape::uv_derivatives(x);
    const Triangle& t = triangles_[x.primitive];
    return {uvs_[t[1]] - uvs_[t[0]], uvs_[t[2]] - uvs_[t[0]]};
  }

  double area() const override { return area_.total(); }
  SurfacePoint sample(const Vec2& u) const override {
    const std::size_t i = area_.sample(u.x);
    const double within = (u.x - area_.invert(i, 0)) / area_.probability(i);
    return surface_point(static_cast<std::uint32_t>(i),
                         warp::sample_triangle({warp::clamp_unit(within), u.y}));
  }
  Vec2 invert(const SurfacePoint& x) const override {
    const Vec2 u = warp::invert_triangle(x.local);
    return {area_.invert(x.primitive, u.x), u.y};
  }

  std::span<const MeshAttribute> attributes() const override { return attributes_; }
  RGB attribute(const SurfacePoint& x, const MeshAttribute& a) const override {
    const auto value = [&](std::size_t i) {
      if (a.channels == 1) return RGB(a.values[i]);
      return RGB(a.values[3 * i], a.values[3 * i + 1], a.values[3 * i + 2]);
    };
    if (a.per_primitive) return value(x.primitive);
    const Triangle& t = triangles_[x.primitive];
    const RGB first = value(t[0]);
    return first + x.local.x * (value(t[1]) - first) + x.local.y * (value(t[2]) - first);
  }

  Tessellation tessellate() const override {
    return {{positions_.begin(), positions_.end() - 1}, triangles_};
  }

 private:
  /// The unit normal, and its ratio to the interpolated one; 0 where that says nothing.
  struct ShadingNormal {
    Vec3 n;
    double scale;
  };

  void drop_degenerate() {
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < triangles_.size(); ++i)
      if (!degenerate(corners(positions_, triangles_[i]))) kept.push_back(i);
    const std::size_t dropped = triangles_.size() - kept.size();
    for (std::size_t i = 0; dropped > 0 && i < kept.size(); ++i) {
      triangles_[i] = triangles_[kept[i]];
      for (MeshAttribute& a : attributes_)
        for (int c = 0; a.per_primitive && c < a.channels; ++c)
          a.values[i * a.channels + c] = a.values[kept[i] * a.channels + c];
    }
    triangles_.resize(kept.size());
    if (dropped > 0)
      log_warning("mesh: dropped " + std::to_string(dropped) + " triangles without area");
    if (triangles_.empty()) throw std::domain_error("mesh has no triangle with an area");
  }

  template <class Result, class T>
  static Result interpolate(const std::vector<T>& values, const Triangle& triangle, const Vec2& b) {
    const Result origin(values[triangle[0]]);
    return origin + b.x * (Result(values[triangle[1]]) - origin) +
           b.y * (Result(values[triangle[2]]) - origin);
  }

  /// Turned to the side of n_g where the mesh's normals point behind its surface.
  ShadingNormal shading_normal(const Triangle& triangle, const Vec2& b, const Vec3& n_g) const {
    const Vec3 N = interpolate<Vec3>(normals_, triangle, b);
    const double norm = length(N), side = dot(N, n_g);
    if (!(std::fabs(side) > kDegenerate * norm)) return {n_g, 0};
    const double scale = std::copysign(1 / norm, side);
    return {scale * N, scale};
  }

  std::vector<glm::vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::vector<Triangle> triangles_;
  std::vector<MeshAttribute> attributes_;
  DiscreteDistribution area_;
  Bounds bounds_;
};

}  // namespace

std::shared_ptr<const Shape> make_mesh(TriangleMeshData data) {
  return std::make_shared<Mesh>(std::move(data));
}

std::vector<Vec3> vertex_normals(const TriangleMeshData& data) {
  std::vector<Vec3> normals(data.positions.size(), Vec3(0));
  for (const auto& triangle : data.triangles) {
    const Corners c = corners(data.positions, triangle);
    if (degenerate(c)) continue;
    const Vec3 n = normalize(cross(c.e1, c.e2));
    for (int i = 0; i < 3; ++i) {
      const Vec3& p = data.positions[triangle[i]];
      const Vec3 a = data.positions[triangle[(i + 1) % 3]] - p;
      const Vec3 b = data.positions[triangle[(i + 2) % 3]] - p;
      normals[triangle[i]] += std::atan2(length(cross(a, b)), dot(a, b)) * n;
    }
  }
  for (Vec3& n : normals)
    if (length(n) > 0) n = normalize(n);
  return normals;
}

}  // namespace fogbow
