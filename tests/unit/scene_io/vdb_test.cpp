// SPDX-License-Identifier: GPL-3.0-or-later
// Files written by OpenVDB, read by us, against what OpenVDB itself reads and interpolates.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include "core/scene_io/volume_vdb.h"
#include "tests/unit/scene_io/vdb_scene.h"

namespace fogbow {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using testing::make_value;
using testing::to_rgb;

constexpr std::uint32_t kPlain = openvdb::io::COMPRESS_NONE, kZip = openvdb::io::COMPRESS_ZIP,
                        kMask = openvdb::io::COMPRESS_ACTIVE_MASK,
                        kBlosc = openvdb::io::COMPRESS_BLOSC;

/// Single voxels and leaves full of them on both sides of the origin (where four nodes of the
/// highest level meet), a large cube of one value, and holes.
template <class Grid>
typename Grid::Ptr random_grid(const std::string& name = "density") {
  using Value = typename Grid::ValueType;
  const auto grid = Grid::create(make_value<Value>(0) * 0.0);
  grid->setName(name);
  auto voxels = grid->getAccessor();
  Rng rng(testing::suite_seed(), RngDomain::Test, 911, 0);
  grid->sparseFill(CoordBBox(Coord(16, 0, -16), Coord(31, 15, -1)), make_value<Value>(0.75), true);
  grid->sparseFill(CoordBBox(Coord(-32, 8, 8), Coord(-25, 15, 15)), make_value<Value>(1.25), false);
  for (int i = 0; i < 3000; ++i) {
    const Vec3 p = Vec3(-37, -11, -19) + uniform3(rng) * Vec3(80, 30, 40);
    voxels.setValue(Coord(int(p.x), int(p.y), int(p.z)), make_value<Value>(2 * rng.uniform()));
  }
  for (auto it = CoordBBox(Coord(-8, -8, -8), Coord(-1, -1, -1)).begin(); it; ++it)
    voxels.setValue(*it, make_value<Value>(2 * rng.uniform()));
  // Inactive values in several leaves: one, two, and many.
  for (int i = 0; i < 40; ++i) {
    voxels.setValueOff(Coord(0, 0, i % 8), make_value<Value>(0.5));
    voxels.setValueOff(Coord(8, 0, i % 8), make_value<Value>(i % 2 ? 0.5 : 1.5));
    voxels.setValueOff(Coord(0, 8, i % 8), make_value<Value>(0.01 * i));
  }
  for (int i = 0; i < 200; ++i)  // holes
    voxels.setValueOff(Coord(17 + i % 7, 3, -15 + i % 11), make_value<Value>(0) * 0.0);
  return grid;
}

openvdb::math::Transform::Ptr oblique() {
  const auto t = openvdb::math::Transform::createLinearTransform(0.1);
  t->preScale(openvdb::Vec3d(1, 2.5, 0.75));
  t->preRotate(0.7, openvdb::math::X_AXIS);
  t->postRotate(-0.4, openvdb::math::Z_AXIS);
  t->postTranslate(openvdb::Vec3d(3, -2, 0.5));
  return t;
}

Vec3 to_vec3(const Coord& c) { return {c.x(), c.y(), c.z()}; }

class VdbFile : public testing::VdbScene {
 protected:
  VdbFile() { openvdb::initialize(); }

  void write(const std::string& name, const openvdb::GridPtrVec& grids, std::uint32_t compression) {
    openvdb::io::File out(file(name));
    out.setCompression(compression);
    out.write(grids);
  }

  /// Our medium against OpenVDB's sampler of what OpenVDB reads from the same file.
  template <class Grid>
  void expect_agreement(const std::string& name, const std::string& grid_name = "density") {
    openvdb::io::File in(file(name));
    in.open(false);
    const auto truth = openvdb::gridPtrCast<Grid>(in.readGrid(grid_name));
    Mat4 m(1.0);
    const openvdb::Vec3d origin = truth->indexToWorld(openvdb::Vec3d(0, 0, 0));
    for (int i = 0; i < 3; ++i) {
      openvdb::Vec3d step(0, 0, 0);
      step[i] = 1;
      step = truth->indexToWorld(step) - origin;
      m[i] = Vec4(step[0], step[1], step[2], 0);
    }
    m[3] = Vec4(origin[0], origin[1], origin[2], 1);
    const CoordBBox box = truth->evalActiveVoxelBoundingBox();
    const openvdb::tools::GridSampler<Grid, openvdb::tools::BoxSampler> sampler(*truth);
    const Transform map(m);
    const auto medium = load(name, testing::VdbScene::grid(grid_name));
    const int positive =
        compare(*medium, map, to_vec3(box.min()), to_vec3(box.max()), 2, [&](const Vec3& i) {
          const Vec3 p = map.point(i);
          return to_rgb(sampler.wsSample(openvdb::Vec3d(p.x, p.y, p.z)));
        });
    EXPECT_GT(positive, 400);
    EXPECT_LT(positive, 3600);
    EXPECT_TRUE(folder_.warnings.empty());
  }

