// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/geometry/shapes.h"
#include "core/math/random.h"
#include "core/path/transport.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
#include "media/media.h"

namespace fogbow::testing {

using MediumPointer = std::shared_ptr<const Medium>;
using ShapePointer = std::shared_ptr<const Shape>;

inline MediumPointer fog(const RGB& sigma_t, const std::string& id) {
  return make_homogeneous_medium(sigma_t, RGB(0.6, 0.7, 0.8), make_isotropic_phase(), RGB(0), id);
}

inline Surface surface(ShapePointer shape, std::shared_ptr<const Bsdf> bsdf, int priority = 0) {
  Surface s;
  s.shape = std::move(shape);
  s.bsdf = std::move(bsdf);
  s.priority = priority;
  return s;
}

inline Surface boundary(ShapePointer shape, MediumPointer interior, MediumPointer exterior,
                        int priority = 0, std::shared_ptr<const Bsdf> bsdf = make_null()) {
  Surface s = surface(std::move(shape), std::move(bsdf), priority);
  s.medium_boundary = true;
  s.interior = std::move(interior);
  s.exterior = std::move(exterior);
  return s;
}

inline SceneDescription describe_scene(std::vector<Surface> surfaces,
                                       const Vec3& eye = {0.3, 0.2, 6}) {
  SceneDescription d;
  d.surfaces = std::move(surfaces);
  PerspectiveSettings camera;
  camera.to_world = Transform::look_at(eye, Vec3(0), {0, 1, 0});
  camera.fov_x_degrees = 40;
  camera.width = camera.height = d.film.width = d.film.height = 32;
  d.sensor = make_perspective_sensor(camera);
  d.emitters.push_back(make_constant_emitter(RGB(1)));
  return d;
}

inline Vertex point_at(const Vec3& p, const Medium* medium = nullptr) {
  Vertex x;
  x.kind = medium ? VertexKind::Medium : VertexKind::PointLight;
  x.point.position = p;
  x.medium = medium;
  return x;
}

/// Of a line p + t d, 0 ≤ t ≤ 1.
using Interval = std::pair<double, double>;
inline Interval cut(const Interval& a, const Interval& b) {
  return {std::max(a.first, b.first),
          std::max(std::min(a.second, b.second), std::max(a.first, b.first))};
}
inline double size(const Interval& i) { return std::max(i.second - i.first, 0.0); }

inline Interval in_sphere(const Vec3& p, const Vec3& d, const Vec3& center, double radius) {
  const Vec3 o = p - center;
  const double a = dot(d, d), b = dot(o, d), c = dot(o, o) - sqr(radius), root = b * b - a * c;
  if (root <= 0) return {0, 0};
  return cut({0, 1}, {(-b - std::sqrt(root)) / a, (-b + std::sqrt(root)) / a});
}
/// Of the cube [−1,1]³ in coordinates of its own.
inline Interval in_cube(const Vec3& p, const Vec3& d) {
  Interval all{0, 1};
  for (int i = 0; i < 3; ++i) {
    const double a = (-1 - p[i]) / d[i], b = (1 - p[i]) / d[i];
    all = cut(all, {std::min(a, b), std::max(a, b)});
  }
  return all;
}

}  // namespace fogbow::testing
