// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/transport.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>

namespace fogbow {

namespace {

/// Counts without contention: one counter a thread, summed when asked for.
class RayCounter {
 public:
  /// The thread's own. A plain pointer is found without asking whether it has been made.
  static RayCounter& own() {
    static constinit thread_local RayCounter* counter = nullptr;
    if (!counter) [[unlikely]] {
      static thread_local RayCounter made;
      counter = &made;
    }
    return *counter;
  }
  ~RayCounter() {
    const std::lock_guard lock(mutex());
    counters().erase(this);
    retired() += count_;
  }
  void operator++() {
    count_.store(count_.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  }
  static std::uint64_t total() {
    const std::lock_guard lock(mutex());
    std::uint64_t sum = retired();
    for (const RayCounter* counter : counters()) sum += counter->count_;
    return sum;
  }

 private:
  RayCounter() {
    const std::lock_guard lock(mutex());
    counters().insert(this);
  }
  // Never destroyed: threads may end after static objects have.
  static std::mutex& mutex() {
    static auto* m = new std::mutex;
    return *m;
  }
  static std::set<const RayCounter*>& counters() {
    static auto* all = new std::set<const RayCounter*>;
    return *all;
  }
  static std::uint64_t& retired() {
    static std::uint64_t n = 0;
    return n;
  }
  std::atomic<std::uint64_t> count_{0};
};

void count_ray() { ++RayCounter::own(); }

/// e^−depth; gray media are worth one exponential instead of three.
RGB transmittance(const RGB& depth) {
  if (depth.x == depth.y && depth.y == depth.z) return RGB(std::exp(-depth.x));
  return glm::exp(-depth);
}

/// Multiplies an edge's transmittance by that of one medium.
void attenuate(Edge& edge, const Medium* medium, const RGB& depth) {
  const RGB tau = transmittance(depth);
  edge.tau *= tau;
  if (is_sampled(medium)) edge.tau_q *= tau;
}
void attenuate(Edge& edge, const Medium* medium, const Ray& ray, double t0, double t1) {
  if (medium) attenuate(edge, medium, medium->optical_depth(ray, t0, t1));
}

/// What passes straight through a surface along w.
RGB passage(const Scene& scene, const Surface& surface, const SurfacePoint& point, const Vec3& w) {
  if (!scene.has_null_surfaces() || !surface.bsdf->has_passage()) return RGB(0);
  return surface.bsdf->passage(point, point.shading.to_local(w));
}

void pass(Edge& edge, const RGB& T) {
  if (T == RGB(1)) return;  // an index-matched boundary is nothing
  edge.tau *= T;
  edge.tau_q *= T;
  ++edge.passages;
}

const Medium* behind(const Surface& surface, const SurfacePoint& point, const Vec3& w,
                     const Medium* before) {
  if (!surface.medium_boundary) return before;
  return dot(w, point.n_g) > 0 ? surface.exterior.get() : surface.interior.get();
}

/// Optical depth that free flight is to cover, and the channel in which it is measured.
struct FreeFlight {
  int channel;
  double remaining;

