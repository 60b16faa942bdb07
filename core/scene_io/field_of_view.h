// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/scene/properties.h"

namespace fogbow {

/// Horizontal, in degrees, from "fov" and "fov_axis" or from "focal_length"; `aspect` is width over
/// height.
double field_of_view(Properties& p, double aspect);

}  // namespace fogbow
