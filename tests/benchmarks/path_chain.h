// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "mlt/bootstrap.h"
#include "mlt/chain.h"
#include "mlt/path_sample.h"
#include "mlt/pilot.h"
#include "mlt/registry.h"
#include "mlt/technique_distribution.h"

namespace fogbow {

/// A chain of all mutations of paths.
struct PathChain {
  static constexpr int kMaxDepth = 64;
  static constexpr std::uint64_t kSeed = 1;

  TechniqueDistribution techniques;
  MutationTable<PathSample> table;
  Chain<PathSample> chain;

  PathChain(const Scene& scene, const Estimator& bdpt)
      : techniques(run_pilot(bdpt, 1, kSeed, 1 << 14).techniques, kMaxDepth + 1),
        table(make_path_mutations(default_mutation_weights(), techniques, kMaxDepth + 1)),
        chain(PathSample::choose(scene, kMaxDepth + 1, Bootstrap(bdpt, kSeed, 2048).start(0, 0.5),
                                 0.5)
                  .value(),
              table) {}
};

}  // namespace fogbow
