// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "core/math/random.h"
#include "core/scene/volume.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

using enum VolumeFilter;
using enum VolumeWrap;

/// 4×3×2 voxels that hold 1, 2, 3, …
VoxelData counting(int channels) {
  VoxelData data{{4, 3, 2}, channels, std::vector<float>(24 * channels)};
  std::iota(data.values.begin(), data.values.end(), 1.0f);
  return data;
}

Transform affine() {
  Mat4 m(1.0);
  const double rows[3][4] = {{1, 0.5, 0, 0.1}, {0, 2, 0.25, -0.2}, {0.3, 0, 1.5, 0.3}};
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 4; ++c) m[c][r] = rows[r][c];
  return Transform(m);
}

/// The box that the file of the reference values names.
Transform file_box() {
  return Transform::translate(Vec3(-1, -2, -3)) * Transform::scale(Vec3(5, 7, 9));
}

struct MitsubaCase {
  const char* name;
  int channels;
  VolumeSettings settings;
  std::vector<RGB> values;  ///< at kPoints
};

const Vec3 kPoints[] = {{0.5, 0.45, 0.55}, {0.01, 0.02, 0.03}, {0.97, 0.91, 0.96},
                        {1.2, 0.55, 0.45}, {-0.2, 0.4, 1.7},   {0.3, 2.1, 0.8}};

std::vector<RGB> gray(std::initializer_list<double> values) {
  std::vector<RGB> result;
  for (const double v : values) result.emplace_back(v);
  return result;
}

/// Of Mitsuba 3.9.1 (variant scalar_rgb, single precision): Volume.eval of
/// mitsuba.load_dict({"type": "gridvolume", "raw": True, "filename": …, …}) at an Interaction3f,
/// the files being 4×3×2 float32 voxels that count from 1, with a box from (−1, −2, −3) to
/// (4, 5, 6). Without use_grid_bbox the box has no effect.
std::vector<MitsubaCase> mitsuba_cases() {
  return {
      {"clamp", 1, {{}, Trilinear, Clamp}, gray({13.1, 1, 24, 13.4, 15.8, 21.7})},
      {"repeat", 1, {{}, Trilinear, Repeat}, gray({13.1, 11.18, 15.98, 10.7, 17.3, 14.1})},
      {"mirror", 1, {{}, Trilinear, Mirror}, gray({13.1, 1, 24, 13.1, 5.3, 13.7})},
      {"nearest clamp", 1, {{}, Nearest, Clamp}, gray({19, 1, 24, 8, 17, 22})},
      {"nearest repeat", 1, {{}, Nearest, Repeat}, gray({19, 1, 24, 5, 20, 14})},
      {"nearest mirror", 1, {{}, Nearest, Mirror}, gray({19, 1, 24, 8, 5, 14})},
      {"affine",
       1,
       {affine(), Trilinear, Clamp},
       gray({3.202881, 1, 8.753827, 6.622222, 13.083951, 12.679011})},
      {"box of the file",
       1,
       {file_box(), Trilinear, Clamp},
       gray({7.366666, 4.850856, 9.62457, 7.831428, 9.787619, 10.701903})},
      {"affine box",
       1,
       {affine() * file_box(), Trilinear, Clamp},
       gray({5.770232, 4.427948, 6.948582, 5.89753, 7.421477, 7.409188})},
      {"rgb",
       3,
       {affine(), Trilinear, Clamp},
       {{7.608642, 8.608642, 9.608643},
        {1, 2, 3},
        {24.26148, 25.26148, 26.261478},
        {17.866665, 18.866667, 19.866667},
        {37.25185, 38.25185, 39.25185},
        {36.037033, 37.037037, 38.037037}}},
  };
}

TEST(Volume, HasTheValuesOfMitsuba) {
  for (const MitsubaCase& c : mitsuba_cases()) {
    SCOPED_TRACE(c.name);
    const Volume volume(counting(c.channels), c.settings);
    for (std::size_t i = 0; i < c.values.size(); ++i)
      for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(volume.value(kPoints[i])[channel], c.values[i][channel],
                    2e-6 * c.values[i][channel])
            << "point " << i;
  }
}

/// A number of the lattice for each voxel of an axis, as the wrap modes are defined.
int voxel(std::int64_t i, int n, VolumeWrap wrap) {
  while (wrap != Clamp && (i < 0 || i >= n)) {
    if (wrap == Repeat)
      i += i < 0 ? n : -n;
    else
      i = i < 0 ? -1 - i : 2 * n - 1 - i;
  }
  return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
}

RGB from_voxels(const VoxelData& data, const VolumeSettings& s, const Vec3& p) {
  const Vec3 q = s.to_world.inverse().point(p) * Vec3(data.size[0], data.size[1], data.size[2]) -
                 (s.filter == Trilinear ? 0.5 : 0.0);
  RGB sum(0);
  for (int corner = 0; corner < (s.filter == Trilinear ? 8 : 1); ++corner) {
    double weight = 1;
    std::size_t index = 0;
    for (const int axis : {2, 1, 0}) {
      const int up = corner >> axis & 1;
      const double cell = std::floor(q[axis]), part = q[axis] - cell;
      if (s.filter == Trilinear) weight *= up ? part : 1 - part;
      index = index * data.size[axis] +
              voxel(static_cast<std::int64_t>(cell) + up, data.size[axis], s.wrap);
    }
    for (int c = 0; c < 3; ++c)
      sum[c] += weight * data.values[index * data.channels + (data.channels == 3 ? c : 0)];
  }
  return sum;
}

