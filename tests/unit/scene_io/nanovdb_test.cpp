// SPDX-License-Identifier: GPL-3.0-or-later
// Files written by NanoVDB, read by us, against NanoVDB's own sampler.
#include <nanovdb/util/GridBuilder.h>
#include <nanovdb/util/IO.h>
#include <nanovdb/util/SampleFromVoxels.h>

#include "core/scene_io/volume_vdb.h"
#include "tests/unit/scene_io/vdb_scene.h"

namespace fogbow {
namespace {

using nanovdb::Coord;
using nanovdb::io::Codec;
using testing::make_value;
using testing::to_rgb;
using Handle = nanovdb::GridHandle<>;

/// Rows are those of the matrix that takes columns.
const double kLinear[3][3] = {{0.5, 0.125, 0}, {-0.25, 0.75, 0.1}, {0, 0.2, 1.5}};
const Vec3 kOrigin(3, -2, 0.5);

Transform oblique() {
  Mat4 m(1.0);
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) m[c][r] = kLinear[r][c];
  m[3] = Vec4(kOrigin, 1);
  return Transform(m);
}

nanovdb::Map oblique_map() {
  const Transform t = oblique();
  // Map::set takes rows for columns.
  double matrix[3][3], inverse[3][3];
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      matrix[c][r] = t.matrix()[c][r];
      inverse[c][r] = t.inverse_matrix()[c][r];
    }
  nanovdb::Map map;
  map.set(matrix, inverse, kOrigin, 1.0);
  return map;
}

/// Scattered voxels on both sides of the origin, and a cube of one value, which becomes a tile.
template <class Build>
Handle random_grid(const std::string& name) {
  using Value = typename nanovdb::BuildToValueMap<Build>::Type;
  // NanoVDB wants fog to be of one channel.
  constexpr auto kClass =
      std::is_floating_point_v<Value> ? nanovdb::GridClass::FogVolume : nanovdb::GridClass::Unknown;
  nanovdb::GridBuilder<Value, Build> builder(Value(0), kClass);
  Rng rng(testing::suite_seed(), RngDomain::Test, 920, 0);
  std::vector<double> values(80 * 40 * 40);
  for (double& v : values) v = rng.uniform() < 0.4 ? 2 * rng.uniform() : 0.0;
  builder(
      [&](const Coord& c) {
        if (c[0] >= 16 && c[1] >= 8 && c[1] < 16 && c[2] >= 8) return make_value<Value>(0.75);
        const double v = values[((c[0] + 40) * 40 + c[1] + 16) * 40 + c[2] + 20];
        return v == 0 ? Value(0) : make_value<Value>(v);
      },
      nanovdb::CoordBBox(Coord(-39, -15, -17), Coord(38, 19, 18)));
  return builder.getHandle(oblique_map(), name);
}

