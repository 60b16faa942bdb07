// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/geometry/shape.h"

namespace fogbow {

/// An exact sphere. `local` is (azimuth/2π, v) with v = (1 − z)/2 modulo one in [−½, ½], so that
/// both poles are resolved; its derivatives are along the shading frame, where no pole is singular.
class Sphere final : public Shape {
 public:
  Sphere(const Vec3& center, double radius, bool flip_normals, const Mat3& to_object)
      : center_(center), radius_(radius), flip_(flip_normals), to_object_(to_object) {}

  const Vec3& center() const { return center_; }
  double radius() const { return radius_; }
  bool flipped() const { return flip_; }

  PrimitiveKind primitive_kind() const override { return PrimitiveKind::Analytic; }
  std::uint32_t primitive_count() const override { return 1; }
  PrimitiveBuffers buffers() const override { return {}; }
  Bounds bounds() const override { return {center_ - radius_, center_ + radius_}; }
  Bounds primitive_bounds(std::uint32_t) const override { return bounds(); }
  std::optional<PrimitiveHit> intersect(std::uint32_t, const Ray& ray, bool leaving) const override;
  bool polygonal() const override { return false; }
  bool avoids(std::uint32_t, const Bounds& box) const override;
  SurfacePoint surface_point(std::uint32_t, const Vec2& local) const override;
  SurfaceDerivatives derivatives(const SurfacePoint& point) const override;
  std::array<Vec2, 2> uv_derivatives(const SurfacePoint& point) const override;
  double area() const override { return 4 * kPi * sqr(radius_); }
  SurfacePoint sample(const Vec2& u) const override;
  Vec2 invert(const SurfacePoint& point) const override;
  Tessellation tessellate() const override;

 private:
  /// Error of a root, where the ray meets the surface at cosine `cos_theta`.
  double root_error(const Ray& ray, double cos_theta) const;

  Vec3 center_;
  double radius_;
  bool flip_;
  Mat3 to_object_;  ///< orthogonal; of the texture coordinates alone
};

}  // namespace fogbow
