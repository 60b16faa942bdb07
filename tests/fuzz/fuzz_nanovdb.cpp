// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/sparse_targets.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogbow;
  testing::check_vdb_parser(parse_nanovdb, testing::text_of(data, size));
  return 0;
}
