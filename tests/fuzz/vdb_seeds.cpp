// SPDX-License-Identifier: GPL-3.0-or-later
// vdb_seeds FOLDER: writes the inputs that fuzz_vdb and fuzz_nanovdb start from, one small grid of
// each type and packing, to FOLDER/vdb and FOLDER/nanovdb.
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#include <openvdb/openvdb.h>

#include <filesystem>
#include <fstream>

namespace {

using Path = std::filesystem::path;

/// The reverse of with_zeros() in sparse_targets.h.
std::string without_zeros(const std::string& bytes) {
  std::string result;
  for (std::size_t i = 0; i < bytes.size();) {
    if (bytes[i] != 0) {
      result += bytes[i++];
      continue;
    }
    std::size_t n = 0;
    while (i < bytes.size() && bytes[i] == 0 && n < 65535) ++n, ++i;
    result += {'\0', static_cast<char>(n & 255), static_cast<char>(n >> 8)};
  }
  return result;
}

void shorten(const Path& from, const Path& to) {
  std::ifstream in(from, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::ofstream(to, std::ios::binary) << without_zeros(bytes);
  std::filesystem::remove(from);
}

template <class Grid>
void write_vdb(const Path& folder, const std::string& name, std::uint32_t compression, bool half) {
  using Value = typename Grid::ValueType;
  const auto grid = Grid::create();
  grid->setName("d");
  grid->setSaveFloatAsHalf(half);
  for (int i = 0; i < 5; ++i) grid->tree().setValue(openvdb::Coord(-i, i, 2), Value(0.25 * i));
  grid->tree().setValueOff(openvdb::Coord(-1, 2, 2), Value(0.5));
  grid->tree().addTile(1, openvdb::Coord(8, 8, 0), Value(1.0), true);
  openvdb::io::File out((folder / "seed").string());
  out.setCompression(compression);
  out.write({grid});
  out.close();
  shorten(folder / "seed", folder / ("seed-" + name));
}

template <class Build>
void write_nanovdb(const Path& folder, const std::string& name,
                   nanovdb::io::Codec codec = nanovdb::io::Codec::NONE) {
  using Value = typename nanovdb::BuildToValueMap<Build>::Type;
  nanovdb::GridBuilder<Value, Build> builder(Value(0));
  builder.setChecksum(nanovdb::ChecksumMode::Disable);
  auto voxels = builder.getAccessor();
  for (int i = 0; i < 5; ++i) voxels.setValue(nanovdb::Coord(i, i, 2), Value(0.25f * i));
  const auto handle = builder.getHandle(1.0, nanovdb::Vec3d(0), "d");
  nanovdb::io::writeGrid((folder / "seed").string(), handle, codec);
  shorten(folder / "seed", folder / ("seed-" + name));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const Path vdb = Path(argv[1]) / "vdb", nano = Path(argv[1]) / "nanovdb";
  std::filesystem::create_directories(vdb);
  std::filesystem::create_directories(nano);
  openvdb::initialize();
  write_vdb<openvdb::FloatGrid>(vdb, "plain", openvdb::io::COMPRESS_NONE, false);
  write_vdb<openvdb::FloatGrid>(vdb, "zip", openvdb::io::COMPRESS_ZIP, true);
  write_vdb<openvdb::FloatGrid>(vdb, "blosc", openvdb::io::COMPRESS_BLOSC, false);
  write_vdb<openvdb::FloatGrid>(vdb, "mask", openvdb::io::COMPRESS_ACTIVE_MASK, true);
  write_vdb<openvdb::DoubleGrid>(vdb, "double", openvdb::io::COMPRESS_ACTIVE_MASK, false);
  write_vdb<openvdb::Vec3SGrid>(vdb, "vec3s", openvdb::io::COMPRESS_ACTIVE_MASK, false);
  write_nanovdb<float>(nano, "float");
  write_nanovdb<float>(nano, "zip", nanovdb::io::Codec::ZIP);
  write_nanovdb<float>(nano, "blosc", nanovdb::io::Codec::BLOSC);
  write_nanovdb<double>(nano, "double");
  write_nanovdb<nanovdb::Vec3f>(nano, "vec3f");
  write_nanovdb<nanovdb::Fp4>(nano, "fp4");
  write_nanovdb<nanovdb::Fp8>(nano, "fp8");
  write_nanovdb<nanovdb::Fp16>(nano, "fp16");
  write_nanovdb<nanovdb::FpN>(nano, "fpn");
}
