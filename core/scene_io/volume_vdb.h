// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/math/transform.h"
#include "core/scene/volume.h"
#include "core/util/error.h"

namespace fogbow {

/// A sparse grid made dense: the box of its active voxels, and around it one layer of zeros, so
/// that interpolation falls to zero where the grid's own does.
struct VdbGrid {
  VoxelData voxels;
  std::array<std::int32_t, 3> first{};  ///< index of the first voxel of the box, without the layer
  Transform index_to_world;             ///< voxels are samples at whole indices
};

/// No grid of the file was meant, or more than one.
class GridChoiceError : public Error {
 public:
  using Error::Error;
};

constexpr std::uint64_t kMaxVdbValues = std::uint64_t{1} << 31;

// Read the grid of that name; if it is empty, the only one of one channel, else "density", else the
// only one of three. Throw Error(Scene) on whatever is malformed or no density: negative or
// non-finite values, a background that is not zero, level sets, maps that are not affine. No byte
// outside of `bytes` is read; nothing is allocated beyond a multiple of its length and
// `max_values`. `name` is for messages.

/// OpenVDB's .vdb, file versions 222 to 224: float, double, vec3s or vec3d, whole or saved as half.
VdbGrid parse_vdb(std::string_view bytes, const std::string& name, const std::string& grid,
                  std::uint64_t max_values = kMaxVdbValues);
/// NanoVDB's .nvdb, version 32: float, double, Vec3f, Vec3d, Fp4, Fp8, Fp16 or FpN.
VdbGrid parse_nanovdb(std::string_view bytes, const std::string& name, const std::string& grid,
                      std::uint64_t max_values = kMaxVdbValues);

}  // namespace fogbow
