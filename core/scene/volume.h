// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/math/ray.h"
#include "core/math/transform.h"
#include "core/math/vec.h"
#include "core/util/large_pages.h"

namespace fogbow {

enum class VolumeFilter { Trilinear, Nearest };
/// What lies beyond the first and last voxel.
enum class VolumeWrap { Clamp, Repeat, Mirror };

/// Values on a regular grid: x fastest, then y, then z; channels (1 or 3) side by side.
struct VoxelData {
  std::array<int, 3> size{1, 1, 1};
  int channels = 1;
  std::vector<float> values;
};

struct VolumeSettings {
  Transform to_world;  ///< of the unit cube that the voxels fill
  VolumeFilter filter = VolumeFilter::Trilinear;
  VolumeWrap wrap = VolumeWrap::Clamp;
};

/// A field in world space, made of voxels or the same everywhere. It reaches through all of space,
/// as its wrap mode says; `bounds` holds the unit cube.
///
/// Cells are where the field is one polynomial: between the centres of eight voxels (Trilinear), or
/// in one voxel (Nearest). In lattice coordinates they are unit cubes, cell c reaching from c to
/// c + 1. Those that `bounds` meets have tables, and are grouped into blocks.
class Volume {
 public:
  static constexpr int kBlock = 8;  ///< cells a side of a block

  /// Throws std::domain_error on negative or non-finite values, on sizes that do not fit them, and
  /// where `to_world` spreads the cells over too many blocks.
  Volume(VoxelData data, const VolumeSettings& settings);
  /// `value` everywhere; the bounds are those of the unit cube all the same.
  explicit Volume(const RGB& value, const Transform& to_world = {});

  /// In all of space.
  RGB value(const Vec3& p) const;
  /// Of the largest voxels; the filters do not exceed it.
  RGB max() const { return max_; }
  /// The same within a box, or more.
  RGB max_within(const Bounds& box) const;
  const Bounds& bounds() const { return bounds_; }
  bool is_constant() const { return constant_; }
  std::size_t memory_bytes() const;

  // The lattice.

  VolumeFilter filter() const { return filter_; }
  int channels() const { return channels_; }
  /// What voxels are multiplied by: 1 but for constants.
  const RGB& factor() const { return factor_; }
  Vec3 lattice_point(const Vec3& p) const { return to_lattice_ * p + lattice_origin_; }
  Vec3 lattice_vector(const Vec3& v) const { return to_lattice_ * v; }
  /// First cell of the tables on an axis, and how many there are.
  int first_cell(int axis) const { return first_[axis]; }
  int cell_count(int axis) const { return count_[axis]; }
  int block_count(int axis) const { return blocks_[axis]; }

  /// Around all blocks that are not empty, in lattice coordinates.
  const Bounds& occupied() const { return occupied_; }
  std::size_t block_index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * blocks_[1] + y) * blocks_[0] + x;
  }
  enum class BlockKind : std::uint8_t { Empty, Uniform, Varying };
  BlockKind block_kind(std::size_t block) const { return kinds_[block]; }
  /// Largest value of each channel in a block, without the factor.
  const float* block_max(std::size_t block) const { return &block_max_[block * channels_]; }
  /// The samples of a varying block, x fastest, channels side by side: kBlock + 1 a side, so that
  /// all corners of its cells are among them.
  const float* block_samples(std::size_t block) const {
    return &samples_[std::size_t{block_[block]} * kSamples * channels_];
  }
  static constexpr int kSide = kBlock + 1, kSamples = kSide * kSide * kSide;
  static constexpr int sample_index(int x, int y, int z) { return (z * kSide + y) * kSide + x; }
  /// Corners of a cell from its first one on: x fastest.
  static constexpr std::array<int, 8> kCorners{0,
                                               1,
                                               kSide,
                                               kSide + 1,
                                               kSide* kSide,
                                               kSide* kSide + 1,
                                               kSide*(kSide + 1),
                                               kSide*(kSide + 1) + 1};

 private:
  using Index = std::array<int, 3>;

  void make_lattice(const Transform& to_world);
  void make_blocks(const VoxelData& data);
  void read_block(const VoxelData& data, const Index& block);
  /// visit(x, y, z, voxel) for all samples of a block, as sample_index() numbers them.
  template <class Visit>
  void for_samples(const VoxelData& data, const Index& block, Visit&& visit) const;
  /// Those that the samples of a block on an axis are.
  std::vector<int> voxels_of(int axis, int block) const;
  int wrapped(int axis, std::int64_t i) const;
  double sample(const Index& i, int channel) const;
  template <class Corner>
  RGB filtered(const Vec3& local, const Corner& corner) const;

  VolumeFilter filter_;
  VolumeWrap wrap_;
  int channels_;
  RGB factor_{1}, max_{0};
  bool constant_ = false;
  Bounds bounds_;
  Mat3 to_lattice_{1.0};
  Vec3 lattice_origin_{0};
  Index size_, first_{}, count_{}, blocks_{};
  std::vector<float, LargePageAllocator<float>> samples_;
  std::vector<std::uint32_t> block_;  ///< of samples_, which varying blocks have
  std::vector<float> block_max_;
  std::vector<BlockKind> kinds_;
  Bounds occupied_;
};

/// The polynomial of one cell and channel from its corners' values, at local coordinates.
inline double trilinear(const double (&v)[8], double x, double y, double z) {
  const double v00 = v[0] + x * (v[1] - v[0]), v10 = v[2] + x * (v[3] - v[2]);
  const double v01 = v[4] + x * (v[5] - v[4]), v11 = v[6] + x * (v[7] - v[6]);
  const double v0 = v00 + y * (v10 - v00), v1 = v01 + y * (v11 - v01);
  return v0 + z * (v1 - v0);
}

}  // namespace fogbow
