// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/estimators/sampling.h"
#include "core/path/path.h"
#include "tests/helpers/statistics.h"

namespace fogbow::testing {

/// Calls check(path, a, b) for every chain of vertices that are in_chain() between path[a] and
/// path[b], in the eye subpath number `sample`.
template <class InChain, class Check>
void for_each_chain(const Scene& scene, std::uint64_t stream_number, int sample, InChain&& in_chain,
                    Check&& check) {
  Subpath light, eye;
  Rng rng(suite_seed(), RngDomain::Test, stream_number, sample);
  RandomStream stream(rng);
  Vec2 raster;
  trace_eye_subpath(scene, stream, 8, eye, raster);
  if (eye.empty() || eye.back().x.infinite()) return;
  const Path path = assemble(scene, light, 0, eye, static_cast<int>(eye.size()));
  const int last = static_cast<int>(path.size()) - 1;
  for (int a = 0; a < last; ++a) {
    int b = a + 1;
    while (b < last && in_chain(path[b])) ++b;
    if (b > a + 1) check(path, a, b);
    a = b - 1;
  }
}

}  // namespace fogbow::testing
