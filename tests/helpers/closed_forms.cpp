// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/closed_forms.h"

#include <array>
#include <stdexcept>

#include "tests/helpers/quadrature.h"

namespace fogbow::testing {
namespace {

/// A vector across the unit vector n.
Vec3 any_tangent(const Vec3& n) {
  return normalize(cross(n, std::abs(n.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
}

}  // namespace

double fresnel_dielectric(double cos_incident, double eta) {
  const double sin2 = (1 - sqr(cos_incident)) / sqr(eta);
  if (sin2 >= 1) return 1;
  const double cos_beyond = std::sqrt(1 - sin2);
  const double s = (cos_incident - eta * cos_beyond) / (cos_incident + eta * cos_beyond);
  const double p = (eta * cos_incident - cos_beyond) / (eta * cos_incident + cos_beyond);
  return (s * s + p * p) / 2;
}

SlabTransport fresnel_plate(double cos_incident, double n, double sigma_a_times_d) {
  const double f = fresnel_dielectric(cos_incident, n);
  const double cos_inside = std::sqrt(1 - (1 - sqr(cos_incident)) / sqr(n));
  const double a = std::exp(-sigma_a_times_d / cos_inside);
  // geometric series over the passes: F is the same from inside at the conjugate angle
  const double series = sqr(1 - f) / (1 - sqr(f * a));
  return {f + series * f * a * a, series * a};
}

std::optional<Vec3> refract_direction(const Vec3& direction, const Vec3& normal, double eta) {
  const Vec3 n = dot(direction, normal) < 0 ? normal : -normal;
  const Vec3 along = direction - n * dot(direction, n);
  const Vec3 beyond = along / eta;  // Snell: the tangential part scales by n₁/n₂
  const double remains = 1 - length_squared(beyond);
  if (remains <= 0) return std::nullopt;
  return beyond - n * std::sqrt(remains);
}

Vec3 mirror_direction(const Vec3& direction, const Vec3& normal) {
  return direction - normal * (2 * dot(direction, normal));
}

double point_irradiance(const Vec3& p, const Vec3& n, const Vec3& light, double intensity) {
  const Vec3 to_light = light - p;
  const double distance = length(to_light);
  return intensity * std::fmax(0.0, dot(to_light, n)) / (distance * distance * distance);
}

Vec3 mirror_image(const Vec3& p, const Vec3& plane_point, const Vec3& plane_normal) {
  const Vec3 n = normalize(plane_normal);
  return p - n * (2 * dot(p - plane_point, n));
}

SpecularLink flat_refraction(const Vec3& a, const Vec3& b, const Vec3& plane_point,
                             const Vec3& plane_normal, double n_a, double n_b) {
  const Vec3 n = normalize(plane_normal);
  const double height_a = dot(a - plane_point, n), height_b = -dot(b - plane_point, n);
  if (height_a <= 0 || height_b <= 0) throw std::domain_error("a and b must lie on both sides");
  const Vec3 offset = (b - a) - n * dot(b - a, n);
  const double reach = length(offset);
  const double k = n_a / n_b;
  // Snell's offset x of the interface point grows monotonically towards `reach`: bisect on x.
  double lo = 0, hi = reach;
  for (int i = 0; i < 200 && lo < hi; ++i) {
    const double x = lo + (hi - lo) / 2;
    if (x == lo || x == hi) break;
    const double sin_a = x / std::hypot(x, height_a);
    const double sin_b = (reach - x) / std::hypot(reach - x, height_b);
    (n_a * sin_a < n_b * sin_b ? lo : hi) = x;
  }
  const double x = lo + (hi - lo) / 2;
  const double length_a = std::hypot(x, height_a), length_b = std::hypot(reach - x, height_b);
  const double cos_a = height_a / length_a, cos_b = height_b / length_b;
  // dσ_a = sinθ_a dθ_a dφ, dA⊥_b = (cosθ_b dr)(r dφ) with r = h_a tanθ_a + h_b tanθ_b and n_a
  // cosθ_a dθ_a = n_b cosθ_b dθ_b: across the plane of incidence r/sinθ_a = l_a + k l_b, in it
  // cosθ_b dr/dθ_a = (cosθ_b/cosθ_a) l_a + k (cosθ_a/cosθ_b) l_b.
  const double sagittal = length_a + k * length_b;
  const double tangential = cos_b / cos_a * length_a + k * cos_a / cos_b * length_b;
  const Vec3 foot = a - n * height_a;
  return {1 / (sagittal * tangential), reach > 0 ? foot + offset * (x / reach) : foot};
}

SpecularLink flat_mirror(const Vec3& a, const Vec3& b, const Vec3& plane_point,
                         const Vec3& plane_normal) {
  const Vec3 n = normalize(plane_normal);
  const Vec3 image = mirror_image(b, plane_point, n);
  const double height_a = dot(a - plane_point, n), height_b = dot(b - plane_point, n);
  return {1 / length_squared(image - a), a + (image - a) * (height_a / (height_a + height_b))};
}

double jacobian_by_differences(const std::function<std::optional<Ray>(const Vec3&)>& last_ray,
                               const Vec3& direction, const Vec3& b) {
  const Vec3 u = any_tangent(direction), v = cross(direction, u);
  const std::optional<Ray> centre = last_ray(direction);
  if (!centre) throw std::domain_error("the chain breaks off");
  const Vec3 across = normalize(centre->d);
  const auto landing = [&](const Vec3& tangent, double step) {
    const std::optional<Ray> ray = last_ray(normalize(direction + tangent * step));
    if (!ray) throw std::domain_error("the chain breaks off nearby");
    return ray->o + ray->d * (dot(b - ray->o, across) / dot(ray->d, across));
  };
  const auto derivative = [&](const Vec3& tangent) {
    // Richardson on central differences at h, h/2, h/4
    std::array<Vec3, 3> d;
    double h = 5e-4;
    for (Vec3& x : d) {
      x = (landing(tangent, h) - landing(tangent, -h)) / (2 * h);
      h /= 2;
    }
    const Vec3 first = (4.0 * d[1] - d[0]) / 3.0, second = (4.0 * d[2] - d[1]) / 3.0;
    return (16.0 * second - first) / 15.0;
  };
  return 1 / length(cross(derivative(u), derivative(v)));
}

double henyey_greenstein(double cos_theta, double g) {
  return (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cos_theta, 1.5));
}

double Airlight::radiance(const Ray& ray, double t0, double t1) const {
  const Vec3 omega = normalize(ray.d);
  const double nearest = dot(light - ray.o, omega);
  const double height = length(light - ray.o - omega * nearest);
  // t = nearest + h tanφ takes the peak 1/d² away: dt/d² = dφ/h
  const auto integrand = [&](double phi) {
    const double t = nearest + height * std::tan(phi);
    const double distance = height / std::cos(phi);
    const double cos_theta = -std::sin(phi);  // light → point against point → eye
    return henyey_greenstein(cos_theta, g) * std::exp(-sigma_t * (t - t0 + distance)) / height;
  };
  const double from = std::atan((t0 - nearest) / height), to = std::atan((t1 - nearest) / height);
  return intensity * sigma_s * integrate(integrand, from, to);
}

Vec3 PixelGrid::direction(double x, double y) const {
  const double half = std::tan(fov_x_degrees * kPi / 360);
  return normalize(
      Vec3((2 * x / width - 1) * half, (2 * y / height - 1) * half * height / width, 1));
}

Vec2 PixelGrid::raster(const Vec3& direction) const {
  const double half = std::tan(fov_x_degrees * kPi / 360);
  return {(direction.x / direction.z / half + 1) * width / 2,
          (direction.y / direction.z / (half * height / width) + 1) * height / 2};
}

double PixelGrid::importance(const Vec3& direction) const {
  const double side = 2 * std::tan(fov_x_degrees * kPi / 360) / width;
  const double cos_axis = direction.z / length(direction);
  return 1 / (side * side * cos_axis * cos_axis * cos_axis);
}

double PixelGrid::pixel_mean(int x, int y,
                             const std::function<double(const Vec3& direction)>& radiance,
                             int n) const {
  const QuadratureRule rule = gauss_legendre(n, 0, 1);
  double sum = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      sum += rule.weights[i] * rule.weights[j] *
             radiance(direction(x + rule.nodes[i], y + rule.nodes[j]));
  return sum;
}

}  // namespace fogbow::testing
