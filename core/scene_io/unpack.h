// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <string_view>

namespace fogbow {

// Unpack a whole buffer to exactly `size` bytes; false if it is broken or does not give them.

bool unpack_zlib(std::string_view packed, void* to, std::size_t size);
bool unpack_blosc(std::string_view packed, void* to, std::size_t size);

}  // namespace fogbow
