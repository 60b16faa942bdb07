// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/geometry/circle.h"
#include "core/geometry/planar.h"
#include "core/geometry/shapes.h"
#include "core/math/warp.h"

namespace fogbow {

namespace {

/// The image of the unit disk: an ellipse. `local` are the coordinates on the unit disk.
class Disk final : public Shape {
 public:
  Disk(const Transform& to_world, bool flip_normals)
      : center_(to_world.point(Vec3(0))),
        e1_(to_world.vector({1, 0, 0})),
        e2_(to_world.vector({0, 1, 0})),
        across_(cross(e1_, e2_)),
        n_((flip_normals != to_world.flips_orientation() ? -1.0 : 1.0) * normalize(across_)),
        edges_(length(e1_) + length(e2_)) {}

  PrimitiveKind primitive_kind() const override { return PrimitiveKind::Analytic; }
  std::uint32_t primitive_count() const override { return 1; }
  PrimitiveBuffers buffers() const override { return {}; }
  Bounds bounds() const override {
    const Vec3 reach = glm::sqrt(e1_ * e1_ + e2_ * e2_);
    return {center_ - reach, center_ + reach};
  }
  Bounds primitive_bounds(std::uint32_t) const override { return bounds(); }
  bool polygonal() const override { return false; }

  /// As a parallelogram's hit (planar.h), with another outline.
  std::optional<PrimitiveHit> intersect(std::uint32_t, const Ray& ray,
                                        bool leaving) const override {
    if (leaving) return std::nullopt;
    const Vec3 s = ray.o - center_;
    const double det = -dot(ray.d, across_);
    const double t = dot(s, across_) / det;
    const Vec3 q = cross(s, ray.d);
    const Vec2 local(dot(e2_, q) / det, -dot(e1_, q) / det);
    if (!std::isfinite(t) || !std::isfinite(local.x) || !std::isfinite(local.y))
      return std::nullopt;
    const double scale = detail::max_abs(ray.o) + 2 * detail::max_abs(s) + std::fabs(t);
    const double unit = detail::kRounding * scale / std::fabs(det);
    if (!(length(Vec3(local, 0)) - 1 <= unit * edges_)) return std::nullopt;
    const double error = unit * length(across_);
    if (!(t - ray.t_min > error && ray.t_max - t > error)) return std::nullopt;
    return PrimitiveHit{t, local};
  }
  bool avoids(std::uint32_t, const Bounds& box) const override {
    if (!bounds().overlaps(box)) return true;
    int in_front = 0;
    for (const Vec3& corner : box.corners()) in_front += dot(corner - center_, n_) > 0;
    return in_front == 0 || in_front == 8;
  }

  SurfacePoint surface_point(std::uint32_t, const Vec2& local) const override {
    SurfacePoint x;
    x.position = center_ + local.x * e1_ + local.y * e2_;
    x.n_g = n_;
    x.shading = Frame(n_);
    x.uv = {length(Vec3(local, 0)), warp::invert_azimuth(local.x, local.y)};
    x.local = local;
    return x;
  }
  SurfaceDerivatives derivatives(const SurfacePoint&) const override {
    return {e1_, e2_, Vec3(0), Vec3(0)};
  }

  /// Of radius and azimuth by the coordinates of the unit disk.
  std::array<Vec2, 2> uv_derivatives(const SurfacePoint& point) const override {
    const double x = point.local.x, y = point.local.y, r = length(Vec3(point.local, 0));
    return {Vec2(x / r, -0.5 * kInvPi * y / sqr(r)), Vec2(y / r, 0.5 * kInvPi * x / sqr(r))};
  }

  double area() const override { return kPi * length(across_); }
  SurfacePoint sample(const Vec2& u) const override {
    return surface_point(0, warp::sample_disk(u));
  }
  Vec2 invert(const SurfacePoint& x) const override { return warp::invert_disk(x.local); }

  Tessellation tessellate() const override {
    Tessellation result{{center_}, {}};
    const auto [e1, e2] = corner_axes();
    for (std::uint32_t i = 0; i < detail::kCircleSegments; ++i) {
      const Vec2 p = detail::on_circle(i);
      result.vertices.push_back(center_ + p.x * e1 + p.y * e2);
      result.triangles.push_back({0, 1 + i, 1 + (i + 1) % detail::kCircleSegments});
    }
    if (dot(n_, cross(e1, e2)) < 0)
      for (auto& t : result.triangles) std::swap(t[1], t[2]);
    return result;
  }

 private:
  /// Of the tessellation: a circle's do not depend on how it is turned around its axis.
  std::array<Vec3, 2> corner_axes() const {
    constexpr double kRound = 1e-6;
    const double radius = length(e1_);
    if (std::fabs(length(e2_) - radius) > kRound * radius ||
        std::fabs(dot(e1_, e2_)) > kRound * sqr(radius))
      return {e1_, e2_};
    const auto [s, t] = detail::across_axis(n_);
    return {radius * s, radius * t};
  }

  Vec3 center_, e1_, e2_;
  Vec3 across_;  ///< e1 × e2
  Vec3 n_;
  double edges_;  ///< |e1| + |e2|
};

}  // namespace

std::shared_ptr<const Shape> make_disk(const Transform& to_world, bool flip_normals) {
  return std::make_shared<Disk>(to_world, flip_normals);
}

}  // namespace fogbow
