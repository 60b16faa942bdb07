// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/connection.h"

namespace fogbow {

namespace {

/// Scattering at x, the end of a subpath that is joined along `w` (away from it); emission and
/// importance at the very ends.
Scattering scatter_at_end(const Scene& scene, const Vertex& x, const Subpath& path, int n,
                          const Vec3& w, Side side) {
  if (n > 1) {
    const Vec3 back = -path[n - 1].edge.w;
    return side == Side::Light ? scatter(scene, x, back, w, false, false)
                               : scatter(scene, x, w, back, false, path[n - 2].x.degenerate);
  }
  Scattering end;
  if (side == Side::Light) {
    end.f_hat = L_e(scene, x, w);
  } else {
    end.f_hat = RGB(W_e(scene, x, w));
    end.pdf_to_light = pdf_importance(scene, x, w);
  }
  return end;
}

/// Σ_{j<n} p_j/p_n on one side: `pdf_last` and `pdf_before` are the densities of the last two
/// vertices sampled from the other end.
double sum_techniques(const Scene& scene, const Subpath& path, int n, double pdf_last,
                      double pdf_before, Side side) {
  if (n == 1) return other_techniques(scene, path, 0, pdf_last, false, side);
  const double before = other_techniques(scene, path, n - 2, pdf_before, false, side);
  const bool connects = !path[n - 2].x.degenerate && has_ray(path[n - 2].x, path[n - 1].x);
  return pdf_last / path[n - 1].pdf * (connects + before);
}

double pdf_previous(const Scene& scene, const Subpath& path, int n, double pdf_sigma) {
  if (n < 2) return 0;
  return pdf_arrival(scene, path[n - 1].x, path[n - 2].x, reversed(path[n - 1].edge), pdf_sigma);
}

}  // namespace

std::optional<Connection> join(const Scene& scene, const Subpath& light, int s, const Subpath& eye,
                               int t) {
  const SubpathVertex& y = light[s - 1];
  if (!y.connects || !eye[t - 1].connects || eye[t - 1].x.infinite()) return std::nullopt;
  Vertex z = eye[t - 1].x;
  if (!has_ray(y.x, z) || (s + t == 2 && is_unseen(scene, y.x))) return std::nullopt;
  look_at(scene, z, y.x.position());

  // Cheap factors first: most pairs fail on them, before a ray is traced.
  const Vec3 w = y.x.infinite() ? y.x.point.n_g
                 : z.parallel() ? -z.point.n_g
                                : normalize(z.position() - y.x.position());
  const Scattering at_z = scatter_at_end(scene, z, eye, t, -w, Side::Eye);
  if (is_black(at_z.f_hat)) return std::nullopt;
  const Scattering at_y = scatter_at_end(scene, y.x, light, s, w, Side::Light);
  if (is_black(at_y.f_hat)) return std::nullopt;
  const auto edge = connect(scene, y.x, z);
  if (!edge || is_black(edge->tau)) return std::nullopt;

  Connection c;
  c.value = y.throughput * at_y.f_hat * edge->tau * at_z.f_hat * eye[t - 1].throughput *
            geometric_term(scene, y.x, z, *edge);
  if (t == 1) {
    const auto raster = scene.sensor().raster(z.position(), -w);
    if (!raster) return std::nullopt;
    c.raster = *raster;
  }
  const double pdf_y = pdf_arrival(scene, z, y.x, reversed(*edge), at_z.pdf_to_light);
  const double light_sum = sum_techniques(
      scene, light, s, pdf_y, pdf_previous(scene, light, s, at_y.pdf_to_light), Side::Light);
  double eye_sum = 0;
  if (t > 1) {
    const double pdf_z = s == 1 ? pdf_emission(scene, y.x, z, *edge) * pdf_distance(scene, *edge, z)
                                : pdf_arrival(scene, y.x, z, *edge, at_y.pdf_to_eye);
    eye_sum = sum_techniques(scene, eye, t, pdf_z, pdf_previous(scene, eye, t, at_z.pdf_to_eye),
                             Side::Eye);
  }
  c.weight = 1 / (1 + light_sum + eye_sum);
  return c;
}

std::optional<Connection> run_into_light(const Scene& scene, const Subpath& eye, int t) {
  const SubpathVertex& x = eye[t - 1];
  if (t < 2 || !hittable(scene, x.x)) return std::nullopt;
  const Edge back = reversed(x.edge);
  const RGB radiance = L_e(scene, x.x, back.w);
  if (is_black(radiance)) return std::nullopt;
  Connection c;
  c.value = x.throughput * radiance;
  const Vertex& before = eye[t - 2].x;
  const double pdf_before =
      pdf_emission(scene, x.x, before, back) * pdf_distance(scene, back, before);
  const double sum =
      sum_techniques(scene, eye, t, pdf_emitter_position(scene, x.x), pdf_before, Side::Eye);
  c.weight = 1 / (1 + sum);
  return c;
}

}  // namespace fogbow
