// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <vector>

#include "core/path/measured_path.h"
#include "core/util/rng.h"

namespace fogbow {

// Primary samples with which trace_light_subpath() and trace_eye_subpath() would have made a part
// of x, in the order in which they ask for them. Where many samples make the same vertices (lobes,
// walls, roulette, the choice of an emitter) they are drawn from their conditional law. Both append
// to `u`; false where the density is zero.

/// The first s vertices.
bool invert_light_subpath(const Scene& scene, const MeasuredPath& x, int s, Rng& auxiliaries,
                          std::vector<double>& u);
/// The last t vertices.
bool invert_eye_subpath(const Scene& scene, const MeasuredPath& x, int t, Rng& auxiliaries,
                        std::vector<double>& u);

}  // namespace fogbow
