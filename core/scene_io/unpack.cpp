// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/unpack.h"

#include <blosc.h>
#include <zlib.h>

#include <climits>
#include <new>

namespace fogbow {

bool unpack_zlib(std::string_view packed, void* to, std::size_t size) {
  uLongf length = size;
  const int status = uncompress(static_cast<Bytef*>(to), &length,
                                reinterpret_cast<const Bytef*>(packed.data()), packed.size());
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  return status == Z_OK && length == size;
}

bool unpack_blosc(std::string_view packed, void* to, std::size_t size) {
  std::size_t length = 0;
  if (size > INT_MAX || packed.size() < BLOSC_MIN_HEADER_LENGTH) return false;
  if (blosc_cbuffer_validate(packed.data(), packed.size(), &length) != 0 || length != size)
    return false;
  // Threads of its own would only wait for each other.
  return blosc_decompress_ctx(packed.data(), to, size, 1) == static_cast<int>(size);
}

}  // namespace fogbow
