// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/laws/naive_proposals.h"

#include <algorithm>
#include <functional>
#include <limits>

namespace fogbow::testing {

namespace {

/// Radii of the scene between its middle and where a ray from infinity starts.
constexpr double kBeyond = 4;
/// Of finite differences.
constexpr double kStep = 2e-6;

struct LastRay {
  Vec3 o, d;
};

int last(const Path& path) { return static_cast<int>(path.size()) - 1; }

Vec3 from_infinity(const Scene& scene, const Vec3& through, const Vec3& w) {
  const Vec3 middle = through + dot(scene.bounds().center() - through, w) * w;
  return middle - kBeyond * scene.radius() * w;
}

bool transmits(const Path& path, int i) {
  const Vec3& n = path[i].point.shading.n;
  return dot(n, direction(path, i, i - 1)) * dot(n, direction(path, i, i + 1)) < 0;
}

/// The ray behind the last degenerate vertex when the direction at the start (from infinity: the
/// position across the light) is changed a little.
LastRay trace(const Scene& scene, const Path& path, const Stretch& s, const Vec3& change) {
  Vertex x = path[s.from];
  Vec3 w = direction(path, s.from, s.from + s.step());
  if (x.infinite())
    x.point.position = from_infinity(scene, path[s.from + 1].position(), w) + change;
  else if (x.parallel())
    x.point.position += change;
  else
    w = normalize(w + change);
  for (int i = s.from + s.step(); i != s.to; i += s.step()) {
    Vertex next;
    Edge edge;
    // Through as many surfaces as the path's own edge.
    const int link = std::min(i, i - s.step());
    const auto own = connect(scene, path[link], path[link + 1]);
    const bool reached = extend_to_surface(scene, x, w, next, edge, 0, kInfinity, own->passages) ==
                         ExtendResult::Reached;
    const auto out =
        reached ? specular_direction(scene, next, -w, transmits(path, i)) : std::nullopt;
    if (!out || next.id.shape != path[i].id.shape) return {Vec3(std::nan("")), Vec3(0)};
    w = *out;
    x = next;
  }
  return {x.position(), w};
}

double cosine(const Scene& scene, const Vertex& x, const Vec3& w) {
  if (x.on_sensor()) return scene.sensor().D(w);
  return x.on_surface() ? std::abs(dot(x.point.n_g, w)) : 1.0;
}

double distance(const Path& path, int i, int j) {
  return length(path[i].position() - path[j].position());
}

/// Log density in μ of the end of a stretch whose direction at the start has density one.
Measured log_density(const Scene& scene, const Path& path, const Stretch& s) {
  const Vec3 back = direction(path, s.to, s.to - s.step());
  Measured sum = log_ray_jacobian(scene, path, s);
  return sum += {std::log(cosine(scene, path[s.to], back))};
}

/// Solid angle density of a direction whose raster position is uniform; of parallel rays that
/// across them.
double raster_density(const Scene& scene, const Path& path) {
  const Vec3 o = path[last(path)].position(), w = direction(path, last(path), last(path) - 1);
  const Frame frame(w);
  const bool parallel = scene.sensor().parallel();
  const auto derivative = [&](const Vec3& e) {
    // One-sided where the film ends.
    const auto at = [&](double h) {
      return parallel ? scene.sensor().raster(o + h * e, w)
                      : scene.sensor().raster(o, normalize(w + h * e));
    };
    const auto more = at(kStep), less = at(-kStep);
    const double steps = (more ? kStep : 0) + (less ? kStep : 0);
    return (more.value_or(*at(0)) - less.value_or(*at(0))) / steps;
  };
  const Vec2 s = derivative(frame.s), t = derivative(frame.t);
  return std::abs(s.x * t.y - s.y * t.x);
}

/// The nearest vertex from i by steps that is not degenerate; −1 where there is none.
int free_vertex(const Path& path, int i, int step) {
  for (i += step; i >= 0 && i <= last(path); i += step)
    if (!path[i].degenerate) return i;
  return -1;
}

/// A stretch may be traced anew if what follows its end is connected by one edge, or if the eye's
/// subpath ends there in the light.
bool can_move(const Scene& scene, const Path& path, const Stretch& s) {
  if (s.to == last(path)) return false;
  return s.to == 0 ? hittable(scene, path[0]) : !path[s.to + s.step()].degenerate;
}

Measured log_traced(const Scene& scene, const Path& path, const Stretch& s) {
  Measured sum = log_density(scene, path, s);
  if (s.from == last(path)) sum += {std::log(raster_density(scene, path))};
  return sum;
}

// ---- distances along held rays ------------------------------------------------------------------

struct Held {
  int vertex, step;  ///< step: from what is held to the vertex
  int before() const { return vertex - step; }
  int beyond() const { return vertex + step; }
  int anchor(const Path& path) const { return free_vertex(path, vertex, -step); }
  int far(const Path& path) const { return free_vertex(path, vertex, step); }
};

Edge held_edge(const Scene& scene, const Path& path, const Held& h) {
  const int i = std::min(h.vertex, h.before());
  return *connect(scene, path[i], path[i + 1]);
}

std::vector<Held> held_vertices(const Scene& scene, const Path& path, bool flips) {
  std::vector<Held> all;
  for (int i = 1; i < last(path); ++i) {
    if (path[i].degenerate) continue;
    for (const int step : {1, -1}) {
      const Held h{i, step};
      const RGB tau_q = held_edge(scene, path, h).tau_q;
      const bool in_fog = path[i].in_medium() || std::min({tau_q.x, tau_q.y, tau_q.z}) < 1;
      const bool walks = flips && h.far(path) >= 0 && !path[h.far(path)].parallel();
      if (in_fog && (!path[h.beyond()].degenerate || walks)) all.push_back(h);
    }
  }
  return all;
}

/// Of choosing this vertex: flips whose far side takes a walk are eight times rarer.
double weight(const Path& path, const Held& h) { return path[h.beyond()].degenerate ? 0.125 : 1; }

/// The ray on which x's vertex moves, up to the wall.
struct Line {
  Vec3 o, w;
  double t = 0, wall = 0;
  RGB tau{1}, tau_wall{1};
  const Vertex* vertex;

