// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace fogbow {

/// A conductor by its name in scene files.
struct NamedConductor {
  const char* name;
  RGB eta, k;  ///< relative to vacuum
};

const std::vector<NamedConductor>& named_conductors();

}  // namespace fogbow
