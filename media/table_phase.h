// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <vector>

#include "core/scene/phase_function.h"

namespace fogbow {

/// Of each channel, values in any unit at rising 1 − cosθ from 0 to 2, linear in between;
/// normalized here. Throws std::domain_error unless all are finite and ≥ 0 and every channel has
/// some light.
struct PhaseTable {
  std::vector<double> one_minus_cos;
  std::vector<RGB> values;
};

std::shared_ptr<const PhaseFunction> make_table_phase(PhaseTable table);

}  // namespace fogbow
