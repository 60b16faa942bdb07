// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/path.h"

namespace fogbow {

namespace {

/// A ray and its derivative with respect to one coordinate of its start (ray differentials,
/// [Igehy1999]).
struct RayDerivative {
  Vec3 d_position, d_direction;
};

/// From the ray's origin to the surface point at distance t.
void transfer(RayDerivative& d, const Vec3& w, double t, const Vec3& n_g) {
  const Vec3 moved = d.d_position + t * d.d_direction;
  d.d_position = moved - dot(n_g, moved) / dot(n_g, w) * w;
}

/// Change of the unit shading normal when the point moves by dp in the tangent plane.
Vec3 normal_derivative(const SurfaceDerivatives& s, const Vec3& dp) {
  const double uu = dot(s.dp_du, s.dp_du), uv = dot(s.dp_du, s.dp_dv), vv = dot(s.dp_dv, s.dp_dv);
  const double u = dot(s.dp_du, dp), v = dot(s.dp_dv, dp);
  const double determinant = uu * vv - uv * uv;
  return ((vv * u - uv * v) * s.dn_du + (uu * v - uv * u) * s.dn_dv) / determinant;
}

/// Reflection or refraction of travelling direction w into w_out at a normal N; `ratio` is
/// n_in/n_out.
void scatter_specularly(RayDerivative& d, const Vec3& w, const Vec3& w_out, Vec3 N, Vec3 dN,
                        double ratio) {
  if (dot(w, N) > 0) {
    N = -N;
    dN = -dN;
  }
  const Vec3 dw = d.d_direction;
  const double c = -dot(w, N), dc = -(dot(dw, N) + dot(w, dN));
  if (dot(w_out, N) > 0) {
    d.d_direction = dw + 2.0 * (dc * N + c * dN);
    return;
  }
  const double c_out = -dot(w_out, N), dc_out = sqr(ratio) * c * dc / c_out;
  d.d_direction = ratio * dw + (ratio * dc - dc_out) * N + (ratio * c - c_out) * dN;
}

}  // namespace

double chain_jacobian(const Scene& scene, const Path& path, int a, int b) {
  const int step = a < b ? 1 : -1;
  const Vertex& start = path[a];
  Vec3 w =
      start.infinite() ? start.point.n_g : normalize(path[a + step].position() - start.position());
  const Frame across(w);
  // A bundle from a point spreads in direction, a parallel one in position.
  const Vec3 zero(0);
  RayDerivative d[2] = {{zero, across.s}, {zero, across.t}};
  if (start.infinite()) {
    d[0] = {across.s, zero};
    d[1] = {across.t, zero};
  }
  for (int i = a; i != b; i += step) {
    const Vertex& next = path[i + step];
    const double t = path[i].infinite() ? 0 : length(next.position() - path[i].position());
    if (i + step == b) {
      for (RayDerivative& r : d) r.d_position += t * r.d_direction;
      return 1 / std::abs(dot(w, cross(d[0].d_position, d[1].d_position)));
    }
    const Vec3 w_out = normalize(path[i + 2 * step].position() - next.position());
    const double ratio = relative_index(scene, next, -w) / relative_index(scene, next, w_out);
    const SurfaceDerivatives s = scene.surface(next.id.shape).shape->derivatives(next.point);
    for (RayDerivative& r : d) {
      transfer(r, w, t, next.point.n_g);
      scatter_specularly(r, w, w_out, next.point.shading.n, normal_derivative(s, r.d_position),
                         ratio);
    }
    w = w_out;
  }
  return 0;
}

}  // namespace fogbow
