// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/planar.h"
#include "core/geometry/shapes.h"
#include "core/math/discrete_distribution.h"
#include "core/math/warp.h"

namespace fogbow {

namespace {

/// Corners in the order (0,0), (1,0), (1,1), (0,1) of the local coordinates.
using Face = std::array<std::uint32_t, 4>;

/// A list of parallelograms. `sign` tells on which side of e1 × e2 the outside lies.
class Quads final : public Shape {
 public:
  Quads(std::vector<Vec3> corners, const std::vector<Face>& faces, double sign)
      : corners_(std::move(corners)), faces_(faces), sign_(sign) {
    std::vector<double> areas;
    for (std::uint32_t i = 0; i < faces_.size(); ++i)
      areas.push_back(length(cross(edge1(i), edge2(i))));
    area_ = DiscreteDistribution(areas);
    for (const Vec3& p : corners_) floats_.emplace_back(p);
    floats_.emplace_back(0.0f);  // padding, see PrimitiveBuffers
  }

  PrimitiveKind primitive_kind() const override { return PrimitiveKind::Quads; }
  std::uint32_t primitive_count() const override {
    return static_cast<std::uint32_t>(faces_.size());
  }
  PrimitiveBuffers buffers() const override {
    return {{floats_.data(), floats_.size() - 1}, {faces_.data()->data(), 4 * faces_.size()}};
  }
  Bounds bounds() const override {
    Bounds b;
    for (const Vec3& p : corners_) b.extend(p);
    return b;
  }
  Bounds primitive_bounds(std::uint32_t primitive) const override {
    Bounds b;
    for (const std::uint32_t v : faces_[primitive]) b.extend(corners_[v]);
    return b;
  }
  bool polygonal() const override { return true; }

  std::optional<PrimitiveHit> intersect(std::uint32_t primitive, const Ray& ray,
                                        bool leaving) const override {
    if (leaving) return std::nullopt;
    return detail::intersect_planar<detail::Outline::Parallelogram>(
        origin(primitive), edge1(primitive), edge2(primitive), ray);
  }

  SurfacePoint surface_point(std::uint32_t primitive, const Vec2& local) const override {
    const Vec3 e1 = edge1(primitive), e2 = edge2(primitive);
    SurfacePoint x;
    x.position = origin(primitive) + local.x * e1 + local.y * e2;
    x.n_g = sign_ * normalize(cross(e1, e2));
    x.shading = Frame(x.n_g);
    x.uv = x.local = local;
    x.primitive = primitive;
    return x;
  }
  SurfaceDerivatives derivatives(const SurfacePoint& x) const override {
    return {edge1(x.primitive), edge2(x.primitive), Vec3(0), Vec3(0)};
  }

  double area() const override { return area_.total(); }
  SurfacePoint sample(const Vec2& u) const override {
    const std::size_t i = area_.sample(u.x);
    const double within = (u.x - area_.invert(i, 0)) / area_.probability(i);
    return surface_point(static_cast<std::uint32_t>(i), {warp::clamp_unit(within), u.y});
  }
  Vec2 invert(const SurfacePoint& x) const override {
    return {area_.invert(x.primitive, warp::clamp_unit(x.local.x)), warp::clamp_unit(x.local.y)};
  }

  Tessellation tessellate() const override {
    Tessellation result{corners_, {}};
    for (const Face& f : faces_) {
      result.triangles.push_back({f[0], f[1], f[2]});
      result.triangles.push_back({f[0], f[2], f[3]});
    }
    if (sign_ < 0)
      for (auto& t : result.triangles) std::swap(t[1], t[2]);
    return result;
  }

 private:
  const Vec3& origin(std::uint32_t i) const { return corners_[faces_[i][0]]; }
  Vec3 edge1(std::uint32_t i) const { return corners_[faces_[i][1]] - origin(i); }
  Vec3 edge2(std::uint32_t i) const { return corners_[faces_[i][3]] - origin(i); }

  std::vector<Vec3> corners_;
  std::vector<Face> faces_;
  double sign_;
  std::vector<glm::vec3> floats_;
  DiscreteDistribution area_;
};

std::shared_ptr<const Shape> make_quads(const Transform& to_world, std::vector<Vec3> corners,
                                        const std::vector<Face>& faces, bool inward) {
  for (Vec3& p : corners) p = to_world.point(p);
  const double sign = to_world.flips_orientation() != inward ? -1 : 1;
  return std::make_shared<Quads>(std::move(corners), faces, sign);
}

}  // namespace

std::shared_ptr<const Shape> make_rectangle(const Transform& to_world, bool flip_normals) {
  return make_quads(to_world, {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {{0, 1, 2, 3}},
                    flip_normals);
}

std::shared_ptr<const Shape> make_cube(const Transform& to_world, bool flip_normals) {
  // Faces as Mitsuba lays texture coordinates on them; u × v points inwards on all.
  std::vector<Vec3> corners;  // bit i of the index is the sign along axis i
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  return make_quads(
      to_world, std::move(corners),
      {{0, 2, 6, 4}, {5, 7, 3, 1}, {0, 4, 5, 1}, {7, 6, 2, 3}, {2, 0, 1, 3}, {4, 6, 7, 5}},
      !flip_normals);
}

}  // namespace fogbow
