// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/techniques.h"

namespace fogbow {

bool joinable(const Scene& scene, const MeasuredPath& path, int split) {
  if (split >= path.size()) return false;  // nothing runs into the sensor
  if (split == 0) return hittable(scene, path[0]);
  if (path[split - 1].degenerate || path[split].degenerate) return false;
  return path.size() > 2 || !is_unseen(scene, path[0]);
}

void choose_infinite_emitter(const Scene& scene, Vertex& x, Rng& rng) {
  if (!x.infinite()) return;
  const auto& all = scene.infinite_emitters();
  x.emitter = all[static_cast<std::size_t>(rng.uniform() * static_cast<double>(all.size()))];
}

double log_range_density(const Scene& scene, const MeasuredPath& path, Range range,
                         std::span<const double> weights) {
  FOGBOW_CHECK(weights.size() == static_cast<std::size_t>(range.size()) + 1);
  // p_l = from_light(first … first + l) · from_eye(first + l … end), the second factor by suffixes.
  thread_local std::vector<ScaledProduct<double>> from_eye;
  from_eye.reserve(path.capacity() + 1);
  from_eye.assign(range.size() + 1, ScaledProduct<double>());
  for (int l = range.size() - 1; l >= 0; --l) {
    from_eye[l] = from_eye[l + 1];
    from_eye[l] *= path.pdf_from_eye(scene, range.first + l);
  }
  ScaledProduct<double> from_light;
  ScaledSum sum;
  for (int l = 0; l <= range.size(); ++l) {
    if (l > 0) from_light *= path.pdf_from_light(scene, range.first + l - 1);
    if (!(weights[l] > 0) || !joinable(scene, path, range.first + l)) continue;
    const bool choice = range.first + l == 0 && path[0].infinite();
    const double chosen = choice ? 1 / static_cast<double>(scene.infinite_emitters().size()) : 1.0;
    sum.add(from_light * from_eye[l], weights[l] * chosen);
  }
  return sum.log();
}

}  // namespace fogbow
