// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/sphere.h"

#include <algorithm>
#include <glm/common.hpp>
#include <map>
#include <stdexcept>

#include "core/geometry/planar.h"
#include "core/geometry/shapes.h"
#include "core/math/warp.h"

namespace fogbow {

namespace {

/// v = (1 − z)/2 of the lower half is stored less one.
Vec2 to_local(const Vec3& n) {
  const double to_pole = 0.5 * warp::one_minus_cos({n.x, n.y, std::fabs(n.z)});
  return {warp::invert_azimuth(n.x, n.y), std::signbit(n.z) ? -to_pole : to_pole};
}

Vec3 from_local(const Vec2& local) {
  const Vec3 n = warp::spherical_direction(2 * std::fabs(local.y), local.x);
  return {n.x, n.y, std::copysign(n.z, local.y)};
}

constexpr int kTessellationLevels = 4;

}  // namespace

double Sphere::root_error(const Ray& ray, double cos_theta) const {
  const double scale =
      detail::max_abs(ray.o) + detail::max_abs(ray.o - center_) + std::fabs(radius_);
  return detail::kRounding * scale / cos_theta;
}

std::optional<PrimitiveHit> Sphere::intersect(std::uint32_t, const Ray& ray, bool leaving) const {
  const auto hit = [&](double t) { return PrimitiveHit{t, to_local(normalize(ray(t) - center_))}; };
  if (leaving) {
    // From a point on the sphere the roots are 0 and −2b: nothing to tell apart by a tolerance.
    const double b = dot(ray(ray.t_min) - center_, ray.d);
    const double t = ray.t_min - 2 * b;
    if (!(t > ray.t_min) || !(ray.t_max - t > root_error(ray, -b / radius_))) return std::nullopt;
    return hit(t);
  }
  const Vec3 o = ray.o - center_;
  const double middle = -dot(o, ray.d);
  const double miss = length(o + middle * ray.d);
  if (!(miss < radius_)) return std::nullopt;
  const double half = std::sqrt((radius_ - miss) * (radius_ + miss));
  const double error = root_error(ray, half / radius_);
  for (const double t : {middle - half, middle + half})
    if (t - ray.t_min > error && ray.t_max - t > error) return hit(t);
  return std::nullopt;
}

SurfacePoint Sphere::surface_point(std::uint32_t, const Vec2& local) const {
  const Vec3 n = from_local(local);
  SurfacePoint x;
  x.position = center_ + radius_ * n;
  x.n_g = flip_ ? -n : n;
  x.shading = Frame(x.n_g);
  const Vec3 m = to_object_ * n;
  x.uv = {warp::invert_azimuth(m.x, m.y), std::acos(std::min(std::max(m.z, -1.0), 1.0)) * kInvPi};
  x.local = local;
  return x;
}

SurfaceDerivatives Sphere::derivatives(const SurfacePoint& x) const {
  const double curvature = (flip_ ? -1 : 1) / radius_;
  const Frame tangent(x.n_g);  // not x.shading, which bump maps turn
  return {tangent.s, tangent.t, curvature * tangent.s, curvature * tangent.t};
}

std::array<Vec2, 2> Sphere::uv_derivatives(const SurfacePoint& x) const {
  const Vec3 m = to_object_ * ((x.position - center_) / radius_);
  const double sin2 = m.x * m.x + m.y * m.y;
  const auto along = [&](const Vec3& direction) {
    const Vec3 d = to_object_ * (direction / radius_);
    return Vec2(0.5 * kInvPi * (m.x * d.y - m.y * d.x) / sin2, -kInvPi * d.z / std::sqrt(sin2));
  };
  const Frame tangent(x.n_g);
  return {along(tangent.s), along(tangent.t)};
}

SurfacePoint Sphere::sample(const Vec2& u) const {
  return surface_point(0, {u.x, u.y < 0.5 ? u.y : u.y - 1});
}

Vec2 Sphere::invert(const SurfacePoint& x) const {
  const double v = x.local.y;
  return {warp::clamp_unit(x.local.x), warp::clamp_unit(std::signbit(v) ? v + 1 : v)};
}

/// An octahedron, refined.
Tessellation Sphere::tessellate() const {
  std::vector<Vec3> unit{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                                      {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < kTessellationLevels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [it, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(unit.size()));
      if (fresh) unit.push_back(normalize(unit[a] + unit[b]));
      return it->second;
    };
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  for (Vec3& p : unit) p = center_ + radius_ * p;
  if (flip_)
    for (auto& t : triangles) std::swap(t[1], t[2]);
  return {std::move(unit), std::move(triangles)};
}

std::shared_ptr<const Shape> make_sphere(const Vec3& center, double radius, bool flip_normals,
                                         const Mat3& to_object) {
  if (!is_finite(center) || !(radius > 0) || !std::isfinite(radius))
    throw std::domain_error("sphere needs a finite center and a positive finite radius");
  return std::make_shared<Sphere>(center, radius, flip_normals, to_object);
}

bool Sphere::avoids(std::uint32_t, const Bounds& box) const {
  const Vec3 nearest = glm::clamp(center_, box.lo, box.hi);
  double farthest = 0;
  for (const Vec3& corner : box.corners()) farthest = std::max(farthest, length(corner - center_));
  return length(nearest - center_) > radius_ || farthest < radius_;
}

}  // namespace fogbow
