// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/technique_sample.h"

#include "core/path/subpath_inverse.h"
#include "core/path/techniques.h"

namespace fogbow {

namespace {

std::optional<Rejection> trace(const Scene& scene, int s, int t, SampleStream& u, Subpath& light,
                               Subpath& eye) {
  Vec2 raster;
  if (!trace_eye_subpath(scene, u, t, eye, raster)) return Rejection::NonFinite;
  if (static_cast<int>(eye.size()) < t) return Rejection::MissedScene;
  light.clear();
  if (s > 0 && !trace_light_subpath(scene, u, s, light)) return Rejection::NonFinite;
  if (static_cast<int>(light.size()) < s) return Rejection::MissedScene;
  if (s > 0 && (!light[s - 1].connects || !eye[t - 1].connects || eye[t - 1].x.infinite()))
    return Rejection::WrongConfiguration;
  if (s > 0) return std::nullopt;
  if (t < 2 || !hittable(scene, eye[t - 1].x)) return Rejection::WrongConfiguration;
  choose_infinite_emitter(scene, eye[t - 1].x, u);
  return std::nullopt;
}

}  // namespace

std::optional<Rejection> sample_technique(int s, int t, SampleStream& u, PathSample& y) {
  thread_local Subpath light, eye;
  light.reserve(y.path().capacity());
  eye.reserve(y.path().capacity());
  if (const auto why = trace(y.scene(), s, t, u, light, eye)) return why;
  return y.assemble(light, s, eye, t);
}

bool invert_technique(const Scene& scene, const MeasuredPath& x, int s, Rng& auxiliaries,
                      std::vector<double>& u) {
  u.clear();
  if (!invert_eye_subpath(scene, x, x.size() - s, auxiliaries, u)) return false;
  if (s > 0) return invert_light_subpath(scene, x, s, auxiliaries, u);
  if (x[0].infinite()) u.push_back(invert_infinite_emitter(scene, x[0], auxiliaries.uniform()));
  return true;
}

}  // namespace fogbow
