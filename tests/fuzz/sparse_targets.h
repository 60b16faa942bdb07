// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/scene_io/volume_vdb.h"
#include "tests/fuzz/targets.h"

namespace fogbow::testing {

/// VDB files are mostly zeros, by the ten thousand: in an input a zero byte stands before the
/// number, of two bytes, of those that follow in the file. So inputs are short, and any byte of
/// them counts.
inline std::string with_zeros(std::string_view input) {
  constexpr std::size_t kMost = 1 << 21;
  std::string result;
  for (std::size_t i = 0; i < input.size() && result.size() < kMost; ++i) {
    if (input[i] != 0 || i + 2 >= input.size()) {
      result += input[i];
      continue;
    }
    const auto low = static_cast<unsigned char>(input[++i]);
    const auto high = static_cast<unsigned char>(input[++i]);
    result.append(low + 256u * high, '\0');
  }
  return result;
}

/// What volume_vdb.h promises; few voxels, for the sake of time.
inline void check_vdb_parser(decltype(parse_vdb)* parse, std::string_view input) {
  constexpr std::uint64_t kMaxValues = 1 << 20;
  const std::string file = with_zeros(input);
  read_or_refuse([&] {
    const VdbGrid grid = parse(file, "fuzz.vdb", "", kMaxValues);
    const VoxelData& v = grid.voxels;
    FOGBOW_CHECK(v.channels == 1 || v.channels == 3);
    std::size_t count = static_cast<std::size_t>(v.channels);
    for (const int n : v.size) {
      FOGBOW_CHECK(n >= 3);
      count *= static_cast<std::size_t>(n);
    }
    FOGBOW_CHECK(v.values.size() == count && count <= kMaxValues);
    for (const float x : v.values) FOGBOW_CHECK(std::isfinite(x) && x >= 0);
  });
}

}  // namespace fogbow::testing
