// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/estimators/estimator.h"
#include "core/math/warp.h"
#include "media/null_collision.h"

namespace fogbow {

namespace {

/// A ray on its way from a vertex: `throughput` holds all factors up to and including D at x over
/// the density of w.
struct Flight {
  Vertex x;
  Vec3 w;
  double pdf_sigma = 0;  // of w
  RGB throughput{0};
  double t_min = 0, t_max = kInfinity;
  double index_ratio_squared = 1;  // (n here / n at the sensor)²
  int vertices = 1;                // of the path up to x
};

/// A vertex reached by free flight, with what is needed to know how else it could have been.
struct Arrival {
  Vertex y;
  Edge edge;
  RGB throughput{0};
};

class PathTracer final : public Estimator {
 public:
  PathTracer(const Scene& scene, const EstimatorSettings& settings)
      : scene_(scene), settings_(settings), max_vertices_(settings.max_depth + 1) {}

  void sample(SampleStream& light, SampleStream& eye, Workspace& w) const override;
  const char* name() const override { return "path"; }

 private:
  bool leave_sensor(SampleStream& eye, Vec2& raster, Flight& flight) const;
  bool arrive(const Flight& flight, SampleStream& eye, Arrival& arrival) const;
  bool arrive_by_null_collisions(const Flight& flight, SampleStream& eye, Arrival& arrival) const;
  bool scatter_on(const Arrival& at, SampleStream& eye, Flight& flight) const;

  /// Light that the flight from `previous` has run into.
  RGB emission(const Flight& before_previous, const Arrival& previous, const Flight& flight,
               const Arrival& at) const;
  /// Next-event estimation at the end of a free flight.
  RGB direct(const Flight& flight, const Arrival& at, SampleStream& light) const;
  /// Next-event estimation at an equiangular distance on the flight's ray.
  RGB direct_equiangular(const Flight& flight, SampleStream& light) const;
  /// f/p of one light point seen from y, and the density of running into it instead.
  std::optional<std::pair<RGB, double>> see(const SubpathVertex& light, const Vertex& y,
                                            const Vec3& w_eye, SampleStream& u) const;
  /// An estimate of the transmittance from a to b, between which nothing stands.
  RGB ratio_transmittance(const Vertex& a, const Vertex& b, const Edge& a_to_b,
                          SampleStream& u) const;
  /// False where the flight cannot meet a medium: equiangular distances would be wasted on it.
  bool may_scatter(const Flight& flight) const {
    if (settings_.null_collisions) return false;
    return is_sampled(medium_toward(scene_, flight.x, flight.w)) ||
           (scene_.has_media() && scene_.has_null_surfaces());
  }
  warp::Equiangular equiangular_law(const Flight& flight, const Vec3& light) const;
  /// How many times likelier an equiangular distance towards `light` is than the free flight that
  /// led to y.
  double share(const Flight& flight, const Arrival& at, const Vertex& light) const;

