// SPDX-License-Identifier: GPL-3.0-or-later
#include <zlib.h>

#include <cstring>

#include "core/scene_io/mesh_file.h"
#include "tests/fuzz/targets.h"

namespace {

/// A file of one mesh, of this version, that unpacks to `content`: random bytes hardly ever unpack
/// to anything.
std::string packed(std::string_view content, std::uint16_t version) {
  std::string file(4, '\0');
  const std::uint16_t magic = 0x041C;
  std::memcpy(file.data(), &magic, 2);
  std::memcpy(file.data() + 2, &version, 2);
  uLongf length = compressBound(content.size());
  std::string body(length, '\0');
  FOGBOW_CHECK(compress(reinterpret_cast<Bytef*>(body.data()), &length,
                        reinterpret_cast<const Bytef*>(content.data()), content.size()) == Z_OK);
  file.append(body, 0, length);
  file.append(version >= 4 ? 8 : 4, '\0');  // its offset
  const std::uint32_t count = 1;
  return file.append(reinterpret_cast<const char*>(&count), 4);
}

}  // namespace

/// The first byte says whether the rest is a file (even) or what a mesh unpacks to.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fogbow;
  if (size == 0) return 0;
  const std::string_view rest = testing::text_of(data + 1, size - 1);
  const bool pack = data[0] & 1;
  const std::string file = pack ? packed(rest, data[0] & 2 ? 3 : 4) : std::string(rest);
  testing::read_or_refuse(
      [&] { testing::check_mesh(parse_serialized(file, "fuzz.serialized", data[0] >> 4).mesh); });
  return 0;
}