/// Empty, uniform and varying blocks, and what lies beyond the voxels where the box is turned.
TEST(Volume, IsItsVoxelsEverywhere) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 901, 0);
  const Transform turned = affine() * Transform::rotate(Vec3(1, 2, 3), 40);
  for (const int channels : {1, 3}) {
    VoxelData data{{37, 19, 5}, channels, {}};
    for (int i = 0; i < 37 * 19 * 5; ++i)
      for (int c = 0; c < channels; ++c)
        data.values.push_back(i % 37 < 12   ? 0.0f
                              : i % 37 < 24 ? 3.0f
                                            : static_cast<float>(rng.uniform()));
    for (const VolumeFilter filter : {Trilinear, Nearest})
      for (const VolumeWrap wrap : {Clamp, Repeat, Mirror}) {
        const VolumeSettings settings{turned, filter, wrap};
        const Volume volume(data, settings);
        for (int i = 0; i < 3000; ++i) {
          const Vec3 p = turned.point(3.0 * uniform3(rng) - Vec3(1));
          const RGB ours = volume.value(p), theirs = from_voxels(data, settings, p);
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(ours[c], theirs[c], 1e-9)
                << "channels " << channels << ", wrap " << int(wrap) << ", filter " << int(filter);
        }
      }
  }
}

TEST(Volume, TakesNoMemoryForWhatIsRepeated) {
  VoxelData data{{256, 256, 1}, 1, {}};
  Rng rng(testing::suite_seed(), RngDomain::Test, 902, 0);
  for (int i = 0; i < 256 * 256; ++i) data.values.push_back(static_cast<float>(rng.uniform()));
  const Transform slab = Transform::rotate(Vec3(1, 1, 0), 45) * Transform::scale(Vec3(1, 1, 0.01));
  for (const VolumeWrap wrap : {Clamp, Repeat, Mirror})
    EXPECT_LT(Volume(data, {slab, Trilinear, wrap}).memory_bytes(), std::size_t{1} << 24);
}

/// The axis-parallel box around the unit cube, as Volume.bbox() has it.
TEST(Volume, BoundsAreThoseOfMitsuba) {
  const Volume volume(counting(1), {affine()});
  EXPECT_LT(length(volume.bounds().lo - Vec3(0.1, -0.2, 0.3)), 1e-15);
  EXPECT_LT(length(volume.bounds().hi - Vec3(1.6, 2.05, 2.1)), 1e-15);
  EXPECT_EQ(volume.max(), RGB(24));
  EXPECT_EQ(Volume(RGB(1, 2, 3)).bounds().hi, Vec3(1));
  EXPECT_EQ(Volume(RGB(1, 2, 3)).value(Vec3(9)), RGB(1, 2, 3));
}

TEST(Volume, MaximumWithinABoxBoundsTheField) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 900, 0);
  VoxelData data{{21, 18, 35}, 3, {}};
  for (int i = 0; i < 21 * 18 * 35 * 3; ++i)
    data.values.push_back(rng.uniform() < 0.9 ? 0.0f : static_cast<float>(rng.uniform()));
  int tight = 0;
  for (const VolumeFilter filter : {Trilinear, Nearest})
    for (const VolumeWrap wrap : {Clamp, Repeat, Mirror}) {
      const Volume volume(data, {affine(), filter, wrap});
      for (int i = 0; i < 300; ++i) {
        Bounds box;
        const Vec3 corner = volume.bounds().lo + uniform3(rng) * volume.bounds().diagonal();
        box.extend(corner);
        box.extend(corner + 0.3 * uniform3(rng));
        const RGB bound = volume.max_within(box);
        tight += bound != volume.max();
        for (int j = 0; j < 20; ++j) {
          const RGB v = volume.value(box.lo + uniform3(rng) * box.diagonal());
          EXPECT_TRUE(v.x <= bound.x && v.y <= bound.y && v.z <= bound.z);
        }
      }
    }
  EXPECT_GT(tight, 500);
}

TEST(Volume, RefusesWhatIsNoField) {
  EXPECT_THROW(Volume({{2, 1, 1}, 1, {1}}, {}), std::domain_error);
  EXPECT_THROW(Volume({{1, 1, 1}, 2, {1, 1}}, {}), std::domain_error);
  EXPECT_THROW(Volume({{1, 0, 1}, 1, {}}, {}), std::domain_error);
  EXPECT_THROW(Volume({{1, 1, 1}, 1, {-1}}, {}), std::domain_error);
  EXPECT_THROW(Volume({{1, 1, 1}, 1, {std::nanf("")}}, {}), std::domain_error);
  EXPECT_THROW(Volume(RGB(-1)), std::domain_error);
  // A shear by which the box around the cells holds far more of them than there are voxels.
  Mat4 shear(1.0);
  shear[1][0] = 1e6;
  EXPECT_THROW(Volume({{64, 64, 64}, 1, std::vector<float>(64 * 64 * 64)}, {Transform(shear)}),
               std::domain_error);
}

}  // namespace
}  // namespace fogbow
