// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/subpath.h"

namespace fogbow {

namespace {

VertexKind vertex_kind(EmitterKind kind) {
  switch (kind) {
    case EmitterKind::Area: return VertexKind::Surface;
    case EmitterKind::Point: return VertexKind::PointLight;
    case EmitterKind::Directional:
    case EmitterKind::Infinite: return VertexKind::InfiniteLight;
    case EmitterKind::Volume: return VertexKind::Medium;
  }
  return VertexKind::Surface;
}

/// What arrival by `step`, after leaving `x` with f̂, makes of throughput and density.
bool arrive(const Scene& scene, const SubpathVertex& x, const RGB& f, const Step& step,
            SubpathVertex& next) {
  next.x = step.next;
  next.edge = step.edge;
  const double distance = pdf_distance(scene, step.edge, step.next);
  next.throughput =
      x.throughput * f * (D(scene, x.x, step.edge.w) / step.pdf_sigma) * (step.edge.tau / distance);
  next.pdf = distance * to_measure(scene, x.x, step.next, step.edge, step.pdf_sigma);
  next.connects = connectible(scene, next.x);
  return is_finite(next.throughput) && !is_black(next.throughput);
}

/// Follows the ray; the eye also arrives at infinite emitters.
bool go(const Scene& scene, const Vertex& x, const Vec3& w, const Vec2& u_distance, Side side,
        Step& step, double t_min = 0, double t_max = kInfinity) {
  switch (extend(scene, x, w, u_distance, step.next, step.edge, t_min, t_max)) {
    case ExtendResult::Reached: return true;
    case ExtendResult::Escaped:
    case ExtendResult::Lost:
      // A far plane hides surfaces, not the sky.
      if (side == Side::Light || !make_infinite_vertex(scene, step.edge, step.next)) return false;
      step.edge.length = kInfinity;
      return true;
  }
  return false;
}

/// Walks on from the last vertex, whose way here is path.back().edge; as trace_light_subpath().
bool walk(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path, Side side) {
  const bool eye = side == Side::Eye;
  while (static_cast<int>(path.size()) < max_vertices) {
    SubpathVertex& x = path.back();
    const std::size_t before = path.size() - 2;
    Step step;
    const auto sample =
        leave_vertex(scene, x.x, -x.edge.w, side, eye && path[before].x.degenerate, u, step);
    if (!sample) return true;
    const Scattering& s = sample->scattering;
    SubpathVertex next;
    if (!arrive(scene, x, s.f_hat, step, next)) return is_finite(next.throughput);

    x.x.degenerate = sample->degenerate;
    const double reverse = pdf_arrival(scene, x.x, path[before].x, reversed(x.edge),
                                       eye ? s.pdf_to_eye : s.pdf_to_light);
    path[before].other_techniques =
        other_techniques(scene, path, before, reverse, sample->degenerate, side);
    if (!eye && s.survival_to_light > 0) path[before].if_behind_specular = 1 / s.survival_to_light;
    path.push_back(next);
    if (next.x.infinite()) return true;
  }
  return true;
}

}  // namespace

bool leave_emitter(const Scene& scene, const Vertex& x, const Vec2& u_direction,
                   const Vec2& u_distance, Step& step) {
  const Emitter& emitter = scene.emitter(x.emitter);
  const EmitterDirection direction = emitter.sample_direction(emitter_point(x), u_direction);
  step.pdf_sigma = direction.pdf_direction;
  Vertex origin = x;
  if (x.infinite()) {
    origin.point.position = direction.origin;
    origin.medium = scene.medium_around_emitter(x.emitter, direction.origin, kNoPrimitive);
  }
  if (!go(scene, origin, direction.w, u_distance, Side::Light, step)) return false;
  if (x.infinite()) step.edge.length = kInfinity;
  return true;
}

bool leave_sensor(const Scene& scene, Vertex& x, const Vec2& raster, const Vec2& u_distance,
                  Step& step) {
  const Sensor& sensor = scene.sensor();
  const SensorRay ray = sensor.sample_direction(x.position(), raster);
  x.point.position = ray.origin;
  step.pdf_sigma = ray.pdf_sigma;
  return go(scene, x, ray.w, u_distance, Side::Eye, step, sensor.near_distance(ray.w),
            sensor.far_distance(ray.w));
}

std::optional<DirectionSample> leave_vertex(const Scene& scene, const Vertex& x, const Vec3& from,
                                            Side side, bool behind_specular, SampleStream& u,
                                            Step& step) {
  const Vec3 u_direction = u.next3();
  const double u_roulette = u.next();
  const Vec2 u_distance = u.next2();
  const auto sample =
      sample_direction(scene, x, from, side, u_direction, u_roulette, behind_specular);
  if (!sample) return std::nullopt;
  const Scattering& s = sample->scattering;
  step.pdf_sigma = side == Side::Eye ? s.pdf_to_light : s.pdf_to_eye;
  if (!go(scene, x, sample->w, u_distance, side, step)) return std::nullopt;
  return sample;
}

Vertex sample_sensor(const Scene& scene, const Vec2& u) {
  Vertex x;
  const Sensor& sensor = scene.sensor();
  x.kind = sensor.parallel() ? VertexKind::ParallelSensor : VertexKind::Sensor;
  x.point.position = sensor.sample_position(u);
  if (sensor.parallel()) x.point.n_g = sensor.sample_direction(x.position(), Vec2(0.5)).w;
  x.medium = scene.sensor_medium();
  return x;
}

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
  if (x.on_surface()) x.id.shape = scene.name_at(x.id.shape, x.point);
  if (x.on_surface()) x.point.shape = scene.surface(x.id.shape).shape.get();
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
  const bool connects =
      !path[i - 1].x.degenerate && !path[i].x.degenerate && has_ray(path[i - 1].x, path[i].x);
  const double factor = next_degenerate ? path[i - 1].if_behind_specular : 1.0;
  return ratio * (connects + factor * path[i - 1].other_techniques);
}

bool trace_light_subpath(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path) {
  path.clear();
  SubpathVertex start;
  if (max_vertices < 1 || !sample_emitter(scene, u, start)) return true;
  path.push_back(start);
  const Vec2 u_direction = u.next2();
  const Vec2 u_distance = u.next2();
  Step step;
  if (max_vertices < 2 || !leave_emitter(scene, start.x, u_direction, u_distance, step))
    return true;
  SubpathVertex next;
  if (!arrive(scene, start, L_e(scene, start.x, step.edge.w), step, next))
    return is_finite(next.throughput);
  path.push_back(next);
  return walk(scene, u, max_vertices, path, Side::Light);
}

bool trace_eye_subpath(const Scene& scene, SampleStream& u, int max_vertices, Subpath& path,
                       Vec2& raster) {
  path.clear();
  raster = u.next2();
  const Vec2 u_lens = u.next2();
  const Vec2 u_distance = u.next2();
  SubpathVertex start;
  start.x = sample_sensor(scene, u_lens);
  start.pdf = scene.sensor().pdf_A(start.x.position());
  start.throughput = RGB(1 / start.pdf);
  start.connects = true;
  path.push_back(start);
  if (max_vertices < 2) return true;
  Step step;
  const bool seen = leave_sensor(scene, start.x, raster, u_distance, step);
  path.front().x = start.x;
  if (!seen) return true;
  SubpathVertex next;
  if (!arrive(scene, start, RGB(W_e(scene, start.x, step.edge.w)), step, next))
    return is_finite(next.throughput);
  path.push_back(next);
  return next.x.infinite() || walk(scene, u, max_vertices, path, Side::Eye);
}

}  // namespace fogbow
