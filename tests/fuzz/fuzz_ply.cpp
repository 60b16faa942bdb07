// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/mesh_file.h"
#include "tests/fuzz/targets.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogbow::testing;
  read_or_refuse([&] { check_mesh(fogbow::parse_ply(text_of(data, size), "fuzz.ply")); });
  return 0;
}
