// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/manifold/walk.h"

#include "core/path/specular_chain.h"

namespace fogbow {

namespace {

constexpr int kMaxSteps = 20, kMaxHalvings = 6;
/// How near the last ray must come to the end, and how near a walk back to where it started; in
/// radii of the scene. Newton's last step squares the error: what has converged is far below.
constexpr double kConverged = 1e-9, kReturned = 1e-6;

/// The ray that leaves the last specular vertex.
struct LastRay {
  Vec3 origin, w;
  double t;       ///< where it comes nearest to the target
  Vec3 residual;  ///< from there to the target
};

LastRay last_ray(const MeasuredPath& y, const Segment& s, const Vec3& w, const Vec3& target) {
  LastRay ray;
  ray.origin = y[s.end - s.step()].position();
  ray.w = w;
  ray.t = dot(target - ray.origin, w);
  ray.residual = target - (ray.origin + ray.t * w);
  return ray;
}

/// Direction from vertex i of the segment to the next.
Vec3 onward(const MeasuredPath& y, const Segment& s, int i) {
  return s.toward == Side::Eye ? y.to_eye(i) : y.to_light(i);
}

RayBundle bundle_of(const Scene& scene, const MeasuredPath& y, const Segment& s, const Vec3& last) {
  RayBundle bundle(y[s.anchor], onward(y, s, s.anchor));
  for (int i = s.anchor + s.step(); i != s.end; i += s.step()) {
    const double t = y.edge(std::min(i, i - s.step())).length;
    bundle.scatter(scene, y[i], t, i + s.step() == s.end ? last : onward(y, s, i));
  }
  return bundle;
}

/// Newton's step of the direction at the anchor, in its tangent plane; nothing at a caustic.
std::optional<Vec3> newton_step(const Scene& scene, const MeasuredPath& y, const Segment& s,
                                const LastRay& ray) {
  const RayBundle bundle = bundle_of(scene, y, s, ray.w);
  const auto d = bundle.spread(ray.t);
  // d0 a + d1 b = residual across the ray, by Cramer's rule.
  const double det = dot(ray.w, cross(d[0], d[1]));
  const double a = dot(ray.w, cross(ray.residual, d[1])) / det;
  const double b = dot(ray.w, cross(d[0], ray.residual)) / det;
  if (!std::isfinite(a) || !std::isfinite(b)) return std::nullopt;
  return a * bundle.across().s + b * bundle.across().t;
}

}  // namespace

std::optional<Segment> held_chain_from(const Scene& scene, const MeasuredPath& x, int anchor,
                                       Side toward) {
  Segment s{anchor, anchor, toward};
  do {
    s.end += s.step();
    if (s.end < 0 || s.end >= x.size()) return std::nullopt;
  } while (x[s.end].degenerate || (s.end > 0 && s.end < x.last() && is_glossy(scene, x[s.end])));
  return s;
}

bool walk(const Scene& scene, MeasuredPath& y, const Segment& s) {
  if (y[s.anchor].parallel()) return false;
  const Vec3 target = y[s.end].position();
  const double near = kConverged * scene.radius();
  thread_local MeasuredPath trial;
  thread_local std::vector<Vec3> facets;
  facets.clear();
  facets.reserve(y.capacity());
  for (int i = s.anchor + s.step(); i != s.end; i += s.step())
    facets.push_back(y[i].degenerate ? Vec3(0, 0, 1)
                                     : facet_normal(scene, y[i], y.to_light(i), y.to_eye(i)));
  // Even the first chain is traced anew: what follows from it then depends on its first direction.
  Vec3 direction = departure(y, s), w = direction;
  if (retrace_chain(scene, y, s, w, facets)) return false;
  LastRay ray = last_ray(y, s, w, target);
  for (int i = 0; i < kMaxSteps; ++i) {
    if (!(ray.t > 0)) return false;
    const double distance = length(ray.residual);
    if (distance <= near) return true;
    const auto step = newton_step(scene, y, s, ray);
    if (!step) return false;
    bool nearer = false;
    double part = 1;
    for (int h = 0; h < kMaxHalvings && !nearer; ++h, part /= 2) {
      const Vec3 tried = normalize(direction + part * *step);
      trial = y;
      w = tried;
      if (retrace_chain(scene, trial, s, w, facets)) continue;
      const LastRay last = last_ray(trial, s, w, target);
      if (!(length(last.residual) < distance)) continue;
      nearer = true;
      direction = tried;
      ray = last;
      y = trial;
    }
    if (!nearer) return false;
  }
  return false;
}

bool returns(const Scene& scene, const MeasuredPath& x, const MeasuredPath& y, const Segment& s) {
  thread_local MeasuredPath back;
  back = y;
  back.vertex(s.end) = x[s.end];
  if (!walk(scene, back, s)) return false;
  for (int i = s.anchor + s.step(); i != s.end; i += s.step())
    if (!(length(back[i].position() - x[i].position()) <= kReturned * scene.radius())) return false;
  return true;
}

double log_reduction(const Scene& scene, const MeasuredPath& x, const Segment& s) {
  return std::log(
      chain_correction(scene, x.vertices(), std::min(s.anchor, s.end), std::max(s.anchor, s.end)));
}

}  // namespace fogbow
