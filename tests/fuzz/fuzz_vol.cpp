// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/volume_grid.h"
#include "tests/fuzz/targets.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogbow;
  testing::read_or_refuse([&] {
    const VolumeFile file = parse_vol(testing::text_of(data, size), "fuzz.vol");
    const VoxelData& v = file.voxels;
    FOGBOW_CHECK(v.channels == 1 || v.channels == 3);
    std::size_t count = static_cast<std::size_t>(v.channels);
    for (const int n : v.size) count *= static_cast<std::size_t>(n);
    FOGBOW_CHECK(v.values.size() == count);
    for (const float x : v.values) FOGBOW_CHECK(std::isfinite(x) && x >= 0);
  });
  return 0;
}
