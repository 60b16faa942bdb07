// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/measurement.h"

#include <algorithm>

namespace fogbow {

namespace {

const Bsdf& bsdf(const Scene& scene, const Vertex& x) { return *scene.surface(x.id.shape).bsdf; }

/// Index of refraction on the side of a local direction, relative to the exterior.
double index_at(const Bsdf& bsdf, const Vec3& local) { return local.z > 0 ? 1.0 : bsdf.eta(); }

struct LocalDirections {
  Vec3 light, eye;    // in the shading frame
  double correction;  // |N_s·w_light| / |N_g·w_light|
  bool consistent;    // shading and geometric normal agree on the sides
};

LocalDirections localize(const SurfacePoint& p, const Vec3& w_light, const Vec3& w_eye) {
  LocalDirections d;
  d.light = p.shading.to_local(w_light);
  d.eye = p.shading.to_local(w_eye);
  const double g_light = dot(p.n_g, w_light), g_eye = dot(p.n_g, w_eye);
  d.consistent = d.light.z * g_light > 0 && d.eye.z * g_eye > 0;
  d.correction = d.light.z / g_light;
  return d;
}

/// Survival of roulette: what sampling `to` given `from` would multiply the throughput by, without
/// the (n_from/n_to)² of radiance, which the next refraction undoes. A function of the vertex and
/// its neighbours, so that densities stay functions of the path.
double survival(const RGB& f, double cos_to, double pdf, double index_ratio_squared) {
  if (!(pdf > 0)) return 0;
  return std::min(1.0, max_component(f) * cos_to / pdf * index_ratio_squared);
}

Scattering scatter_surface(const Scene& scene, const Vertex& x, const Vec3& w_light,
                           const Vec3& w_eye, bool degenerate, bool behind_specular) {
  const SurfacePoint& p = x.point;
  const LocalDirections d = localize(p, w_light, w_eye);
  if (!d.consistent) return {};
  const Bsdf& b = bsdf(scene, x);
  const auto [f, to_light, to_eye] =
      degenerate ? b.evaluate_dirac(p, d.light, d.eye) : b.evaluate(p, d.light, d.eye);
  if (is_black(f)) return {};
  const double ratio = sqr(index_at(b, d.light) / index_at(b, d.eye));
  const double stay_to_light =
      behind_specular ? 1.0 : survival(f, std::abs(d.light.z), to_light, ratio);
  const double stay_to_eye = survival(f, std::abs(d.eye.z), to_eye, 1.0);
  return {f * d.correction, to_light * stay_to_light, to_eye * stay_to_eye, stay_to_light,
          stay_to_eye};
}

Scattering scatter_medium(const Vertex& x, const Vec3& w_light, const Vec3& w_eye,
                          bool behind_specular) {
  const PhaseFunction& phase = x.medium->phase();
  const auto [sigma_t, sigma_s] = x.medium->coefficients(x.position());
  const auto [f_p, pdf_sigma] = phase.evaluate(w_light, w_eye);
  double albedo = 0;
  for (int c = 0; c < 3; ++c)
    if (sigma_t[c] > 0) albedo = std::max(albedo, sigma_s[c] / sigma_t[c]);
  const double stay_to_light = behind_specular && albedo > 0 ? 1.0 : albedo;
  return {sigma_s * f_p, stay_to_light * pdf_sigma, albedo * pdf_sigma, stay_to_light, albedo};
}

}  // namespace

double D(const Scene& scene, const Vertex& x, const Vec3& w) {
  switch (x.kind) {
    case VertexKind::Surface: return std::abs(dot(x.point.n_g, w));
    case VertexKind::Sensor: return scene.sensor().D(w);
    case VertexKind::Medium:
    case VertexKind::PointLight:
    case VertexKind::InfiniteLight:
    case VertexKind::ParallelSensor: return 1;
  }
  return 1;
}

double geometric_term(const Scene& scene, const Vertex& a, const Vertex& b, const Edge& a_to_b) {
  const double d = D(scene, a, a_to_b.w) * D(scene, b, -a_to_b.w);
  return a.parallel() || b.parallel() ? d : d / sqr(a_to_b.length);
}

Scattering scatter(const Scene& scene, const Vertex& x, const Vec3& w_light, const Vec3& w_eye,
                   bool degenerate, bool behind_specular) {
  if (x.on_surface()) return scatter_surface(scene, x, w_light, w_eye, degenerate, behind_specular);
  FOGBOW_CHECK(x.in_medium());
  return scatter_medium(x, w_light, w_eye, behind_specular);
}

RGB f_hat(const Scene& scene, const Vertex& x, const Vec3& w_light, const Vec3& w_eye,
          bool degenerate) {
  if (x.in_medium()) return x.medium->sigma_s(x.position()) * x.medium->phase().f_p(w_light, w_eye);
  FOGBOW_CHECK(x.on_surface());
  const LocalDirections d = localize(x.point, w_light, w_eye);
  if (!d.consistent) return RGB(0);
  const Bsdf& b = bsdf(scene, x);
  return d.correction *
         (degenerate ? b.f_dirac(x.point, d.light, d.eye) : b.f_s(x.point, d.light, d.eye));
}

RGB L_e(const Scene& scene, const Vertex& x, const Vec3& w) {
  if (x.emitter < 0) return RGB(0);
  return scene.emitter(x.emitter).L_e(emitter_point(x), w);
}

double W_e(const Scene& scene, const Vertex& x, const Vec3& w) {
  return scene.sensor().W_e(x.position(), w);
}

std::optional<DirectionSample> sample_direction(const Scene& scene, const Vertex& x,
                                                const Vec3& from, Side side, const Vec3& u,
                                                double v, bool behind_specular) {
  DirectionSample s{Vec3(0), false, {}};
  if (x.in_medium()) {
    s.w = x.medium->phase().sample(from, u);
  } else {
    const auto local = bsdf(scene, x).sample(x.point, x.point.shading.to_local(from), u);
    if (!local) return std::nullopt;
    s.w = x.point.shading.to_world(local->w);
    s.degenerate = local->dirac;
  }
  const bool eye = side == Side::Eye;
  s.scattering =
      scatter(scene, x, eye ? s.w : from, eye ? from : s.w, s.degenerate, behind_specular);
  const double pdf = eye ? s.scattering.pdf_to_light : s.scattering.pdf_to_eye;
  const double stay = eye ? s.scattering.survival_to_light : s.scattering.survival_to_eye;
  if (!(pdf > 0) || v >= stay) return std::nullopt;
  return s;
}

bool is_glossy(const Scene& scene, const Vertex& x) {
  constexpr double kMostRoughness = 0.3;
  return x.on_surface() && !x.degenerate && bsdf(scene, x).roughness() <= kMostRoughness;
}

Vec3 facet_normal(const Scene& scene, const Vertex& x, const Vec3& w_light, const Vec3& w_eye) {
  const Vec3 light = x.point.shading.to_local(w_light), eye = x.point.shading.to_local(w_eye);
  const Bsdf& b = bsdf(scene, x);
  // [Walter2007, eq. 16]; one index on both sides in reflection.
  const bool reflects = light.z * eye.z > 0;
  const Vec3 h = reflects ? light + eye : index_at(b, light) * light + index_at(b, eye) * eye;
  return normalize(h.z < 0 ? -h : h);
}

std::optional<Vec3> facet_direction(const Scene& scene, const Vertex& x, const Vec3& from,
                                    bool transmit, const Vec3& facet) {
  const Vec3 local = x.point.shading.to_local(from);
  const Vec3 m = dot(local, facet) < 0 ? -facet : facet;
  const double c = dot(local, m);
  Vec3 to = 2 * c * m - local;
  if (transmit) {
    const double eta = bsdf(scene, x).eta();
    const double ratio = local.z > 0 ? 1 / eta : eta;  // n_from/n_to
    const double cos2 = 1 - sqr(ratio) * (1 - sqr(c));
    if (eta == 1 || !(cos2 > 0)) return std::nullopt;
    to = (ratio * c - std::sqrt(cos2)) * m - ratio * local;
  }
  if (!(to.z * local.z * (transmit ? -1 : 1) > 0)) return std::nullopt;
  return x.point.shading.to_world(to);
}

double facet_jacobian(const Scene& scene, const Vertex& x, const Vec3& from, const Vec3& to) {
  const Vec3 m = facet_normal(scene, x, from, to);
  const Vec3 a = x.point.shading.to_local(from), b = x.point.shading.to_local(to);
  const double cos_b = dot(b, m);
  if (a.z * b.z > 0) return m.z / (4 * std::abs(cos_b));
  const Bsdf& s = bsdf(scene, x);
  const double n_a = index_at(s, a), n_b = index_at(s, b);
  return m.z * sqr(n_b) * std::abs(cos_b) / sqr(n_a * dot(a, m) + n_b * cos_b);
}

std::optional<Vec3> specular_direction(const Scene& scene, const Vertex& x, const Vec3& from,
                                       bool transmit) {
  if (!x.on_surface() || !bsdf(scene, x).has_dirac()) return std::nullopt;
  return facet_direction(scene, x, from, transmit, Vec3(0, 0, 1));
}

double relative_index(const Scene& scene, const Vertex& x, const Vec3& w) {
  if (!x.on_surface()) return 1;
  return index_at(bsdf(scene, x), x.point.shading.to_local(w));
}

bool connectible(const Scene& scene, const Vertex& x) {
  if (x.on_surface()) return bsdf(scene, x).has_smooth();
  return !x.in_medium() || x.medium->scatters();
}

double to_measure(const Scene& scene, const Vertex& x, const Vertex& y, const Edge& x_to_y,
                  double pdf) {
  if (x.parallel()) return pdf * D(scene, y, x_to_y.w);
  if (y.infinite()) return pdf;
  const double density = pdf / sqr(x_to_y.length);
  return y.on_surface() ? density * std::abs(dot(y.point.n_g, x_to_y.w)) : density;
}

double pdf_emission(const Scene& scene, const Vertex& x, const Vertex& y, const Edge& x_to_y) {
  const double pdf = scene.emitter(x.emitter).pdf_direction(emitter_point(x), x_to_y.w);
  return to_measure(scene, x, y, x_to_y, pdf);
}

void look_at(const Scene& scene, Vertex& sensor, const Vec3& target) {
  if (sensor.kind == VertexKind::ParallelSensor)
    sensor.point.position = scene.sensor().position_seeing(target);
}

double pdf_importance(const Scene& scene, const Vertex& x, const Vec3& w) {
  return scene.sensor().pdf_sigma(x.position(), w);
}

EmitterPoint emitter_point(const Vertex& x) { return {x.point, x.id, 0}; }

double pdf_emitter_position(const Scene& scene, const Vertex& x) {
  if (x.emitter < 0) return 0;
  return scene.emitter_distribution().probability(x.emitter) *
         scene.emitter(x.emitter).pdf_position(emitter_point(x));
}

}  // namespace fogbow
