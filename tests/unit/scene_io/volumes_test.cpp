// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <bit>
#include <cstring>

#include "core/scene_io/volume_grid.h"
#include "media/media.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A file of 2×3×1 voxels with the box (0, 0, 0) … (4, 6, 2).
template <class T>
std::string vol_file(int encoding, const std::vector<T>& values, int channels = 1) {
  std::string bytes = "VOL\3";
  for (const std::int32_t word : {encoding, 2, 3, 1, channels}) append(bytes, word);
  for (const float bound : {0.f, 0.f, 0.f, 4.f, 6.f, 2.f}) append(bytes, bound);
  for (const T& v : values) append(bytes, v);
  return bytes;
}

const std::vector<float> kValues{0, 0.25f, 1, 2, 0.5f, 1.5f};

TEST(VolFile, Float32) {
  const VolumeFile file = parse_vol(vol_file(1, kValues), "x.vol");
  EXPECT_EQ(file.voxels.size, (std::array<int, 3>{2, 3, 1}));
  EXPECT_EQ(file.voxels.channels, 1);
  EXPECT_EQ(file.voxels.values, kValues);
  EXPECT_EQ(file.bounds.lo, Vec3(0));
  EXPECT_EQ(file.bounds.hi, Vec3(4, 6, 2));
  EXPECT_EQ(file.unread_bytes, 0u);
  EXPECT_EQ(parse_vol(vol_file(1, kValues) + "abc", "x.vol").unread_bytes, 3u);
}

/// Subnormal, normal and largest numbers of IEEE 754 binary16.
TEST(VolFile, Float16) {
  const std::vector<std::uint16_t> halves{0x0000, 0x0001, 0x03ff, 0x3555, 0x3c00, 0x7bff};
  const std::vector<float> expected{0, 0x1p-24f, 0x3ffp-24f, 0x1.554p-2f, 1, 65504};
  EXPECT_EQ(parse_vol(vol_file(2, halves), "x.vol").voxels.values, expected);
}

TEST(VolFile, Uint8) {
  const std::vector<std::uint8_t> bytes{0, 51, 102, 153, 204, 255};
  const std::vector<float> expected{0, 0.2f, 0.4f, 0.6f, 0.8f, 1};
  EXPECT_EQ(parse_vol(vol_file(3, bytes), "x.vol").voxels.values, expected);
}

TEST(VolFile, ThreeChannels) {
  std::vector<float> values;
  for (int i = 0; i < 18; ++i) values.push_back(static_cast<float>(i));
  const VoxelData voxels = parse_vol(vol_file(1, values, 3), "x.vol").voxels;
  EXPECT_EQ(voxels.channels, 3);
  EXPECT_EQ(voxels.values, values);
}

class VolumeScene : public ::testing::Test {
 protected:
  VolumeScene() { folder_.write("smoke.vol", vol_file(1, kValues)); }
  static std::string in_shape(const std::string& medium) {
    return "<shape type=\"cube\"><medium type=\"heterogeneous\" name=\"interior\" id=\"m\">" +
           medium + "</medium></shape>";
  }
  std::shared_ptr<const Medium> load(const std::string& properties) {
    return folder_.load(in_shape(properties)).surfaces.at(0).interior;
  }
  static std::string grid(const std::string& name, const std::string& more = "") {
    return "<volume type=\"gridvolume\" name=\"" + name +
           "\"><string name=\"filename\" value=\"smoke.vol\"/>" + more + "</volume>";
  }
  SceneFolder folder_;
};

/// As in Mitsuba: σ_t 1, albedo 0.75, no scale, all within the unit cube.
TEST_F(VolumeScene, Defaults) {
  const auto m = load("");
  EXPECT_EQ(m->sigma_t(Vec3(0.5)), RGB(1));
  EXPECT_EQ(m->sigma_s(Vec3(0.5)), RGB(0.75));
  EXPECT_EQ(m->sigma_t(Vec3(0.5, 0.5, 1.5)), RGB(0));
  EXPECT_EQ(m->emission(Vec3(0.5)), RGB(0));
  EXPECT_EQ(m->id(), "m");
  EXPECT_TRUE(folder_.warnings.empty());
}

TEST_F(VolumeScene, GridsAndConstants) {
  const auto m = load(grid("sigma_t") + R"(<float name="scale" value="4"/>
      <volume type="constvolume" name="albedo"><rgb name="value" value="0.5, 0.25, 1"/></volume>
      <rgb name="emission" value="1, 2, 3"/><phase type="hg"/>)");
  const Vec3 voxel(0.25, 0.5, 0.9);  // the third of six: 1
  EXPECT_EQ(m->sigma_t(voxel), RGB(4));
  EXPECT_EQ(m->sigma_s(voxel), RGB(2, 1, 4));
  EXPECT_EQ(m->emission(voxel), RGB(1, 2, 3));
  EXPECT_EQ(m->phase().mean_cosine(), 0.8);
  EXPECT_TRUE(folder_.warnings.empty());
  const auto shared = folder_.load(
      "<volume type=\"constvolume\" id=\"v\"><float name=\"value\" "
      "value=\"0.5\"/></volume>" +
      in_shape("<ref name=\"sigma_t\" id=\"v\"/><ref name=\"albedo\" "
               "id=\"v\"/>"));
  EXPECT_EQ(shared.surfaces[0].interior->sigma_s(Vec3(0.5)), RGB(0.25));
}

