// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/geometry/circle.h"
#include "core/geometry/planar.h"
#include "core/geometry/shapes.h"
#include "core/math/warp.h"

namespace fogbow {

namespace {

/// An exact cylinder without caps. `local` is (azimuth/2π, fraction of the length); derivatives are
/// along the circumference and the axis.
class Cylinder final : public Shape {
 public:
  Cylinder(const Vec3& p0, const Vec3& p1, double radius, const Vec3& azimuth_zero,
           bool left_handed, bool flip_normals)
      : p0_(p0),
        radius_(radius),
        length_(length(p1 - p0)),
        axis_((p1 - p0) / length_),
        s_(normalize(azimuth_zero - dot(azimuth_zero, axis_) * axis_)),
        t_((left_handed ? -1.0 : 1.0) * cross(axis_, s_)),
        flip_(flip_normals) {}

  PrimitiveKind primitive_kind() const override { return PrimitiveKind::Analytic; }
  std::uint32_t primitive_count() const override { return 1; }
  PrimitiveBuffers buffers() const override { return {}; }
  Bounds bounds() const override {
    // A circle across the axis reaches as far as the axis leaves room for.
    const Vec3 reach = radius_ * glm::sqrt(glm::max(1.0 - axis_ * axis_, Vec3(0)));
    const Vec3 p1 = p0_ + length_ * axis_;
    return {glm::min(p0_, p1) - reach, glm::max(p0_, p1) + reach};
  }
  Bounds primitive_bounds(std::uint32_t) const override { return bounds(); }
  bool polygonal() const override { return false; }

  std::optional<PrimitiveHit> intersect(std::uint32_t, const Ray& ray,
                                        bool leaving) const override {
    const Vec3 d = across(ray.d);
    const double d2 = length_squared(d);
    if (!(d2 > 0)) return std::nullopt;
    if (leaving) {
      // From a point on the surface the roots are 0 and −2b: nothing to tell apart by a tolerance.
      const double b = dot(across(ray(ray.t_min) - p0_), d) / d2;
      const double t = ray.t_min - 2 * b, error = root_error(ray, -b * d2 / radius_);
      if (!(t > ray.t_min) || !(ray.t_max - t > error)) return std::nullopt;
      return hit(ray, t, error);
    }
    const Vec3 o = across(ray.o - p0_);
    const double middle = -dot(o, d) / d2;
    const double miss = length(o + middle * d);
    if (!(miss < radius_)) return std::nullopt;
    const double half = std::sqrt((radius_ - miss) * (radius_ + miss) / d2);
    const double error = root_error(ray, half * d2 / radius_);
    for (const double t : {middle - half, middle + half})
      if (t - ray.t_min > error && ray.t_max - t > error)
        if (const auto found = hit(ray, t, error)) return found;
    return std::nullopt;
  }

  SurfacePoint surface_point(std::uint32_t, const Vec2& local) const override {
    const double phi = 2 * kPi * local.x;
    const Vec3 outwards = std::cos(phi) * s_ + std::sin(phi) * t_;
    SurfacePoint x;
    x.position = p0_ + radius_ * outwards + (local.y * length_) * axis_;
    x.n_g = flip_ ? -outwards : outwards;
    x.shading = Frame(x.n_g);
    x.uv = x.local = local;
    return x;
  }
  SurfaceDerivatives derivatives(const SurfacePoint& x) const override {
    const Vec3 along = cross(axis_, x.n_g);
    return {along, axis_, (flip_ ? -1 : 1) / radius_ * along, Vec3(0)};
  }

  std::array<Vec2, 2> uv_derivatives(const SurfacePoint&) const override {
    // The azimuth rises along axis × n_g or against it.
    const double sign = (flip_ ? -1.0 : 1.0) * (dot(cross(axis_, s_), t_) > 0 ? 1.0 : -1.0);
    return {Vec2(sign * 0.5 * kInvPi / radius_, 0), Vec2(0, 1 / length_)};
  }

  double area() const override { return 2 * kPi * radius_ * length_; }
  SurfacePoint sample(const Vec2& u) const override { return surface_point(0, u); }
  Vec2 invert(const SurfacePoint& x) const override {
    return {warp::clamp_unit(x.local.x), warp::clamp_unit(x.local.y)};
  }

  Tessellation tessellate() const override {
    Tessellation result;
    constexpr std::uint32_t n = detail::kCircleSegments;
    const auto [s, t] = detail::across_axis(axis_);
    for (std::uint32_t i = 0; i < n; ++i) {
      const Vec2 p = radius_ * detail::on_circle(i);
      for (const double end : {0.0, length_})
        result.vertices.push_back(p0_ + p.x * s + p.y * t + end * axis_);
      const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % n);
      result.triangles.push_back({a, b, b + 1});
      result.triangles.push_back({a, b + 1, a + 1});
    }
    if (flip_ != (dot(cross(s, t), axis_) < 0))
      for (auto& triangle : result.triangles) std::swap(triangle[1], triangle[2]);
    return result;
  }

 private:
  Vec3 across(const Vec3& v) const { return v - dot(v, axis_) * axis_; }

  /// Error of a root, where the ray meets the surface at cosine `cos_theta`.
  double root_error(const Ray& ray, double cos_theta) const {
    const double scale = detail::max_abs(ray.o) + detail::max_abs(ray.o - p0_) + length_ + radius_;
    return detail::kRounding * scale / cos_theta;
  }
  /// Nothing beyond the rims, but for what rounding cannot tell from them.
  std::optional<PrimitiveHit> hit(const Ray& ray, double t, double error) const {
    const Vec3 p = ray(t) - p0_;
    const double z = dot(p, axis_);
    if (!(z >= -error && z - length_ <= error)) return std::nullopt;
    return PrimitiveHit{t, {warp::invert_azimuth(dot(p, s_), dot(p, t_)), z / length_}};
  }

  Vec3 p0_;
  double radius_, length_;
  Vec3 axis_, s_, t_;
  bool flip_;
};

}  // namespace

std::shared_ptr<const Shape> make_cylinder(const Vec3& p0, const Vec3& p1, double radius,
                                           const Transform& to_world, bool flip_normals) {
  const Vec3 axis = p1 - p0;
  if (!is_finite(axis) || !(length(axis) > 0) || !(radius > 0) || !std::isfinite(radius))
    throw std::domain_error(
        "cylinder needs two different finite ends and a positive finite radius");
  const Frame frame(normalize(axis));
  const Vec3 a = to_world.vector(axis), s = to_world.vector(radius * frame.s),
             t = to_world.vector(radius * frame.t);
  const double size = length(s);
  constexpr double kTolerance = 1e-6;
  if (!(std::fabs(length(t) - size) <= kTolerance * size) ||
      !(std::fabs(dot(s, t)) <= kTolerance * size * size) ||
      !(std::fabs(dot(s, a)) + std::fabs(dot(t, a)) <= kTolerance * size * length(a)))
    throw std::domain_error(
        "a cylinder's \"to_world\" may stretch it along its axis alone, not across nor askew");
  return std::make_shared<Cylinder>(to_world.point(p0), to_world.point(p1), size, s,
                                    to_world.flips_orientation(), flip_normals);
}

}  // namespace fogbow