  explicit FreeFlight(const Vec2& u)
      : channel(std::min(static_cast<int>(u.x * 3), 2)), remaining(-std::log1p(-u.y)) {}
  /// Whether it goes on behind a surface of passage T.
  bool passes(double T) {
    if (T == 0) return false;
    const double depth = -std::log(T);
    if (remaining < depth) return false;
    remaining -= depth;
    return true;
  }
};

void make_surface_vertex(const Scene& scene, const Hit& hit, const SurfacePoint& point,
                         const Medium* medium, Vertex& next) {
  next.kind = VertexKind::Surface;
  next.degenerate = false;
  next.point = point;
  next.id = hit.id;
  next.medium = medium;
  next.emitter = scene.emitter_of_surface(hit.id.shape);
}

void make_medium_vertex(const Scene& scene, const Vec3& position, const Medium* medium,
                        Vertex& next) {
  next.kind = VertexKind::Medium;
  next.degenerate = false;
  next.point.position = position;
  next.id = kNoPrimitive;
  next.medium = medium;
  next.emitter = medium->emits() ? scene.emitter_of_medium(medium) : -1;
}

/// Multiplies `edge` by the transmittance along the ray; false where a surface is in the way.
/// `medium` is the one at the ray's end.
bool unobstructed(const Scene& scene, Ray ray, const Vertex& start, PrimitiveId to, Edge& edge,
                  const Medium*& medium) {
  medium = medium_toward(scene, start, ray.d);
  PrimitiveId from = start.id;
  if (!scene.has_null_surfaces() && ray.t_max < kInfinity) {
    count_ray();
    if (scene.accel().occluded(ray(ray.t_min), ray(ray.t_max), from, to)) return false;
    attenuate(edge, medium, ray, ray.t_min, ray.t_max);
    return true;
  }
  for (;;) {
    count_ray();
    const auto hit = scene.accel().intersect(ray, from);
    if (!hit) {
      attenuate(edge, medium, ray, ray.t_min, ray.t_max);
      return true;
    }
    const Surface& surface = scene.surface(hit->id.shape);
    const SurfacePoint point = scene.surface_point(*hit);
    const RGB T = passage(scene, surface, point, ray.d);
    if (is_black(T)) return false;
    attenuate(edge, medium, ray, ray.t_min, hit->t);
    pass(edge, T);
    medium = behind(surface, point, ray.d, medium);
    ray.t_min = hit->t;
    from = hit->id;
  }
}

/// Follows the ray to the first surface that stops it, and tells `passed(medium, t0, t1)` what it
/// has come through. Where a surface lets a part T through, `crosses(T)` decides.
template <class Passed, class Crosses>
ExtendResult follow(const Scene& scene, const Vertex& x, Ray ray, Vertex& next, double& t,
                    Passed&& passed, Crosses&& crosses) {
  const Medium* medium = medium_toward(scene, x, ray.d);
  PrimitiveId from = x.id;
  for (;;) {
    count_ray();
    const auto hit = scene.accel().intersect(ray, from);
    t = hit ? hit->t : ray.t_max;
    passed(medium, ray.t_min, t);
    if (!hit) return t == kInfinity ? ExtendResult::Escaped : ExtendResult::Lost;
    const Surface& surface = scene.surface(hit->id.shape);
    const SurfacePoint point = scene.surface_point(*hit);
    const RGB T = passage(scene, surface, point, ray.d);
    if (is_black(T) || (T != RGB(1) && !crosses(T))) {
      make_surface_vertex(scene, *hit, point, medium, next);
      return ExtendResult::Reached;
    }
    medium = behind(surface, point, ray.d, medium);
    ray.t_min = t;
    from = hit->id;
  }
}

}  // namespace

std::uint64_t rays_traced() { return RayCounter::total(); }

ExtendResult extend(const Scene& scene, const Vertex& x, const Vec3& w, const Vec2& u, Vertex& next,
                    Edge& edge, double t_min, double t_max) {
  Ray ray{x.position(), w, t_min, t_max};
  const Medium* medium = medium_toward(scene, x, w);
  PrimitiveId from = x.id;
  FreeFlight flight(u);
  edge = Edge{w};
  for (;;) {
    // Only what lies in front of the free flight's end matters; but where flights cost more than
    // rays, they are to end at the surface.
    const bool flies = is_sampled(medium), flies_last = flies && medium->is_heterogeneous();
    FlightEnd end{t_max, false};
    if (flies && !flies_last)
      end = medium->fly(ray, ray.t_min, t_max, flight.channel, flight.remaining);
    ray.t_max = end.t;
    count_ray();
    const auto hit = scene.accel().intersect(ray, from);
    if (hit) end = {hit->t, false};
    if (flies_last)
      end = medium->fly(ray, ray.t_min, end.t, flight.channel, flight.remaining);
    else if (medium && !end.inside)
      end.depth = medium->optical_depth(ray, ray.t_min, end.t);
    if (medium) attenuate(edge, medium, end.depth);
    edge.length = end.t;
    if (end.inside) {
      make_medium_vertex(scene, ray(end.t), medium, next);
      return ExtendResult::Reached;
    }
    if (!hit) return t_max == kInfinity ? ExtendResult::Escaped : ExtendResult::Lost;
    const Surface& surface = scene.surface(hit->id.shape);
    const SurfacePoint point = scene.surface_point(*hit);
    if (flies) flight.remaining = std::max(flight.remaining - end.depth[flight.channel], 0.0);
    const RGB T = passage(scene, surface, point, w);
    if (!flight.passes(T[flight.channel])) {
      make_surface_vertex(scene, *hit, point, medium, next);
      return ExtendResult::Reached;
    }
    pass(edge, T);
    medium = behind(surface, point, w, medium);
    ray.t_min = end.t;
    ray.t_max = t_max;
    from = hit->id;
  }
}

ExtendResult extend_to_surface(const Scene& scene, const Vertex& x, const Vec3& w, Vertex& next,
                               Edge& edge, double t_min, double t_max, std::int64_t passages) {
  const Ray ray{x.position(), w, t_min, t_max};
  edge = Edge{w};
  return follow(
      scene, x, ray, next, edge.length,
      [&](const Medium* medium, double t0, double t1) { attenuate(edge, medium, ray, t0, t1); },
      [&](const RGB& T) {
        if (passages-- <= 0) return false;
        pass(edge, T);
        return true;
      });
}

ExtendResult trace_media(const Scene& scene, const Vertex& x, const Ray& ray, Vertex& next,
                         double& length,
                         const std::function<void(const Medium*, double, double)>& passed,
                         const std::function<bool(const RGB&)>& crosses) {
  return follow(scene, x, ray, next, length, passed, crosses);
}

/// More sections than most rays have; where there are more, the buffer grows once.
constexpr std::size_t kSections = 32;

/// Sections into which the way through a heterogeneous medium is cut: whoever asks for a distance
/// on it follows the ray through one of them alone.
constexpr int kCuts = 8;

void RayProfile::trace(const Scene& scene, const Vertex& x, const Vec3& w, double t_min,
                       double t_max) {
  ray_ = Ray{x.position(), w, t_min, t_max};
  sections_.clear();
  sections_.reserve(kSections);
  answers_.fill({-1, RGB(0)});
  edge_ = Edge{w};
  const auto add = [&](const Medium* medium, double t0, double t1) {
    sections_.push_back({t0, t1, medium, edge_.tau, edge_.tau_q, edge_.passages});
    attenuate(edge_, medium, ray_, t0, t1);
  };
  const auto passed = [&](const Medium* medium, double t0, double t1) {
    double a = t0, b = t1;
    if (medium && medium->is_heterogeneous() && clip(medium->support(), ray_, a, b))
      for (int i = 1; i < kCuts; ++i) {
        const double cut = a + (b - a) * i / kCuts;
        if (!(cut > t0 && cut < t1)) continue;
        add(medium, t0, cut);
        t0 = cut;
      }
    add(medium, t0, t1);
  };
  const auto crosses = [&](const RGB& T) {
    pass(edge_, T);
    return true;
  };
  has_wall_ = follow(scene, x, ray_, wall_, edge_.length, passed, crosses) == ExtendResult::Reached;
}

const RayProfile::Section& RayProfile::section_at(double t) const {
  std::size_t i = sections_.size() - 1;
  while (i > 0 && t < sections_[i].begin) --i;
  return sections_[i];
}

RGB RayProfile::tau_q(double t) const {
  const Section& s = section_at(t);
  if (!is_sampled(s.medium)) return s.tau_q;
  const auto compute = [&] {
    return s.tau_q * transmittance(s.medium->optical_depth(ray_, s.begin, std::min(t, s.end)));
  };
  if (!s.medium->is_heterogeneous()) return compute();
  // Laws of the distance ask of the same few places again and again.
  for (const auto& [at, tau] : answers_)
    if (at == t) return tau;
  std::ranges::rotate(answers_, answers_.end() - 1);
  answers_[0] = {t, compute()};
  return answers_[0].second;
}

std::optional<double> RayProfile::distance(int channel, double u) const {
  // The last section in which τ_q of the channel is still above 1 − u.
  std::size_t i = sections_.size() - 1;
  while (i > 0 && sections_[i].tau_q[channel] < 1 - u) --i;
  const Section& s = sections_[i];
  if (!is_sampled(s.medium)) return std::nullopt;
  const double depth = std::log(s.tau_q[channel]) - std::log1p(-u);
  return s.medium->distance(ray_, s.begin, s.end, channel, std::max(depth, 0.0));
}

const Medium* RayProfile::scatters_at(double t) const {
  const Section& s = section_at(t);
  return t > s.begin && t < s.end && s.medium && s.medium->scatters() ? s.medium : nullptr;
}

Vertex RayProfile::vertex(const Scene& scene, double t, Edge& edge) const {
  const Section& s = section_at(t);
  edge = Edge{ray_.d, t, s.tau, s.tau_q, s.passages};
  attenuate(edge, s.medium, ray_, s.begin, t);
  Vertex y;
  make_medium_vertex(scene, ray_(t), s.medium, y);
  return y;
}

Vec2 invert_distance(const Scene& scene, const Edge& edge, const Vertex& end,
                     const Vec2& auxiliary) {
  const RGB stop = RGB(1) - passage(scene, end, edge.w);  // of surfaces
  const RGB weights = edge.tau_q * (end.in_medium() ? end.medium->sigma_t(end.position()) : stop);
  double choice = auxiliary.x * (weights.x + weights.y + weights.z);
  int channel = 0;
  while (channel < 2 && choice >= weights[channel]) choice -= weights[channel++];
  const double within = std::min(choice / weights[channel], kOneMinusEpsilon);
  const double absorbed = 1 - edge.tau_q[channel];
  // At a wall every u in (1 − τ, 1) leads there, at a surface of passage T those in (1 − τ, 1 −
  // τT).
  const double u =
      end.in_medium() ? absorbed : absorbed + auxiliary.y * edge.tau_q[channel] * stop[channel];
  return {std::min((channel + within) / 3, kOneMinusEpsilon), std::min(u, kOneMinusEpsilon)};
}

std::optional<Edge> connect(const Scene& scene, const Vertex& a, const Vertex& b) {
  Edge edge;
  // Light from infinity is traced backwards: its vertex has no position to start from.
  const Vertex& start = a.infinite() ? b : a;
  Ray ray{start.position(), Vec3(0), 0, kInfinity};
  if (a.infinite()) {
    edge.w = a.point.n_g;
    edge.length = kInfinity;
    ray.d = -edge.w;
  } else {
    const Vec3 d = b.position() - a.position();
    edge.length = length(d);
    if (!(edge.length > 0)) return std::nullopt;
    edge.w = ray.d = b.parallel() ? -b.point.n_g : d / edge.length;
    if (!(dot(d, edge.w) > 0)) return std::nullopt;  // behind the film
    ray.t_max = edge.length;
  }
  if (b.on_sensor()) {
    const double near = scene.sensor().near_distance(-edge.w);
    const double far = scene.sensor().far_distance(-edge.w);
    if (a.infinite()) {
      ray.t_min = near;
      ray.t_max = far;
    } else {
      if (!(edge.length > near) || edge.length > far) return std::nullopt;
      ray.t_max = edge.length - near;
    }
  }
  const Medium* medium;
  if (!unobstructed(scene, ray, start, a.infinite() ? kNoPrimitive : b.id, edge, medium))
    return std::nullopt;
  return edge;
}

std::optional<Vertex> medium_vertex_at(const Scene& scene, const Vertex& x, const Vec3& w, double t,
                                       double t_min, Edge& edge) {
  edge = Edge{w, t};
  const Ray ray{x.position(), w, t_min, t};
  const Medium* medium;
  if (!(t > t_min) || !unobstructed(scene, ray, x, kNoPrimitive, edge, medium) ||
      !is_sampled(medium))
    return std::nullopt;
  Vertex y;
  make_medium_vertex(scene, ray(t), medium, y);
  return y;
}

}  // namespace fogbow
