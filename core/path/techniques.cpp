// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/techniques.h"

#include <algorithm>

namespace fogbow {

bool joinable(const Scene& scene, const MeasuredPath& path, int split) {
  if (split >= path.size()) return false;  // nothing runs into the sensor
  if (split == 0) return hittable(scene, path[0]);
  if (path[split - 1].degenerate || path[split].degenerate) return false;
  if (!has_ray(path[split - 1], path[split])) return false;
  return path.size() > 2 || !is_unseen(scene, path[0]);
}

void choose_infinite_emitter(const Scene& scene, Vertex& x, SampleStream& u) {
  if (!x.infinite()) return;
  const auto& all = scene.infinite_emitters();
  x.emitter = all[static_cast<std::size_t>(u.next() * static_cast<double>(all.size()))];
}

double invert_infinite_emitter(const Scene& scene, const Vertex& x, double auxiliary) {
  const auto& all = scene.infinite_emitters();
  const auto index = static_cast<double>(std::ranges::find(all, x.emitter) - all.begin());
  return std::min((index + auxiliary) / static_cast<double>(all.size()), kOneMinusEpsilon);
}

namespace {

/// Calls visit(l, weights[l] p_l) where that is not zero.
template <class Visit>
void for_each_split(const Scene& scene, const MeasuredPath& path, Range range,
                    std::span<const double> weights, Visit&& visit) {
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
  for (int l = 0; l <= range.size(); ++l) {
    if (l > 0) from_light *= path.pdf_from_light(scene, range.first + l - 1);
    if (!(weights[l] > 0) || !joinable(scene, path, range.first + l)) continue;
    const bool choice = range.first + l == 0 && path[0].infinite();
    const double chosen = choice ? 1 / static_cast<double>(scene.infinite_emitters().size()) : 1.0;
    ScaledProduct<double> density = from_light * from_eye[l];
    density *= weights[l] * chosen;
    if (density.mantissa() > 0) visit(l, density);
  }
}

}  // namespace

double log_range_density(const Scene& scene, const MeasuredPath& path, Range range,
                         std::span<const double> weights) {
  ScaledSum sum;
  for_each_split(scene, path, range, weights,
                 [&](int, const ScaledProduct<double>& density) { sum.add(density); });
  return sum.log();
}

SplitChoice choose_split(const Scene& scene, const MeasuredPath& path, Range range,
                         std::span<const double> weights, double u) {
  SplitChoice choice{-1, 0};
  ScaledSum sum;
  for_each_split(scene, path, range, weights, [&](int l, const ScaledProduct<double>& density) {
    sum.add(density);
    // Each takes the place of what was chosen before with its part of the sum so far.
    const double part = std::exp(log(density) - sum.log());
    if (u < part) {
      choice.l = l;
      u /= part;
    } else {
      u = (u - part) / (1 - part);
    }
  });
  FOGBOW_CHECK(choice.l >= 0);
  choice.log_density = sum.log();
  return choice;
}

}  // namespace fogbow
