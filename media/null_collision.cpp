// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/null_collision.h"

#include <cmath>

namespace fogbow {

namespace {

/// Calls visit(t, σ_t(t), majorant) at tentative collisions from t0 to t1 until it says false.
template <class Visit>
void collide(const Medium& medium, const Ray& ray, double t0, double t1,
             const UniformSource& uniform, Visit&& visit) {
  double t = t0;
  while (t < t1) {
    const Majorant m = medium.majorant(ray, t, t1);
    // Exponential steps have no memory: at the end of a majorant they start anew.
    for (;;) {
      t -= std::log1p(-uniform()) / m.sigma_t;
      if (!(t < m.end)) break;
      if (!visit(t, medium.sigma_t(ray(t)), m.sigma_t)) return;
    }
    t = m.end;
  }
}

}  // namespace

RGB ratio_tracking(const Medium& medium, const Ray& ray, double t0, double t1,
                   const UniformSource& uniform) {
  RGB tau(1);
  collide(medium, ray, t0, t1, uniform, [&](double, const RGB& sigma_t, double majorant) {
    tau *= 1.0 - sigma_t / majorant;
    return !is_black(tau);
  });
  return tau;
}

NullCollisionFlight delta_tracking(const Medium& medium, const Ray& ray, double t0, double t1,
                                   const UniformSource& uniform) {
  NullCollisionFlight flight{t1, false, RGB(1)};
  collide(medium, ray, t0, t1, uniform, [&](double t, const RGB& sigma_t, double majorant) {
    // Channels share one flight: a collision is real as often as on average over them.
    const double real = mean(sigma_t) / majorant;
    if (uniform() < real) {
      flight.t = t;
      flight.inside = true;
      flight.weight /= mean(sigma_t);
      return false;
    }
    flight.weight *= (1.0 - sigma_t / majorant) / (1 - real);
    return true;
  });
  return flight;
}

}  // namespace fogbow
