// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>

#include "mlt/mutations/kernels.h"
#include "mlt/mutations/retrace.h"

namespace fogbow {

/// A vertex that can move along its last ray, and the side from which that ray is held.
struct HeldVertex {
  int vertex;
  Side held;

  int before() const { return held == Side::Light ? vertex - 1 : vertex + 1; }
  int beyond() const { return held == Side::Light ? vertex + 1 : vertex - 1; }
  /// Index of the edge between vertex and before().
  int held_edge() const { return std::min(vertex, before()); }
};

/// Calls visit(HeldVertex) for every interior vertex and side where vertices can lie both in a
/// medium and on the wall behind it; `through_specular`: also where the far side is a specular
/// chain.
template <class Visit>
void for_each_held_vertex(const MeasuredPath& x, bool through_specular, Visit&& visit) {
  for (int i = 1; i < x.last(); ++i) {
    if (x[i].degenerate) continue;
    for (const Side held : {Side::Light, Side::Eye}) {
      const HeldVertex h{i, held};
      if (x[h.beyond()].degenerate && !through_specular) continue;
      if (x[i].in_medium() || x.sees_medium(h.held_edge())) visit(h);
    }
  }
}

/// The ray that is held, with all the places of a vertex on it.
class HeldRay {
 public:
  /// False where the ray, traced anew, does not find x's vertex.
  bool trace(const Scene& scene, const MeasuredPath& x, const HeldVertex& held);

  const RayProfile& profile() const { return profile_; }
  /// Where x's vertex is on it.
  double t() const { return t_; }
  /// Whether a vertex can lie on the wall.
  bool has_wall(const Scene& scene) const {
    return profile_.has_wall() && connectible(scene, profile_.wall());
  }
  double wall() const { return profile_.length(); }

  /// Puts y's vertex to distance t, or onto the wall; false where none can be.
  bool move_into_medium(const Scene& scene, double t, MeasuredPath& y) const;
  void move_to_wall(MeasuredPath& y) const;

 private:
  void place(const Vertex& vertex, Edge edge, MeasuredPath& y) const;

  HeldVertex held_{};
  RayProfile profile_;
  bool parallel_ = false;
  double t_ = 0;
};

/// complete() after the held vertex has moved: its far neighbour is connected anew.
std::optional<Rejection> complete_move(PathSample& y, const HeldVertex& held);

/// dσ over dμ at the held vertex: what turns q(t) dt dω, or a mass times dω, into densities in μ.
double held_measure(const Scene& scene, const MeasuredPath& x, const HeldVertex& held);

// Laws of the distance. Each channel c has its own coordinate u = 1 − τ_c(t) on (0, u_M), u_M being
// the wall's; q in 1/length.

/// Steps in u, as parts of u_M.
class LocalSteps {
 public:
  LocalSteps(const RayProfile& profile, int channel);
  /// Nothing fits on this ray: the channel sees no medium.
  bool empty() const { return !(u_wall_ > 0); }
  double u_wall() const { return u_wall_; }

  /// From a distance: ≥ u_wall() is on the wall or beyond.
  double step(double t, Rng& rng) const;
  double step_off_wall(Rng& rng) const;
  /// The same as densities.
  double q(double from, double to) const;
  double mass_on_wall(double from) const;
  double q_off_wall(double to) const;
  /// Density of free flight that ends before the wall.
  double free_flight(double to) const { return du_dt(to) / u_wall_; }
  std::optional<double> distance(double u) const { return profile_.distance(channel_, u); }

 private:
  double u(double t) const { return 1 - profile_.tau_q(t)[channel_]; }
  double du_dt(double t) const;

  const RayProfile& profile_;
  int channel_;
  double u_wall_;
  StepSizes sizes_;
};

}  // namespace fogbow