  Line(const Scene& scene, const Path& path, const Held& h) : vertex(&path[h.vertex]) {
    Vertex start = path[h.before()];
    w = direction(path, h.before(), h.vertex);
    if (start.infinite()) {
      start.point.position = from_infinity(scene, vertex->position(), w);
      start.medium = scene.medium_around_emitter(start.emitter, start.position(), kNoPrimitive);
    }
    o = start.position();
    t = length(vertex->position() - o);
    tau = held_edge(scene, path, h).tau_q;
    Vertex end;
    Edge edge;
    const bool eye = start.on_sensor();
    extend_to_surface(scene, start, w, end, edge, eye ? scene.sensor().near_distance(w) : 0.0,
                      kInfinity, std::numeric_limits<std::int64_t>::max());
    wall = edge.length;
    tau_wall = edge.tau_q;
  }

  double u(int c) const { return 1 - tau[c]; }
  double u_wall(int c) const { return 1 - tau_wall[c]; }
  double du_dt(int c) const { return vertex->medium->sigma_t(vertex->position())[c] * tau[c]; }
};

/// Steps r in u have density 1/(r log 50) between u_M/50 and u_M.
double step_pdf(double r, double u_wall) {
  return r >= u_wall / 50 && r <= u_wall ? 1 / (r * std::log(50)) : 0.0;
}
/// … and are as long as r with this probability.
double step_at_least(double r, double u_wall) {
  return r <= u_wall / 50 ? 1 : std::log(u_wall / r) / std::log(50);
}

/// Of propagation, from x's vertex to y's, summed over channels.
double kernel(const Line& x, const Line& y) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const double wall = x.u_wall(c);
    if (!(wall > 0)) continue;
    if (!y.vertex->in_medium())
      sum += 0.5 * step_at_least(wall - x.u(c), wall);
    else if (!x.vertex->in_medium())
      sum += step_pdf(wall - y.u(c), wall) * y.du_dt(c);
    else
      sum += 0.5 * y.du_dt(c) *
             (step_pdf(std::abs(x.u(c) - y.u(c)), wall) + step_pdf(x.u(c) + y.u(c), wall));
  }
  return sum;
}

/// q(t) of a flip to the vertex in the medium that `y` ends on.
double flip_density(const Line& y, const Vertex& far) {
  double sum = 0;
  int channels = 0;
  for (int c = 0; c < 3; ++c) {
    const double wall = y.u_wall(c);
    if (!(wall > 0)) continue;
    ++channels;
    sum += 0.5 * y.du_dt(c) / wall + 0.5 * y.du_dt(c) * step_pdf(wall - y.u(c), wall);
  }
  sum /= channels;
  if (far.parallel()) return sum;
  const double foot = dot(far.position() - y.o, y.w);
  const double D = length(far.position() - y.o - foot * y.w);
  const double angle = std::atan((y.wall - foot) / D) + std::atan(foot / D);
  return 2.0 / 3 * sum + 1.0 / 3 * D / (angle * (D * D + sqr(y.t - foot)));
}

