// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/subpath.h"

namespace fogbow {

namespace {

VertexKind vertex_kind(EmitterKind kind) {
  switch (kind) {
    case EmitterKind::Area: return VertexKind::Surface;
    case EmitterKind::Point: return VertexKind::PointLight;
    case EmitterKind::Infinite: return VertexKind::InfiniteLight;
    case EmitterKind::Volume: return VertexKind::Medium;
  }
  return VertexKind::Surface;
}

/// What arrival at `next` by free flight, after leaving `x` with f̂ and pdf_sigma along next.edge,
/// makes of throughput and density.
bool arrive(const Scene& scene, const SubpathVertex& x, const RGB& f, double pdf_sigma,
            SubpathVertex& next) {
  const double distance = pdf_distance(next.edge, next.x);
  next.throughput =
      x.throughput * f * (D(scene, x.x, next.edge.w) / pdf_sigma) * (next.edge.tau / distance);
  return is_finite(next.throughput) && !is_black(next.throughput);
}

/// Walks on from the last vertex, whose way here is path.back().edge.
void walk(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path, Side side) {
  const bool eye = side == Side::Eye;
  while (static_cast<int>(path.size()) < max_vertices) {
    const Vec3 u_direction = u.next3();
    const double u_roulette = u.next();
    const Vec2 u_distance = u.next2();
    SubpathVertex& x = path.back();
    const std::size_t before = path.size() - 2;
    const auto sample = sample_direction(scene, x.x, -x.edge.w, side, u_direction, u_roulette,
                                         eye && path[before].x.degenerate);
    if (!sample) return;
    const Scattering& s = sample->scattering;
    const double pdf_sigma = eye ? s.pdf_to_light : s.pdf_to_eye;

    SubpathVertex next;
    const ExtendResult result = extend(scene, x.x, sample->w, u_distance, next.x, next.edge);
    if (result != ExtendResult::Reached &&
        !(eye && result == ExtendResult::Escaped && make_infinite_vertex(scene, next.edge, next.x)))
      return;
    if (!arrive(scene, x, s.f_hat, pdf_sigma, next)) return;
    next.pdf = pdf_arrival(next.x, next.edge, pdf_sigma);
    next.connects = connectible(scene, next.x);

    x.x.degenerate = sample->degenerate;
    const double reverse =
        pdf_arrival(path[before].x, reversed(x.edge), eye ? s.pdf_to_eye : s.pdf_to_light);
    path[before].other_techniques =
        other_techniques(scene, path, before, reverse, sample->degenerate, side);
    if (!eye && s.survival_to_light > 0) path[before].if_behind_specular = 1 / s.survival_to_light;
    path.push_back(next);
    if (next.x.infinite()) return;
  }
}

}  // namespace

bool sample_emitter(const Scene& scene, SampleStream& u, SubpathVertex& start) {
  const double u_emitter = u.next();
  const Vec3 u_position = u.next3();
  const std::size_t index = scene.emitter_distribution().sample(u_emitter);
  const Emitter& emitter = scene.emitter(index);
  const auto point = emitter.sample_position(u_position);
  if (!point) return false;
  Vertex& x = start.x;
  x.kind = vertex_kind(emitter.kind());
  x.point = point->surface;
  x.id = point->id;
  x.emitter = static_cast<int>(index);
  const bool bounds_media = x.on_surface() && scene.surface(x.id.shape).medium_boundary;
  if (!x.infinite() && !bounds_media)
    x.medium = scene.medium_around_emitter(x.emitter, x.position(), x.id);
  start.pdf = scene.emitter_distribution().probability(index) * point->pdf_position;
  start.throughput = RGB(1 / start.pdf);
  start.connects = true;
  return true;
}

bool make_infinite_vertex(const Scene& scene, const Edge& edge, Vertex& x) {
  if (scene.infinite_emitters().empty() || is_black(edge.tau)) return false;
  x = Vertex{};
  x.kind = VertexKind::InfiniteLight;
  x.point.n_g = -edge.w;
  x.emitter = scene.infinite_emitters().front();
  return true;
}

double other_techniques(const Scene& scene, const Subpath& path, std::size_t i, double pdf_reverse,
                        bool next_degenerate, Side side) {
  const double ratio = pdf_reverse / path[i].pdf;
  if (i == 0) return side == Side::Light && hittable(scene, path[0].x) ? ratio : 0;
  const bool connects = !path[i - 1].x.degenerate && !path[i].x.degenerate;
  const double factor = next_degenerate ? path[i - 1].if_behind_specular : 1.0;
  return ratio * (connects + factor * path[i - 1].other_techniques);
}

void trace_light_subpath(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path) {
  path.clear();
  SubpathVertex start;
  if (max_vertices < 1 || !sample_emitter(scene, u, start)) return;
  path.push_back(start);
  const Vec2 u_direction = u.next2();
  const Vec2 u_distance = u.next2();
  if (max_vertices < 2) return;

  const Emitter& emitter = scene.emitter(start.x.emitter);
  const EmitterPoint point = emitter_point(start.x);
  const EmitterDirection direction = emitter.sample_direction(point, u_direction);
  const RGB radiance = emitter.L_e(point, direction.w);
  if (is_black(radiance)) return;

  Vertex origin = start.x;
  if (start.x.infinite()) {
    origin.point.position = direction.origin;
    origin.medium = scene.medium_around_emitter(start.x.emitter, direction.origin, kNoPrimitive);
  }
  SubpathVertex next;
  if (extend(scene, origin, direction.w, u_distance, next.x, next.edge) != ExtendResult::Reached)
    return;
  if (!arrive(scene, start, radiance, direction.pdf_direction, next)) return;
  if (start.x.infinite()) next.edge.length = kInfinity;
  next.pdf = pdf_emission(scene, start.x, next.x, next.edge) * pdf_distance(next.edge, next.x);
  next.connects = connectible(scene, next.x);
  path.push_back(next);
  walk(scene, u, max_vertices, path, Side::Light);
}

void trace_eye_subpath(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path,
                       Vec2& raster) {
  path.clear();
  raster = u.next2();
  const Vec2 u_lens = u.next2();
  const Vec2 u_distance = u.next2();
  const Sensor& sensor = scene.sensor();
  SubpathVertex start;
  start.x.kind = VertexKind::Sensor;
  start.x.point.position = sensor.sample_position(u_lens);
  start.x.medium = scene.sensor_medium();
  start.pdf = sensor.pdf_A(start.x.position());
  start.throughput = RGB(1 / start.pdf);
  start.connects = true;
  path.push_back(start);
  if (max_vertices < 2) return;

  const SensorRay ray = sensor.sample_direction(start.x.position(), raster);
  SubpathVertex next;
  const ExtendResult result = extend(scene, start.x, ray.w, u_distance, next.x, next.edge,
                                     sensor.near_distance(ray.w), sensor.far_distance(ray.w));
  const bool beyond = result != ExtendResult::Reached;
  if (beyond && !make_infinite_vertex(scene, next.edge, next.x)) return;
  if (!arrive(scene, start, RGB(sensor.W_e(start.x.position(), ray.w)), ray.pdf_sigma, next))
    return;
  next.pdf = pdf_arrival(next.x, next.edge, ray.pdf_sigma);
  next.connects = connectible(scene, next.x);
  path.push_back(next);
  if (!next.x.infinite()) walk(scene, u, max_vertices, path, Side::Eye);
}

}  // namespace fogbow
