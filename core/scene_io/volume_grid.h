// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>

#include "core/scene/volume.h"

namespace fogbow {

struct VolumeFile {
  VoxelData voxels;
  Bounds bounds;                 ///< as the file says; Mitsuba 3 ignores it unless asked
  std::size_t unread_bytes = 0;  ///< behind the last voxel
};

/// Mitsuba's .vol, version 3: float32, float16 or uint8 (0…255 for 0…1), little-endian. Throws
/// Error(Scene), with the byte, on whatever is malformed, too short, negative or not finite;
/// nothing is allocated for sizes that the bytes cannot hold. `name` is for messages.
VolumeFile parse_vol(std::string_view bytes, const std::string& name);

}  // namespace fogbow