// ---- records ------------------------------------------------------------------------------------

using LogT = std::function<Measured(const Path& from, const Path& to)>;

Way way(const Scene& scene, int first, int last, const Path& x, const Path& y, const LogT& log_T) {
  Measured ratio = log_T(y, x);
  ratio -= log_T(x, y);
  ratio += log_reduced_over_formal(scene, y);
  ratio -= log_reduced_over_formal(scene, x);
  return {std::min(first, last), std::max(first, last), ratio};
}

std::vector<Way> eye_ways(const Scene& scene, const Path& x, const Path& y, bool several) {
  std::vector<Stretch> all;
  int end = last(x);
  do {
    const int next = free_vertex(x, end, -1);
    if (next < 0) return {};
    all.push_back({end, next});
    end = next;
  } while (!can_move(scene, x, all.back()));
  if ((all.size() > 1) != several) return {};
  return {way(scene, all.back().to, last(x) - 1, x, y, [&](const Path&, const Path& to) {
    Measured sum;
    for (const Stretch& s : all) sum += log_traced(scene, to, s);
    return sum;
  })};
}

std::vector<Way> caustic_ways(const Scene& scene, const Path& x, const Path& y) {
  const Stretch s{free_vertex(x, last(x) - 1, -1), last(x) - 1};
  return {way(scene, s.from + 1, s.to, x, y,
              [&](const Path&, const Path& to) { return log_density(scene, to, s); })};
}

std::vector<Way> scattering_ways(const Scene& scene, const Path& x, const Path& y) {
  std::vector<Way> all;
  for (int i = 1; i < last(x); ++i) {
    for (const int step : {1, -1}) {
      const Stretch s{i, free_vertex(x, i, step)};
      if (!x[i].in_medium() || s.to < 0 || !can_move(scene, x, s)) continue;
      all.push_back(way(scene, i + step, s.to, x, y,
                        [&](const Path&, const Path& to) { return log_density(scene, to, s); }));
    }
  }
  return all;
}

/// Vertices that may be moved in front of a chain, and the side on which it lies. A walk holds
/// glossy vertices of the chain as well, so what comes onto something glossy gains chains.
int manifold_choices(const Scene& scene, const Path& x) {
  int n = 0;
  for (int i = 0; i <= last(x); ++i) {
    for (const int step : {1, -1}) {
      const int moved = free_vertex(x, i, step);
      if (x[i].degenerate || moved < 0) continue;
      int far = moved + step;
      while (far > 0 && far < last(x) && (x[far].degenerate || is_glossy(scene, x[far])))
        far += step;
      n += far >= 0 && far <= last(x) && !x[far].degenerate && !x[far].parallel() &&
           std::abs(far - moved) >= 2;
    }
  }
  return n;
}

std::vector<Way> manifold_ways(const Scene& scene, const Path& x, const Path& y) {
  std::vector<Way> all;
  for (int i = 0; i <= last(x); ++i) {
    for (const int step : {1, -1}) {
      const Stretch s{i, free_vertex(x, i, step)};
      if (x[i].degenerate || s.to < 0) continue;
      const int far = free_vertex(x, s.to, step);
      if (far < 0 || std::abs(far - s.to) < 2 || x[far].parallel()) continue;
      all.push_back(way(scene, i + step, far - step, x, y, [&](const Path& from, const Path& to) {
        Measured sum = log_traced(scene, to, s);
        return sum += {-std::log(manifold_choices(scene, from))};
      }));
    }
  }
  return all;
}

