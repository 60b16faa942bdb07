// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/util/rng.h"

#include <Random123/philox.h>

namespace fogbow {

Rng::Rng(std::uint64_t seed, RngDomain domain, std::uint64_t stream, std::uint64_t step) {
  using Philox = r123::Philox4x64;
  const auto block = Philox()(Philox::ctr_type{{stream, step, 0, 0}},
                              Philox::key_type{{seed, static_cast<std::uint64_t>(domain)}});
  for (int i = 0; i < 4; ++i) s_[i] = block[i];
}

}  // namespace fogbow
