// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/path.h"

#include "core/path/specular_chain.h"

namespace fogbow {

namespace {

RGB f_hat_at(const Scene& scene, const Path& path, int i) {
  return f_hat(scene, path[i], direction(path, i, i - 1), direction(path, i, i + 1),
               path[i].degenerate);
}

Scattering scatter_at(const Scene& scene, const Path& path, int i) {
  return scatter(scene, path[i], direction(path, i, i - 1), direction(path, i, i + 1),
                 path[i].degenerate, path[i + 1].degenerate);
}

/// Density of path[i] sampled from the light, given path[0..i).
double pdf_from_light(const Scene& scene, const Path& path, int i) {
  if (i == 0) return pdf_emitter_position(scene, path[0]);
  const auto edge = connect(scene, path[i - 1], path[i]);
  if (!edge) return 0;
  if (i == 1)
    return pdf_emission(scene, path[0], path[1], *edge) * pdf_distance(scene, *edge, path[1]);
  return pdf_arrival(scene, path[i - 1], path[i], *edge, scatter_at(scene, path, i - 1).pdf_to_eye);
}

/// The same from the eye, given path(i..k).
double pdf_from_eye(const Scene& scene, const Path& path, int i) {
  const int last = static_cast<int>(path.size()) - 1;
  const Sensor& sensor = scene.sensor();
  if (i == last) return sensor.pdf_A(path[last].position());
  const auto edge = connect(scene, path[i], path[i + 1]);
  if (!edge) return 0;
  const double pdf_sigma = i + 1 == last ? sensor.pdf_sigma(path[last].position(), -edge->w)
                                         : scatter_at(scene, path, i + 1).pdf_to_light;
  return pdf_arrival(scene, path[i + 1], path[i], reversed(*edge), pdf_sigma);
}

}  // namespace

Vec3 direction(const Path& path, int i, int j) {
  if (path[i].parallel()) return path[i].point.n_g;
  if (path[j].parallel()) return -path[j].point.n_g;
  return normalize(path[j].position() - path[i].position());
}

PathConfiguration configuration(const Path& path) {
  FOGBOW_CHECK(path.size() <= kMaxVertices);
  PathConfiguration c;
  c.k = static_cast<int>(path.size());
  for (std::size_t i = 0; i < path.size(); ++i) {
    c.in_medium[i] = path[i].in_medium();
    c.degenerate[i] = path[i].degenerate;
  }
  return c;
}

Path assemble(const Scene& scene, const Subpath& light, int s, const Subpath& eye, int t) {
  Path path;
  for (int i = 0; i < s; ++i) path.push_back(light[i].x);
  for (int i = t; i-- > 0;) path.push_back(eye[i].x);
  // The two ends that are joined scatter smoothly, whatever their walks went on with.
  if (s > 0) path[s - 1].degenerate = false;
  path[s].degenerate = false;
  if (s > 0 && !path[s - 1].infinite()) look_at(scene, path[s], path[s - 1].position());
  return path;
}

RGB f(const Scene& scene, const Path& path) {
  const int k = static_cast<int>(path.size());
  RGB value = L_e(scene, path[0], direction(path, 0, 1));
  for (int i = 0; i + 1 < k && !is_black(value); ++i) {
    const auto edge = connect(scene, path[i], path[i + 1]);
    if (!edge) return RGB(0);
    value *= edge->tau * geometric_term(scene, path[i], path[i + 1], *edge);
    if (i > 0) value *= f_hat_at(scene, path, i);
  }
  return value * W_e(scene, path[k - 1], direction(path, k - 1, k - 2));
}

double technique_density(const Scene& scene, const Path& path, int s) {
  const int k = static_cast<int>(path.size());
  if (s < 0 || s >= k) return 0;
  if (s == 0 && !hittable(scene, path[0])) return 0;
  if (s > 0 && (path[s - 1].degenerate || path[s].degenerate || !has_ray(path[s - 1], path[s])))
    return 0;
  double p = 1;
  for (int i = 0; i < s; ++i) p *= pdf_from_light(scene, path, i);
  for (int i = s; i < k; ++i) p *= pdf_from_eye(scene, path, i);
  return p;
}

std::optional<Vec2> raster(const Scene& scene, const Path& path) {
  const int last = static_cast<int>(path.size()) - 1;
  return scene.sensor().raster(path[last].position(), direction(path, last, last - 1));
}

double dirac_to_reduced(const Scene& scene, const Vertex& x, const Vec3& w_eye) {
  const SurfacePoint& p = x.point;
  const double cosines = std::abs(dot(p.n_g, w_eye) / dot(p.shading.n, w_eye));
  return cosines / sqr(relative_index(scene, x, w_eye));
}

RGB reduced_f(const Scene& scene, const Path& path) {
  const int k = static_cast<int>(path.size());
  RGB value = L_e(scene, path[0], direction(path, 0, 1));
  for (int a = 0; a + 1 < k;) {
    int b = a + 1;
    while (path[b].degenerate) ++b;
    for (int i = a; i < b; ++i) {
      const auto edge = connect(scene, path[i], path[i + 1]);
      if (!edge) return RGB(0);
      value *= edge->tau;
      if (i > a)
        value *=
            f_hat_at(scene, path, i) * dirac_to_reduced(scene, path[i], direction(path, i, i + 1));
    }
    value *= D(scene, path[a], direction(path, a, a + 1)) *
             D(scene, path[b], direction(path, b, b - 1)) * chain_jacobian(scene, path, a, b);
    if (b + 1 < k) value *= f_hat_at(scene, path, b);
    a = b;
  }
  return value * W_e(scene, path[k - 1], direction(path, k - 1, k - 2));
}

}  // namespace fogbow