std::vector<Way> held_ways(const Scene& scene, const Path& x, const Path& y, bool flips) {
  std::vector<Way> all;
  for (const Held& h : held_vertices(scene, x, flips)) {
    // Where the ray leads is held; the distance is not.
    const Vec3 turned = direction(x, h.before(), h.vertex) - direction(y, h.before(), h.vertex);
    if (length(turned) > 1e-7) continue;
    if (flips && x[h.vertex].in_medium() == y[h.vertex].in_medium()) continue;
    const auto log_T = [&](const Path& from, const Path& to) {
      const Line there(scene, to, h);
      const double q = !flips                     ? kernel(Line(scene, from, h), there)
                       : to[h.vertex].in_medium() ? flip_density(there, to[h.far(to)])
                                                  : 1.0;
      double all_weights = 0;
      for (const Held& other : held_vertices(scene, from, flips))
        all_weights += weight(from, other);
      Measured sum = log_density(scene, to, {h.anchor(to), h.vertex});
      return sum += {std::log(q * weight(from, h) / all_weights)};
    };
    const bool walks = x[h.beyond()].degenerate;
    all.push_back(way(scene, h.vertex, walks ? h.far(x) - h.step : h.vertex, x, y, log_T));
  }
  return all;
}

}  // namespace

Measured log_ray_jacobian(const Scene& scene, const Path& path, const Stretch& s) {
  const bool direct = s.from + s.step() == s.to, parallel = path[s.from].parallel();
  if (direct && (parallel || path[s.to].parallel())) return {};
  if (direct) return {-2 * std::log(distance(path, s.from, s.to))};
  const Frame start(direction(path, s.from, s.from + s.step()));
  const double h = parallel ? kStep * scene.radius() : kStep;
  const Vec3 across = direction(path, s.to - s.step(), s.to);
  const auto arrives = [&](const Vec3& change) {
    const LastRay ray = trace(scene, path, s, change);
    if (path[s.to].parallel()) return ray.d;
    const double t = dot(path[s.to].position() - ray.o, across) / dot(ray.d, across);
    return ray.o + t * ray.d;
  };
  const auto log_J = [&](const Vec3& ds, const Vec3& dt) {
    return -std::log(std::abs(dot(across, cross(ds, dt))) / sqr(h));
  };
  const Vec3 middle = arrives(Vec3(0));
  const Vec3 s_more = arrives(h * start.s) - middle, s_less = middle - arrives(-h * start.s);
  const Vec3 t_more = arrives(h * start.t) - middle, t_less = middle - arrives(-h * start.t);
  const double value = log_J((s_more + s_less) / 2.0, (t_more + t_less) / 2.0);
  const double error = std::abs(log_J(s_more, t_more) - log_J(s_less, t_less)) +
                       std::abs(log_J(s_more, t_less) - log_J(s_less, t_more));
  return {value, std::isfinite(value) && std::isfinite(error) ? error : kInfinity};
}

Measured log_reduced_over_formal(const Scene& scene, const Path& path) {
  Measured sum;
  for (int a = 0, b; a < last(path); a = b) {
    b = free_vertex(path, a, 1);
    if (b == a + 1) continue;
    // D_a and D_b are in both.
    sum += log_ray_jacobian(scene, path, {a, b});
    for (int i = a; i < b; ++i)
      if (!path[i].parallel() && !path[i + 1].parallel())
        sum += {2 * std::log(distance(path, i, i + 1))};
    for (int i = a + 1; i < b; ++i) {
      const SurfacePoint& p = path[i].point;
      const Vec3 in = direction(path, i, i - 1), out = direction(path, i, i + 1);
      const double eta = scene.surface(path[i].id.shape).bsdf->eta();
      const double n_eye = dot(p.shading.n, out) > 0 ? 1.0 : eta;
      const double formal = std::abs(dot(p.n_g, in) * dot(p.n_g, out));
      const double reduced = std::abs(dot(p.n_g, out) / dot(p.shading.n, out)) / sqr(n_eye);
      sum += {std::log(reduced / formal)};
    }
  }
  return sum;
}

std::vector<Way> ways(const std::string& mutation, const Scene& scene, const Path& x,
                      const Path& y) {
  if (mutation == "lens" || mutation == "multichain")
    return eye_ways(scene, x, y, mutation == "multichain");
  if (mutation == "caustic") return caustic_ways(scene, x, y);
  if (mutation == "scattering") return scattering_ways(scene, x, y);
  if (mutation == "manifold") return manifold_ways(scene, x, y);
  return held_ways(scene, x, y, mutation == "switch");
}

bool same_vertex(const Vertex& a, const Vertex& b) {
  if (a.kind != b.kind || a.degenerate != b.degenerate || a.emitter != b.emitter) return false;
  if (a.parallel()) return a.point.n_g == b.point.n_g;
  if (a.position() != b.position() || a.medium != b.medium) return false;
  return !a.on_surface() ||
         (a.id == b.id && a.point.n_g == b.point.n_g && a.point.shading.n == b.point.shading.n);
}

}  // namespace fogbow::testing