  template <class Grid>
  void check_all_compressions(bool half, openvdb::GridClass grid_class) {
    for (const std::uint32_t compression :
         {kPlain, kZip, kMask, kBlosc, kZip | kMask, kBlosc | kMask}) {
      SCOPED_TRACE("compression " + std::to_string(compression));
      const auto grid = random_grid<Grid>();
      grid->setTransform(oblique());
      grid->setSaveFloatAsHalf(half);
      grid->setGridClass(grid_class);
      write("g.vdb", {grid}, compression);
      expect_agreement<Grid>("g.vdb");
    }
  }
};

TEST_F(VdbFile, HasTheValuesOfOpenVdb) {
  for (const bool half : {false, true})
    for (const auto c : {openvdb::GRID_UNKNOWN, openvdb::GRID_FOG_VOLUME}) {
      SCOPED_TRACE(half ? "half" : "whole");
      check_all_compressions<openvdb::FloatGrid>(half, c);
      check_all_compressions<openvdb::DoubleGrid>(half, c);
      check_all_compressions<openvdb::Vec3SGrid>(half, c);
      check_all_compressions<openvdb::Vec3DGrid>(half, c);
    }
}

TEST_F(VdbFile, LiesWhereItsMapSays) {
  using namespace openvdb::math;
  const openvdb::Vec3d t(1, -2, 3), s(0.5, 0.25, 2);
  const double kRows[] = {1, 0.5, 0, 0, 0, 2, 0.25, 0, 0.3, 0, 1.5, 0, 4, 5, 6, 1};
  const MapBase::Ptr maps[] = {MapBase::Ptr(new UniformScaleMap(0.3)),
                               MapBase::Ptr(new ScaleMap(s)),
                               MapBase::Ptr(new TranslationMap(t)),
                               MapBase::Ptr(new UniformScaleTranslateMap(0.3, t)),
                               MapBase::Ptr(new ScaleTranslateMap(s, t)),
                               MapBase::Ptr(new UnitaryMap(openvdb::Vec3d(1, 1, 0).unit(), 0.8)),
                               MapBase::Ptr(new AffineMap(Mat4d(kRows)))};
  for (const auto& map : maps) {
    SCOPED_TRACE(map->type());
    const auto grid = random_grid<openvdb::FloatGrid>();
    grid->setTransform(openvdb::math::Transform::Ptr(new openvdb::math::Transform(map)));
    write("g.vdb", {grid}, kMask);
    expect_agreement<openvdb::FloatGrid>("g.vdb");
  }
}

TEST_F(VdbFile, ToWorldFollowsItsMap) {
  const auto grid = random_grid<openvdb::FloatGrid>();
  grid->setTransform(oblique());
  write("g.vdb", {grid}, kMask);
  const auto plain = load("g.vdb");
  const auto moved = load("g.vdb", R"(<transform name="to_world"><scale value="2"/>
      <translate x="1"/></transform>)");
  Rng rng(testing::suite_seed(), RngDomain::Test, 912, 0);
  const Bounds box = plain->support();
  int positive = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = box.lo + uniform3(rng) * box.diagonal();
    EXPECT_NEAR(moved->sigma_t(2.0 * p + Vec3(1, 0, 0)).x, plain->sigma_t(p).x, 1e-9);
    positive += plain->sigma_t(p).x > 0;
  }
  EXPECT_GT(positive, 50);
}

