// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <string>

#include "mlt/mutations/path_mutations.h"

namespace fogbow {

/// Weights by name; a mutation that is not named is off.
using MutationWeights = std::map<std::string, double>;

/// Every mutation of paths with the weight it has unless asked otherwise.
MutationWeights default_mutation_weights();

/// "lens:2,switch:1"; a name alone has weight 1. Throws Error(Usage).
MutationWeights parse_mutation_weights(const std::string& text);

MutationTable<PathSample> make_path_mutations(const MutationWeights& weights,
                                              const TechniqueDistribution& techniques,
                                              int max_vertices);

}  // namespace fogbow
