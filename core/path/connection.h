// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/path/subpath.h"

namespace fogbow {

/// The unweighted contribution f/p_s of one technique to the whole path, with its weight.
struct Connection {
  RGB value{0};
  double weight = 0;  ///< balance heuristic, p_s/Σp
  Vec2 raster{0};     ///< only set where t = 1
};

/// Joins light[0..s) and eye[0..t), s ≥ 1 and t ≥ 1; nothing where the two do not see each other or
/// scatter no light across.
std::optional<Connection> join(const Scene& scene, const Subpath& light, int s, const Subpath& eye,
                               int t);

/// The eye subpath's last of t vertices as x₁ (s = 0).
std::optional<Connection> run_into_light(const Scene& scene, const Subpath& eye, int t);

}  // namespace fogbow