/// Mitsuba's homogeneous medium takes a volume for its albedo alone; its extinction has no end.
TEST_F(VolumeScene, AlbedoOfAHomogeneousMedium) {
  std::vector<float> values = kValues;
  for (float& v : values) v /= *std::ranges::max_element(kValues);
  folder_.write("smoke.vol", vol_file(1, values));
  const auto body = [](const std::string& properties) {
    return "<shape type=\"cube\"><medium type=\"homogeneous\" name=\"interior\">" + properties +
           "</medium></shape>";
  };
  const std::string sigma_t =
      R"(<rgb name="sigma_t" value="1, 2, 4"/><float name="scale" value="2"/>)";
  const auto m = folder_.load(body(sigma_t + grid("albedo"))).surfaces.at(0).interior;
  EXPECT_TRUE(folder_.warnings.empty());
  const auto albedo = load(grid("albedo"));  // of a heterogeneous one with sigma_t = 1
  for (const Vec3& p : {Vec3(0.25, 0.5, 0.9), Vec3(0.75, 0.5, 0.1)}) {
    EXPECT_EQ(m->sigma_t(p), RGB(2, 4, 8));
    EXPECT_NEAR(length(m->sigma_s(p) - albedo->sigma_s(p) * RGB(2, 4, 8)), 0, 1e-12);
  }
  EXPECT_EQ(m->sigma_t(Vec3(-700, 20, 3)), RGB(2, 4, 8));
  // Across the whole scene.
  const auto plain = make_homogeneous_medium(RGB(2, 4, 8), RGB(0.5), make_isotropic_phase());
  const Ray ray{Vec3(-0.3, 0.2, 0.4), normalize(Vec3(1, 0.5, 0.2)), 0, kInfinity};
  EXPECT_NEAR(length(m->optical_depth(ray, 0, 1.75) - plain->optical_depth(ray, 0, 1.75)), 0, 1e-9);
  EXPECT_NE(folder_.error(body(sigma_t + grid("albedo") + R"(<rgb name="emission" value="1"/>)"))
                .find("\"emission\" does not go with an albedo that is a volume"),
            std::string::npos);
}

TEST_F(VolumeScene, WhereTheGridIs) {
  const std::string to_world = R"(<transform name="to_world"><translate x="1"/></transform>)";
  EXPECT_EQ(load(grid("sigma_t", to_world))->sigma_t(Vec3(1.25, 0.5, 0.5)), RGB(1));
  const std::string own_box = R"(<boolean name="use_grid_bbox" value="true"/>)";
  EXPECT_EQ(load(grid("sigma_t", own_box))->sigma_t(Vec3(1, 3, 1)), RGB(1));
  EXPECT_EQ(load(grid("sigma_t", own_box + to_world))->sigma_t(Vec3(2, 3, 1)), RGB(1));
  const std::string nearest = R"(<string name="filter_type" value="nearest"/>)";
  EXPECT_EQ(load(grid("sigma_t", nearest))->sigma_t(Vec3(0.4, 0.4, 0.4)), RGB(1));
}

/// The bytes of files count, their names do not.
TEST_F(VolumeScene, ContentHash) {
  const auto hash = [&](const std::string& body) { return folder_.load(body).content_hash; };
  const std::string body = in_shape(grid("sigma_t"));
  const auto before = hash(body);
  folder_.write("other.vol", vol_file(1, kValues));
  std::string renamed = body;
  renamed.replace(renamed.find("smoke.vol"), 9, "other.vol");
  EXPECT_EQ(hash(renamed), before);
  auto values = kValues;
  values[3] = 7;
  folder_.write("smoke.vol", vol_file(1, values));
  EXPECT_NE(hash(body), before);
}

TEST_F(VolumeScene, RefusesWhatItCannotMean) {
  const auto error = [&](const std::string& properties) {
    return folder_.error(in_shape(properties));
  };
  const auto expect = [&](const std::string& properties, const std::string& message) {
    const std::string text = error(properties);
    EXPECT_NE(text.find(message), std::string::npos) << text;
    EXPECT_EQ(text.find("scene.xml:2:"), 0u) << text;
  };
  expect(R"(<volume type="gridvolume" name="sigma_t"/>)", "needs the string \"filename\"");
  expect(R"(<volume type="vdb" name="sigma_t"/>)", "volume plugin \"vdb\" is not supported");
  expect(grid("sigma_t", R"(<string name="filter_type" value="cubic"/>)"),
         "\"filter_type\" must be one of \"nearest\" or \"trilinear\", found \"cubic\"");
  expect(grid("sigma_t", R"(<string name="wrap_mode" value="border"/>)"), "\"wrap_mode\" must be");
  expect(grid("albedo"), "albedo of a medium must lie in [0, 1]");
  expect(R"(<float name="scale" value="-1"/>)", "\"scale\" must not be negative");
  expect(grid("sigma_t") + grid("sigma_t"), "a second \"sigma_t\" volume");
  expect(R"(<volume type="constvolume" name="sigma_t"><float name="value" value="-1"/></volume>)",
         "\"value\" must not be negative");
}

TEST_F(VolumeScene, WarnsOfWhatHasNoEffect) {
  load(grid("sigma_t") + R"(<float name="sigma_a" value="1"/>)" + grid("density_map"));
  ASSERT_EQ(folder_.warnings.size(), 2u);
  EXPECT_NE(folder_.warnings[1].find("the volume nested in medium"), std::string::npos);
  folder_.write("smoke.vol", vol_file(1, kValues) + "tail");
  load(grid("sigma_t"));
  ASSERT_EQ(folder_.warnings.size(), 1u);
  EXPECT_NE(folder_.warnings[0].find("4 bytes behind its last voxel"), std::string::npos);
  load(R"(<float name="scale" value="0"/><float name="emission" value="1"/>)");
  ASSERT_EQ(folder_.warnings.size(), 1u);
  EXPECT_NE(folder_.warnings[0].find("sigma_t is zero everywhere"), std::string::npos);
}

}  // namespace
}  // namespace fogbow
