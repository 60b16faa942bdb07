// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/geometry/mesh_check.h"
#include "core/scene/scene.h"

namespace fogbow {

/// Whether an opaque wall keeps light from going around the end of a boundary: it stands on the
/// boundary, on both sides of it, at the border or closely before it. `accel` is that of the scene.
bool is_covered(const BorderEdge& border, const std::vector<Surface>& surfaces, const Accel& accel);

}  // namespace fogbow
