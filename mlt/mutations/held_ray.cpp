// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/held_ray.h"

namespace fogbow {

namespace {

const StepSizes kSteps(0.02, 1);  ///< as parts of u_M

/// Away from what is held.
Edge held_edge(const MeasuredPath& x, const HeldVertex& h) {
  return h.held == Side::Light ? x.edge(h.held_edge()) : reversed(x.edge(h.held_edge()));
}

}  // namespace

bool HeldRay::trace(const Scene& scene, const MeasuredPath& x, const HeldVertex& held) {
  held_ = held;
  const Edge edge = held_edge(x, held);
  Vertex start = x[held.before()];
  parallel_ = start.infinite();
  t_ = edge.length;
  double near = 0, far = kInfinity;
  if (parallel_) {
    // The same start for every vertex on the ray: laws of the distance are asked from all of them.
    const Vec3 at = x[held.vertex].position(), center = scene.bounds().center();
    start = beyond_scene(scene, start, at + dot(center - at, edge.w) * edge.w);
    t_ = length(at - start.position());
  } else if (start.on_sensor()) {
    near = scene.sensor().near_distance(edge.w);
    far = scene.sensor().far_distance(edge.w);
  }
  profile_.trace(scene, start, edge.w, near, far);
  if (x[held.vertex].in_medium()) return profile_.scatters_at(t_) == x[held.vertex].medium;
  t_ = profile_.length();
  return profile_.has_wall() && profile_.wall().id == x[held.vertex].id;
}

bool HeldRay::move_into_medium(const Scene& scene, double t, MeasuredPath& y) const {
  if (!(t > 0) || !profile_.scatters_at(t)) return false;
  Edge edge;
  const Vertex vertex = profile_.vertex(scene, t, edge);
  place(vertex, edge, y);
  return true;
}

void HeldRay::move_to_wall(MeasuredPath& y) const { place(profile_.wall(), profile_.edge(), y); }

void HeldRay::place(const Vertex& vertex, Edge edge, MeasuredPath& y) const {
  if (parallel_) edge.length = kInfinity;
  y.vertex(held_.vertex) = vertex;
  y.set_edge(held_.held_edge(), held_.held == Side::Light ? edge : reversed(edge));
}

std::optional<Rejection> complete_move(PathSample& y, const HeldVertex& h) {
  const int first = std::min(h.vertex, h.beyond());
  y.path().measure_edge(y.scene(), h.held_edge());
  return complete(y, first, first + 1, first);
}

double held_measure(const Scene& scene, const MeasuredPath& x, const HeldVertex& held) {
  return to_measure(scene, x[held.before()], x[held.vertex], held_edge(x, held), 1);
}

LocalSteps::LocalSteps(const RayProfile& profile, int channel)
    : profile_(profile),
      channel_(channel),
      u_wall_(1 - profile.edge().tau_q[channel]),
      sizes_(kSteps.scaled(u_wall_)) {}

double LocalSteps::du_dt(double t) const {
  return profile_.scatters_at(t)->sigma_t(profile_.point(t))[channel_] *
         profile_.tau_q(t)[channel_];
}

double LocalSteps::step(double t, Rng& rng) const {
  const double delta = sizes_.sample(rng.uniform());
  return rng.uniform() < 0.5 ? u(t) + delta : std::abs(u(t) - delta);
}

double LocalSteps::step_off_wall(Rng& rng) const { return u_wall_ - sizes_.sample(rng.uniform()); }

double LocalSteps::q(double from, double to) const {
  const double a = u(from), b = u(to);
  return 0.5 * (sizes_.pdf(std::abs(b - a)) + sizes_.pdf(a + b)) * du_dt(to);
}

double LocalSteps::mass_on_wall(double from) const {
  return 0.5 * sizes_.at_least(u_wall_ - u(from));
}

double LocalSteps::q_off_wall(double to) const { return sizes_.pdf(u_wall_ - u(to)) * du_dt(to); }

}  // namespace fogbow
