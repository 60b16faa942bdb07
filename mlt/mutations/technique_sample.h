// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <vector>

#include "mlt/path_sample.h"

namespace fogbow {

/// The path y of technique (s, t) from primary samples: both subpaths, joined.
std::optional<Rejection> sample_technique(int s, int t, SampleStream& u, PathSample& y);

/// Primary samples with which technique (s, k − s), which must be able to, makes x; those that are
/// free given x are drawn from their conditional law. False where rounding hides them.
bool invert_technique(const Scene& scene, const MeasuredPath& x, int s, Rng& auxiliaries,
                      std::vector<double>& u);

}  // namespace fogbow