/// Without the file's own place, the active voxels fill the unit cube.
TEST_F(VdbFile, OrFillsTheUnitCube) {
  const auto grid = openvdb::FloatGrid::create(0.0f);
  grid->setTransform(oblique());
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 2; ++y)
      grid->tree().setValue(Coord(5 + x, 9 + y, -7), float(1 + x + 10 * y));
  write("g.vdb", {grid}, kPlain);
  const auto m = load("g.vdb", R"(<boolean name="use_grid_bbox" value="false"/>)");
  EXPECT_NEAR(m->sigma_t(Vec3(0.125, 0.25, 0.5)).x, 1, 1e-6);
  EXPECT_NEAR(m->sigma_t(Vec3(0.875, 0.75, 0.5)).x, 14, 1e-6);
  EXPECT_NEAR(m->sigma_t(Vec3(0.5, 0.5, 0.5)).x, 7.5, 1e-6);
  EXPECT_NEAR(m->sigma_t(Vec3(0, 0.25, 0.5)).x, 0.5, 1e-6);
  EXPECT_EQ(m->sigma_t(Vec3(0.5, 0.5, 1.6)).x, 0);
  const auto nearest = load("g.vdb", R"(<boolean name="use_grid_bbox" value="false"/>
      <string name="filter_type" value="nearest"/>)");
  EXPECT_EQ(nearest->sigma_t(Vec3(0.01, 0.01, 0.01)).x, 1);
  EXPECT_EQ(nearest->sigma_t(Vec3(0.99, 0.99, 0.99)).x, 14);
  EXPECT_EQ(nearest->sigma_t(Vec3(-0.01, 0.5, 0.5)).x, 0);
}

TEST_F(VdbFile, ChoosesAGrid) {
  const auto a = openvdb::FloatGrid::create(), b = openvdb::FloatGrid::create();
  a->tree().setValue(Coord(0, 0, 0), 1.0f);
  b->tree().setValue(Coord(0, 0, 0), 2.0f);
  a->setName("heat");
  b->setName("density");
  const auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("v");
  velocity->tree().setValue(Coord(0, 0, 0), openvdb::Vec3s(3, 4, 5));
  const auto ids = openvdb::Int32Grid::create();
  ids->setName("ids");
  const auto at_origin = [&](const std::string& more) {
    return load("g.vdb", more)->sigma_t(Vec3(0));
  };
  write("g.vdb", {ids, a, b, velocity}, kBlosc);
  EXPECT_EQ(at_origin(""), RGB(2));
  EXPECT_EQ(at_origin(grid("heat")), RGB(1));
  EXPECT_EQ(at_origin(grid("v")), RGB(3, 4, 5));
  expect_error("g.vdb",
               "there is no grid \"smoke\"; it holds \"ids\" (\"int32\"), \"heat\" "
               "(\"float\"), \"density\" (\"float\"), \"v\" (\"vec3s\")",
               grid("smoke"), 4);
  expect_error("g.vdb", "the grid \"ids\" is of type \"int32\"", grid("ids"), 4);
  expect_error("g.vdb", "must not be empty", grid(""), 4);
  write("g.vdb", {velocity, a}, kBlosc);
  EXPECT_EQ(at_origin(""), RGB(1));
  write("g.vdb", {velocity, ids}, kBlosc);
  EXPECT_EQ(at_origin(""), RGB(3, 4, 5));
  b->setName("cold");
  write("g.vdb", {a, b}, kBlosc);
  expect_error("g.vdb",
               "\"grid\" must say which grid is meant; it holds \"heat\" (\"float\"), "
               "\"cold\" (\"float\")");
  b->setName("heat");
  write("g.vdb", {a, b}, kBlosc);
  EXPECT_EQ(at_origin(grid("heat")), RGB(1));
  EXPECT_EQ(at_origin(grid("heat[1]")), RGB(2));
  write("g.vdb", {ids}, kBlosc);
  expect_error("g.vdb", "there is no grid of real numbers; it holds \"ids\" (\"int32\")");
  write("g.vdb", {}, kBlosc);
  expect_error("g.vdb", "it holds no grid");
}

/// Grids that share a tree are written once, each with its own map.
TEST_F(VdbFile, InstancesShareATree) {
  const auto a = random_grid<openvdb::FloatGrid>("a");
  const openvdb::GridBase::Ptr b = a->copyGrid();
  b->setName("b");
  b->setTransform(oblique());
  a->setSaveFloatAsHalf(true);
  b->setSaveFloatAsHalf(true);
  write("g.vdb", {a, b}, kBlosc | kMask);
  expect_agreement<openvdb::FloatGrid>("g.vdb", "a");
  expect_agreement<openvdb::FloatGrid>("g.vdb", "b");
}

/// What an instance is, it says itself: distances and densities may share their numbers.
TEST_F(VdbFile, InstancesAreOfTheirOwnClass) {
  const auto a = random_grid<openvdb::FloatGrid>("a");
  const openvdb::GridBase::Ptr b = a->copyGrid();
  b->setName("b");
  for (const bool first : {true, false}) {
    a->setGridClass(first ? openvdb::GRID_LEVEL_SET : openvdb::GRID_FOG_VOLUME);
    b->setGridClass(first ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_LEVEL_SET);
    write("g.vdb", {a, b}, kBlosc);
    expect_error("g.vdb", "is a level set", grid(first ? "a" : "b"));
    EXPECT_NO_THROW(load("g.vdb", grid(first ? "b" : "a")));
  }
}