  const Scene& scene_;
  EstimatorSettings settings_;
  int max_vertices_;
};

/// On the whole way through the scene: where the wall is, free flight need not have found out.
warp::Equiangular PathTracer::equiangular_law(const Flight& flight, const Vec3& light) const {
  const double foot = dot(light - flight.x.position(), flight.w);
  const double height = length(light - flight.x.position() - foot * flight.w);
  const double exit =
      dot(scene_.bounds().center() - flight.x.position(), flight.w) + scene_.radius();
  return {foot, height, flight.t_min, std::min(flight.t_max, exit)};
}

double PathTracer::share(const Flight& flight, const Arrival& at, const Vertex& light) const {
  if (!at.y.in_medium() || !may_scatter(flight) || light.infinite()) return 0;
  const warp::Equiangular law = equiangular_law(flight, light.position());
  const double t = at.edge.length;
  if (!(law.distance > 0) || !(t > law.t0 && t < law.t1)) return 0;
  return law.pdf(t) / pdf_distance(scene_, at.edge, at.y);
}

bool PathTracer::leave_sensor(SampleStream& eye, Vec2& raster, Flight& flight) const {
  raster = eye.next2();
  const Sensor& sensor = scene_.sensor();
  flight.x = sample_sensor(scene_, eye.next2());
  const SensorRay ray = sensor.sample_direction(flight.x.position(), raster);
  flight.x.point.position = ray.origin;
  flight.w = ray.w;
  flight.pdf_sigma = ray.pdf_sigma;
  flight.t_min = sensor.near_distance(ray.w);
  flight.t_max = sensor.far_distance(ray.w);
  flight.throughput = RGB(W_e(scene_, flight.x, ray.w) * D(scene_, flight.x, ray.w) /
                          (ray.pdf_sigma * sensor.pdf_A(flight.x.position())));
  return !is_black(flight.throughput);
}

bool PathTracer::arrive_by_null_collisions(const Flight& flight, SampleStream& eye,
                                           Arrival& at) const {
  const Ray ray{flight.x.position(), flight.w, flight.t_min, flight.t_max};
  const UniformSource uniform = [&] { return eye.next(); };
  NullCollisionFlight end{0, false, RGB(1)};
  at.edge = Edge{flight.w, 0, RGB(1), RGB(1)};
  at.throughput = flight.throughput;
  const auto pass_medium = [&](const Medium* medium, double t0, double t1) {
    if (!medium || end.inside) return;
    if (is_sampled(medium))
      end = delta_tracking(*medium, ray, t0, t1, uniform);
    else
      end.weight = ratio_tracking(*medium, ray, t0, t1, uniform);
    at.throughput *= end.weight;
  };
  const auto pass_surface = [&](const RGB& T) {
    if (end.inside) return false;
    const bool passes = uniform() < mean(T);
    at.throughput *= passes ? T / mean(T) : RGB(1 / (1 - mean(T)));
    return passes;
  };
  const ExtendResult result =
      trace_media(scene_, flight.x, ray, at.y, at.edge.length, pass_medium, pass_surface);
  if (end.inside) {
    const auto y = medium_vertex_at(scene_, flight.x, flight.w, end.t, flight.t_min, at.edge);
    if (!y) return false;
    at.y = *y;
  } else if (result != ExtendResult::Reached && !make_infinite_vertex(scene_, at.edge, at.y)) {
    return false;
  }
  return is_finite(at.throughput) && !is_black(at.throughput);
}

RGB PathTracer::ratio_transmittance(const Vertex& a, const Vertex& b, const Edge& a_to_b,
                                    SampleStream& u) const {
  const bool backwards = a.infinite();
  Vertex unused;
  double length;
  RGB tau(1);
  const Ray ray{backwards ? b.position() : a.position(), backwards ? -a_to_b.w : a_to_b.w, 0,
                a_to_b.length};
  const auto pass_medium = [&](const Medium* medium, double t0, double t1) {
    if (medium) tau *= ratio_tracking(*medium, ray, t0, t1, [&] { return u.next(); });
  };
  const auto pass_surface = [&](const RGB& T) {
    tau *= T;
    return true;
  };
  trace_media(scene_, backwards ? b : a, ray, unused, length, pass_medium, pass_surface);
  return tau;
}

bool PathTracer::arrive(const Flight& flight, SampleStream& eye, Arrival& at) const {
  if (settings_.null_collisions) return arrive_by_null_collisions(flight, eye, at);
  const ExtendResult result =
      extend(scene_, flight.x, flight.w, eye.next2(), at.y, at.edge, flight.t_min, flight.t_max);
  if (result != ExtendResult::Reached && !make_infinite_vertex(scene_, at.edge, at.y)) return false;
  at.throughput = flight.throughput * at.edge.tau / pdf_distance(scene_, at.edge, at.y);
  return is_finite(at.throughput) && !is_black(at.throughput);
}

bool PathTracer::scatter_on(const Arrival& at, SampleStream& eye, Flight& flight) const {
  const Vec3 from = -flight.w;
  const Vec3 u = eye.next3();
  const double u_roulette = eye.next();
  // The local roulette of bidirectional subpaths is left out (v = 0); here the whole throughput
  // decides.
  const auto sample = sample_direction(scene_, at.y, from, Side::Eye, u, 0.0, false);
  if (!sample) return false;
  const Scattering& s = sample->scattering;
  flight.pdf_sigma = s.pdf_to_light / s.survival_to_light;
  flight.throughput = at.throughput * s.f_hat * (D(scene_, at.y, sample->w) / flight.pdf_sigma);
  flight.index_ratio_squared *=
      sqr(relative_index(scene_, at.y, sample->w) / relative_index(scene_, at.y, from));
  flight.x = at.y;
  flight.x.degenerate = sample->degenerate;
  flight.w = sample->w;
  flight.t_min = 0;
  flight.t_max = kInfinity;
  ++flight.vertices;
  if (flight.vertices > settings_.rr_depth) {
    // The n² of radiance is undone when the ray leaves the glass again: it must not kill the path.
    // No cap below one: where little is absorbed, dividing by it would let throughputs, and their
    // variance, grow with every bounce.
    const double survival =
        std::min(1.0, max_component(flight.throughput) * flight.index_ratio_squared);
    if (!(u_roulette < survival)) return false;
    flight.throughput /= survival;
  }
  return true;
}

RGB PathTracer::emission(const Flight& before_previous, const Arrival& previous,
                         const Flight& flight, const Arrival& at) const {
  if (!hittable(scene_, at.y)) return RGB(0);
  const RGB value = at.throughput * L_e(scene_, at.y, -flight.w);
  if (is_black(value) || flight.x.on_sensor() || flight.x.degenerate) return value;
  // direct() has the rest: at points of an emitting medium, it would find hardly bounded values.
  if (settings_.null_collisions) return at.y.in_medium() ? value : RGB(0);
  const double pdf_hit = pdf_arrival(scene_, flight.x, at.y, at.edge, flight.pdf_sigma);
  const double pdf_light = pdf_emitter_position(scene_, at.y);
  const double pdf_others = pdf_light * (1 + share(before_previous, previous, at.y));
  return value * (pdf_hit / (pdf_hit + pdf_others));
}

std::optional<std::pair<RGB, double>> PathTracer::see(const SubpathVertex& light, const Vertex& y,
                                                      const Vec3& w_eye, SampleStream& u) const {
  const Vec3 w =
      light.x.infinite() ? light.x.point.n_g : normalize(y.position() - light.x.position());
  const RGB radiance = L_e(scene_, light.x, w);
  if (is_black(radiance)) return std::nullopt;
  const Scattering s = scatter(scene_, y, -w, w_eye, false, false);
  if (is_black(s.f_hat)) return std::nullopt;
  auto edge = connect(scene_, light.x, y);
  if (!edge) return std::nullopt;
  if (settings_.null_collisions) edge->tau = ratio_transmittance(light.x, y, *edge, u);
  const RGB value =
      radiance * geometric_term(scene_, light.x, y, *edge) * edge->tau * s.f_hat / light.pdf;
  double pdf_hit = 0;
  if (hittable(scene_, light.x) && s.pdf_to_light > 0)
    pdf_hit =
        pdf_arrival(scene_, y, light.x, reversed(*edge), s.pdf_to_light / s.survival_to_light);
  return std::pair(value, pdf_hit);
}

RGB PathTracer::direct(const Flight& flight, const Arrival& at, SampleStream& u) const {
  SubpathVertex light;
  if (!connectible(scene_, at.y) || !sample_emitter(scene_, u, light)) return RGB(0);
  if (settings_.null_collisions && light.x.in_medium()) return RGB(0);
  const auto seen = see(light, at.y, -flight.w, u);
  if (!seen) return RGB(0);
  if (settings_.null_collisions) return at.throughput * seen->first;
  const double pdf_both = light.pdf * (1 + share(flight, at, light.x));
  return at.throughput * seen->first * (light.pdf / (pdf_both + seen->second));
}

RGB PathTracer::direct_equiangular(const Flight& flight, SampleStream& u) const {
  SubpathVertex light;
  const bool lit = sample_emitter(scene_, u, light);
  const double u_distance = u.next();
  if (!lit || light.x.infinite()) return RGB(0);
  const warp::Equiangular law = equiangular_law(flight, light.x.position());
  if (!(law.distance > 0) || !(law.t1 > law.t0)) return RGB(0);
  const double t = law.sample(u_distance);
  Arrival at;
  const auto y = medium_vertex_at(scene_, flight.x, flight.w, t, flight.t_min, at.edge);
  if (!y || !connectible(scene_, *y)) return RGB(0);
  const auto seen = see(light, *y, -flight.w, u);
  if (!seen) return RGB(0);
  const double q = law.pdf(t), free_flight = pdf_distance(scene_, at.edge, *y);
  const double pdf = q * light.pdf;
  const double pdf_others = free_flight * (light.pdf + seen->second);
  return flight.throughput * at.edge.tau / q * seen->first * (pdf / (pdf + pdf_others));
}

void PathTracer::sample(SampleStream& light, SampleStream& eye, Workspace& w) const {
  w.contributions.clear();
  Flight flight, before;
  Arrival at, previous;
  Vec2 raster;
  if (!leave_sensor(eye, raster, flight)) return;
  const auto add = [&](const RGB& value, int k, int s) { w.add({raster, value, k, s, k - s}); };
  const auto add_emission = [&](int k) {
    if (!settings_.hides(scene_, at.y, k)) add(emission(before, previous, flight, at), k, 0);
  };
  for (;;) {
    const int k = flight.vertices + 1;  // vertices of the path that ends at the next one
    if (k > max_vertices_) return;
    if (k < max_vertices_ && may_scatter(flight)) add(direct_equiangular(flight, light), k + 1, 1);
    if (!arrive(flight, eye, at)) {
      w.refused += !is_finite(at.throughput);
      return;
    }
    if (at.y.infinite()) {
      for (const int emitter : scene_.infinite_emitters()) {
        at.y.emitter = emitter;
        add_emission(k);
      }
      return;
    }
    add_emission(k);
    if (k == max_vertices_) return;
    add(direct(flight, at, light), k + 1, 1);
    // Only at a medium vertex is the flight that led there asked for again.
    previous.y.kind = at.y.kind;
    if (at.y.in_medium()) {
      before = flight;
      previous = at;
    }
    if (!scatter_on(at, eye, flight)) return;
  }
}

}  // namespace

std::unique_ptr<Estimator> make_path_tracer(const Scene& scene, const EstimatorSettings& settings) {
  return std::make_unique<PathTracer>(scene, settings);
}

}  // namespace fogbow
