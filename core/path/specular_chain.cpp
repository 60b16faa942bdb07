// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/specular_chain.h"

namespace fogbow {

namespace {

using RayDerivative = RayBundle::Derivative;

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

RayBundle::RayBundle(const Vertex& start, const Vec3& w) : w_(w), across_(w) {
  // A bundle from a point spreads in direction, a parallel one in position.
  const Vec3 zero(0);
  d_[0] = start.parallel() ? Derivative{across_.s, zero} : Derivative{zero, across_.s};
  d_[1] = start.parallel() ? Derivative{across_.t, zero} : Derivative{zero, across_.t};
}

void RayBundle::scatter(const Scene& scene, const Vertex& x, double t, const Vec3& w_out) {
  const double ratio = relative_index(scene, x, -w_) / relative_index(scene, x, w_out);
  const SurfaceDerivatives s = scene.surface(x.id.shape).shape->derivatives(x.point);
  const Vec3 facet = x.degenerate ? Vec3(0, 0, 1) : facet_normal(scene, x, -w_, w_out);
  const Vec3 m = x.point.shading.to_world(facet);
  for (Derivative& d : d_) {
    transfer(d, w_, t, x.point.n_g);
    const Vec3 dn = normal_derivative(s, d.d_position);
    const Vec3 dm = x.degenerate ? dn : x.point.shading.derivative(dn).to_world(facet);
    scatter_specularly(d, w_, w_out, m, dm, ratio);
  }
  w_ = w_out;
}

std::array<Vec3, 2> RayBundle::spread(double t) const {
  return {d_[0].d_position + t * d_[0].d_direction, d_[1].d_position + t * d_[1].d_direction};
}

std::array<Vec3, 2> RayBundle::turn() const { return {d_[0].d_direction, d_[1].d_direction}; }

namespace {

/// |N_g·ω_eye| |dσ(ω_eye)/do|: a glossy vertex' place in the reduced f, its facet being given.
double facet_to_reduced(const Scene& scene, const Path& path, int i) {
  const Vec3 w_light = direction(path, i, i - 1), w_eye = direction(path, i, i + 1);
  return std::abs(dot(path[i].point.n_g, w_eye)) / facet_jacobian(scene, path[i], w_light, w_eye);
}

}  // namespace

double chain_jacobian(const Scene& scene, const Path& path, int a, int b) {
  const int step = a < b ? 1 : -1;
  const auto distance = [&](int i) {
    return path[i].infinite() ? 0.0 : length(path[i + step].position() - path[i].position());
  };
  RayBundle bundle(path[a], direction(path, a, a + step));
  int i = a;
  for (; i + step != b; i += step)
    bundle.scatter(scene, path[i + step], distance(i), direction(path, i + step, i + 2 * step));
  const auto spread = path[b].parallel() ? bundle.turn() : bundle.spread(distance(i));
  return 1 / std::abs(dot(direction(path, i, b), cross(spread[0], spread[1])));
}

double chain_correction(const Scene& scene, const Path& path, int a, int b) {
  double correction = D(scene, path[a], direction(path, a, a + 1)) *
                      D(scene, path[b], direction(path, b, b - 1)) *
                      chain_jacobian(scene, path, a, b);
  for (int i = a; i < b; ++i) {
    Edge edge;
    edge.w = direction(path, i, i + 1);
    edge.length = length(path[i + 1].position() - path[i].position());
    correction /= geometric_term(scene, path[i], path[i + 1], edge);
    if (i == a) continue;
    correction *= path[i].degenerate ? dirac_to_reduced(scene, path[i], edge.w)
                                     : facet_to_reduced(scene, path, i);
  }
  return correction;
}

}  // namespace fogbow