TEST_F(VdbFile, AnEmptyGridIsEmpty) {
  const auto empty = openvdb::FloatGrid::create();
  empty->setName("density");
  write("g.vdb", {empty}, kMask);
  EXPECT_EQ(load("g.vdb")->sigma_t(Vec3(0)), RGB(0));
  EXPECT_TRUE(folder_.warnings.empty());
}

/// The same voxels as a .vol: one more layer of zeros, and the place spelled out.
TEST_F(VdbFile, OpticalDepthsAreThoseOfAVol) {
  const int n[3] = {9, 12, 7};
  const auto grid = openvdb::FloatGrid::create();
  std::string vol = "VOL\3";
  const auto append = [&](auto v) { vol.append(reinterpret_cast<const char*>(&v), sizeof v); };
  for (const std::int32_t word : {1, n[0] + 2, n[1] + 2, n[2] + 2, 1}) append(word);
  for (int i = 0; i < 6; ++i) append(0.0f);
  Rng rng(testing::suite_seed(), RngDomain::Test, 913, 0);
  for (int z = -1; z <= n[2]; ++z)
    for (int y = -1; y <= n[1]; ++y)
      for (int x = -1; x <= n[0]; ++x) {
        const bool border = x < 0 || y < 0 || z < 0 || x == n[0] || y == n[1] || z == n[2];
        const float v = border ? 0.0f : static_cast<float>(rng.uniform());
        append(v);
        if (!border) grid->tree().setValue(Coord(x, y, z), v);
      }
  grid->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  write("g.vdb", {grid}, kBlosc);
  folder_.write("g.vol", vol);
  const auto sparse = load("g.vdb");
  const auto dense = load("g.vol", R"(<transform name="to_world"><scale x="11" y="14" z="9"/>
      <translate x="-1.5" y="-1.5" z="-1.5"/><scale value="0.5"/></transform>)");
  double sum = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 from = Vec3(-1) + uniform3(rng) * Vec3(7), to = Vec3(-1) + uniform3(rng) * Vec3(7);
    const double length = glm::length(to - from);
    const Ray ray{from, (to - from) / length};
    const double expected = dense->optical_depth(ray, 0, length).x;
    EXPECT_NEAR(sparse->optical_depth(ray, 0, length).x, expected, 1e-9);
    sum += expected;
  }
  EXPECT_GT(sum, 50);
}

/// One voxel changed in the bytes of the file: each that OpenVDB writes has a name of its own in
/// it.
TEST_F(VdbFile, ContentHash) {
  const auto grid = openvdb::FloatGrid::create();
  grid->tree().setValue(Coord(0, 0, 0), 1.25f);
  write("g.vdb", {grid}, kPlain);
  const auto hash = [&](const std::string& name) { return folder_.load(body(name)).content_hash; };
  std::ifstream in(file("g.vdb"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  folder_.write("same.vdb", bytes);
  EXPECT_EQ(hash("same.vdb"), hash("g.vdb"));
  const float from = 1.25f, to = 2.5f;
  bytes.replace(bytes.rfind(std::string(reinterpret_cast<const char*>(&from), 4)), 4,
                reinterpret_cast<const char*>(&to), 4);
  folder_.write("other.vdb", bytes);
  EXPECT_EQ(load("other.vdb")->sigma_t(Vec3(0)).x, 2.5);
  EXPECT_NE(hash("other.vdb"), hash("g.vdb"));
}

TEST_F(VdbFile, RefusesWhatIsNoDensity) {
  const auto expect = [&](const openvdb::GridBase::Ptr& grid, const std::string& message) {
    grid->setName("g");
    write("g.vdb", {grid}, kMask);
    expect_error("g.vdb", message);
  };
  const auto with_value = [](float v) {
    const auto grid = openvdb::FloatGrid::create();
    grid->tree().setValue(Coord(-3, 4, 5), v);
    return grid;
  };
  expect(with_value(-1e-9f), "voxel (-3, 4, 5) of the grid \"g\" is negative: -1e-09");
  expect(with_value(std::nanf("")), "voxel (-3, 4, 5) of the grid \"g\" is not finite");
  expect(with_value(INFINITY), "is not finite");
  const auto tile = openvdb::FloatGrid::create();
  tile->sparseFill(CoordBBox(Coord(0), Coord(15)), -1.0f);
  expect(tile, "voxel (0, 0, 0) of the grid \"g\" is negative");
  const auto huge = openvdb::DoubleGrid::create();
  huge->tree().setValue(Coord(0, 0, 0), 1e300);
  expect(huge, "is not finite");
  const auto level_set = openvdb::FloatGrid::create(3.0f);
  level_set->setGridClass(openvdb::GRID_LEVEL_SET);
  expect(level_set, "\"g\" is a level set: it holds distances");
  const auto staggered = openvdb::Vec3SGrid::create();
  staggered->setGridClass(openvdb::GRID_STAGGERED);
  expect(staggered, "\"g\" is staggered");
  expect(openvdb::FloatGrid::create(0.5f), "(class \"unknown\") has the background 0.5");
  const auto frustum = with_value(1);
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(9)), 0.5, 10));
  expect(frustum, "\"NonlinearFrustumMap\", a frustum: only affine maps");
  const auto far = with_value(1);
  far->tree().setValue(Coord(5000, 4000, 3000), 1.0f);
  expect(far, "lie in a box of 5004 × 3997 × 2996 voxels");
  const auto farthest = with_value(1);
  farthest->tree().setValue(Coord(2147483647, 2147483647, 2147483647), 1.0f);
  farthest->tree().setValue(Coord(-2147483647 - 1, -2147483647 - 1, -2147483647 - 1), 1.0f);
  expect(farthest, "4294967296 × 4294967296 × 4294967296 voxels");
}

