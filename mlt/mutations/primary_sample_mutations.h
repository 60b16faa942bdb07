// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "mlt/chain.h"
#include "mlt/primary_sample.h"

namespace fogbow {

/// The two mutations of Kelemen et al. over an estimator's primary samples: independent large steps
/// with probability `large_step_probability`, and small steps.
MutationTable<PrimarySample> make_primary_sample_mutations(const Estimator& estimator,
                                                           double large_step_probability);

}  // namespace fogbow