class NanoFile : public testing::VdbScene {
 protected:
  void write(const std::string& name, const std::vector<Handle>& handles, Codec codec) {
    nanovdb::io::writeGrids(file(name), handles, codec);
  }
  template <class Build>
  void expect_agreement(const std::string& name) {
    SCOPED_TRACE(name);
    for (const Codec codec : {Codec::NONE, Codec::ZIP, Codec::BLOSC}) {
      std::vector<Handle> handles;
      handles.push_back(random_grid<Build>("density"));
      write("g.nvdb", handles, codec);
      const auto& truth = *handles[0].grid<Build>();
      const auto accessor = truth.getAccessor();
      const auto sampler = nanovdb::createSampler<1>(accessor);
      const auto medium = load("g.nvdb");
      const int positive =
          compare(*medium, oblique(), Vec3(-39, -15, -17), Vec3(38, 19, 18), 2,
                  [&](const Vec3& i) { return to_rgb(sampler(nanovdb::Vec3d(i.x, i.y, i.z))); });
      EXPECT_GT(positive, 1000);
      EXPECT_LT(positive, 3900);
      EXPECT_TRUE(folder_.warnings.empty());
    }
  }
  std::string bytes_of(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(NanoFile, HasTheValuesOfNanoVdb) {
  expect_agreement<float>("float");
  expect_agreement<double>("double");
  expect_agreement<nanovdb::Vec3f>("Vec3f");
  expect_agreement<nanovdb::Vec3d>("Vec3d");
  expect_agreement<nanovdb::Fp4>("Fp4");
  expect_agreement<nanovdb::Fp8>("Fp8");
  expect_agreement<nanovdb::Fp16>("Fp16");
  expect_agreement<nanovdb::FpN>("FpN");
}

/// Nothing but one tile.
TEST_F(NanoFile, ATileAloneIsThere) {
  nanovdb::GridBuilder<float> builder(0, nanovdb::GridClass::FogVolume);
  builder([](const Coord&) { return 0.75f; },
          nanovdb::CoordBBox(Coord(8, 0, -8), Coord(15, 7, -1)));
  std::vector<Handle> handles;
  handles.push_back(builder.getHandle(1.0, nanovdb::Vec3d(0), "density"));
  write("g.nvdb", handles, Codec::NONE);
  const auto medium = load("g.nvdb");
  for (const Vec3& p : {Vec3(8, 0, -8), Vec3(15, 7, -1), Vec3(11.3, 4.2, -5.5)})
    EXPECT_EQ(medium->sigma_t(p), RGB(0.75));
  EXPECT_EQ(medium->sigma_t(Vec3(16.1, 4, -4)), RGB(0));
  EXPECT_EQ(medium->sigma_t(Vec3(11, 4, 0.1)), RGB(0));
}

/// The map of the file is the one that NanoVDB applies.
TEST_F(NanoFile, LiesWhereItsMapSays) {
  const Handle handle = random_grid<float>("density");
  const auto& grid = *handle.grid<float>();
  for (const Vec3& i : {Vec3(0), Vec3(1, 2, 3), Vec3(-7, 0.5, 11)}) {
    const nanovdb::Vec3d p = grid.indexToWorld(nanovdb::Vec3d(i.x, i.y, i.z));
    EXPECT_LT(length(oblique().point(i) - Vec3(p[0], p[1], p[2])), 1e-12);
  }
}

TEST_F(NanoFile, ChoosesAGrid) {
  std::vector<Handle> handles;
  const auto add = [&](const char* name, float value) {
    nanovdb::GridBuilder<float> builder(0);
    builder.getAccessor().setValue(Coord(0, 0, 0), value);
    handles.push_back(builder.getHandle(1.0, nanovdb::Vec3d(0), name));
  };
  add("heat", 1);
  add("density", 2);
  nanovdb::GridBuilder<int> ids(0);
  ids.getAccessor().setValue(Coord(0, 0, 0), 7);
  handles.push_back(ids.getHandle(1.0, nanovdb::Vec3d(0), "ids"));
  for (const Codec codec : {Codec::NONE, Codec::ZIP}) {
    write("g.nvdb", handles, codec);
    EXPECT_EQ(load("g.nvdb")->sigma_t(Vec3(0)), RGB(2));
    EXPECT_EQ(load("g.nvdb", grid("heat"))->sigma_t(Vec3(0)), RGB(1));
  }
  expect_error("g.nvdb", "is of type \"int32\"", grid("ids"), 4);
  expect_error("g.nvdb",
               "there is no grid \"x\"; it holds \"heat\" (\"float\"), \"density\" "
               "(\"float\"), \"ids\" (\"int32\")",
               grid("x"), 4);
  // Parts of a file follow each other.
  std::vector<Handle> first, second;
  first.push_back(std::move(handles[0]));
  second.push_back(std::move(handles[1]));
  write("a.nvdb", first, Codec::NONE);
  write("b.nvdb", second, Codec::BLOSC);
  folder_.write("g.nvdb", bytes_of("a.nvdb") + bytes_of("b.nvdb"));
  EXPECT_EQ(load("g.nvdb", grid("heat"))->sigma_t(Vec3(0)), RGB(1));
  EXPECT_EQ(load("g.nvdb", grid("density"))->sigma_t(Vec3(0)), RGB(2));
}

TEST_F(NanoFile, RefusesWhatIsNoDensity) {
  const auto expect = [&](float value, float background, nanovdb::GridClass grid_class,
                          const std::string& message) {
    nanovdb::GridBuilder<float> builder(background, grid_class);
    builder.getAccessor().setValue(Coord(-1, 2, 3), value);
    std::vector<Handle> handles;
    handles.push_back(builder.getHandle(1.0, nanovdb::Vec3d(0), "g"));
    write("g.nvdb", handles, Codec::NONE);
    expect_error("g.nvdb", message);
  };
  using enum nanovdb::GridClass;
  expect(-0.5f, 0, FogVolume, "voxel (-1, 2, 3) of the grid \"g\" is negative: -0.5");
  expect(NAN, 0, Unknown, "is not finite");
  expect(1, 3, LevelSet, "\"g\" is a level set");
  expect(1, 0.25f, FogVolume, "(class \"fog volume\") has the background 0.25");
  expect(1, 0, VoxelVolume, "is of the class \"voxel volume\"");
  folder_.write("g.nvdb", "no volume at all");
  expect_error("g.nvdb", "expected a NanoVDB file");
}

TEST_F(NanoFile, OtherVersionsAreRefused) {
  std::vector<Handle> handles;
  handles.push_back(random_grid<float>("density"));
  write("g.nvdb", handles, Codec::NONE);
  std::string bytes = bytes_of("g.nvdb");
  const std::uint32_t version = 29u << 21;
  std::memcpy(&bytes[8], &version, sizeof version);
  folder_.write("g.nvdb", bytes);
  expect_error("g.nvdb", "expected version 32 of NanoVDB, found 29");
}

/// Whatever an offset or count says, nothing is read outside, and no walk goes on for ever.
TEST_F(NanoFile, DamagedFilesAreErrors) {
  nanovdb::GridBuilder<float, nanovdb::FpN> builder(0, nanovdb::GridClass::FogVolume);
  auto voxels = builder.getAccessor();
  for (int i = 0; i < 40; ++i) voxels.setValue(Coord(i - 20, 3 * i, -i), 0.01f * i);
  std::vector<Handle> handles;
  handles.push_back(builder.getHandle(1.0, nanovdb::Vec3d(0), "g"));
  write("g.nvdb", handles, Codec::NONE);
  std::string bytes = bytes_of("g.nvdb");
  parse_nanovdb(bytes, "x.nvdb", "");
  for (std::size_t n = 0; n < bytes.size(); n += n < 1200 ? 7 : 9973)
    EXPECT_THROW(parse_nanovdb(std::string_view(bytes).substr(0, n), "x.nvdb", ""), Error) << n;
  // The heads, and whatever is not zero in the first nodes with children.
  const std::size_t start = bytes.size() - handles[0].size();
  const auto* tree = reinterpret_cast<const nanovdb::TreeData<3>*>(handles[0].data() + 672);
  std::vector<std::size_t> places;
  for (std::size_t at = 0; at < 1100; at += 4) places.push_back(at);
  for (const int level : {0, 1, 2})
    for (std::size_t at = start + 672 + tree->mNodeOffset[level], n = 0; n < 40; at += 8)
      if (at + 8 > bytes.size() || bytes.substr(at, 8) != std::string(8, '\0')) {
        if (at + 8 > bytes.size()) break;
        places.push_back(at);
        ++n;
      }
  int refused = 0;
  for (const std::size_t at : places)
    for (const std::int64_t word : {std::int64_t{32}, std::int64_t{1} << 40, std::int64_t{-64}}) {
      const std::string before = bytes.substr(at, sizeof word);
      std::memcpy(bytes.data() + at, &word, sizeof word);
      try {
        parse_nanovdb(bytes, "x.nvdb", "", 1 << 22);
      } catch (const Error& error) {
        EXPECT_EQ(error.where().file, "x.nvdb");
        ++refused;
      }
      bytes.replace(at, before.size(), before);
    }
  EXPECT_GT(refused, 200);
}

}  // namespace
}  // namespace fogbow