TEST_F(VdbFile, RefusesPropertiesThatItCannotMean) {
  write("g.vdb", {random_grid<openvdb::FloatGrid>()}, kMask);
  for (const char* mode : {"repeat", "mirror"})
    expect_error("g.vdb", "\"wrap_mode\" must be \"clamp\"",
                 "<string name=\"wrap_mode\" value=\"" + std::string(mode) + "\"/>", 4);
  load("g.vdb", R"(<string name="wrap_mode" value="clamp"/>)");
  EXPECT_TRUE(folder_.warnings.empty());
}

TEST_F(VdbFile, RefusesOtherFiles) {
  folder_.write("g.vdb", "no volume");
  expect_error("g.vdb", "g.vdb: expected an OpenVDB file");
  std::ostringstream stream;
  openvdb::io::Stream(stream).write(openvdb::GridPtrVec{random_grid<openvdb::FloatGrid>()});
  folder_.write("g.vdb", stream.str());
  expect_error("g.vdb", "was written as a stream");
  write("g.vdb", {random_grid<openvdb::FloatGrid>()}, kMask);
  std::ifstream in(file("g.vdb"), std::ios::binary);
  std::string old{std::istreambuf_iterator<char>(in), {}};
  old[8] = static_cast<char>(221);
  folder_.write("old.vdb", old);
  expect_error("old.vdb", "expected version 222 to 224 of the format, found 221");
}

/// Prefixes, and changes of the lengths that OpenVDB itself would trust.
TEST_F(VdbFile, DamagedFilesAreErrors) {
  const auto grid = openvdb::FloatGrid::create();
  for (int i = 0; i < 12; ++i) grid->tree().setValue(Coord(3 * i, -i, 2), 0.1f * i);
  grid->setName("g");
  write("g.vdb", {grid}, kBlosc);
  std::ifstream in(file("g.vdb"), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  parse_vdb(bytes, "x.vdb", "");
  const auto next = [](std::size_t n) { return n + (n < 900 ? 7 : 307); };
  for (std::size_t n = 0; n < bytes.size(); n = next(n))
    EXPECT_THROW(parse_vdb(std::string_view(bytes).substr(0, n), "x.vdb", ""), Error) << n;
  int refused = 0;
  for (std::size_t at = 8; at + 8 <= bytes.size(); ++at) {
    std::int64_t old;
    std::memcpy(&old, &bytes[at], sizeof old);
    // The heads, and what may be the length of a chunk.
    if (at > 900 && !(old != 0 && std::abs(old) < 140000)) continue;
    for (const std::int64_t word : {std::int64_t{-6000}, std::int64_t{1} << 40, INT64_MIN}) {
      std::memcpy(&bytes[at], &word, sizeof word);
      try {
        parse_vdb(bytes, "x.vdb", "", 1 << 20);
      } catch (const Error& error) {
        EXPECT_EQ(error.where().file, "x.vdb");
        ++refused;
      }
    }
    std::memcpy(&bytes[at], &old, sizeof old);
  }
  EXPECT_GT(refused, 500);
}

}  // namespace
}  // namespace fogbow
