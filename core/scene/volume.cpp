// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/volume.h"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>

#include "core/util/parallel.h"

namespace fogbow {

namespace {

constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 31;
constexpr std::uint64_t kMaxBlocks = std::uint64_t{1} << 26;

Bounds cube_bounds(const Transform& to_world) {
  Bounds b;
  for (const Vec3& corner : Bounds{Vec3(0), Vec3(1)}.corners()) b.extend(to_world.point(corner));
  return b;
}

void check(const VoxelData& data) {
  std::uint64_t values = static_cast<std::uint64_t>(data.channels);
  for (const int n : data.size) {
    if (n < 1) throw std::domain_error("a volume needs at least one voxel on each axis");
    values *= static_cast<std::uint64_t>(n);
    if (values > kMaxValues) throw std::domain_error("a volume has too many voxels");
  }
  if (data.channels != 1 && data.channels != 3)
    throw std::domain_error("a volume needs one channel or three");
  if (data.values.size() != std::size_t(data.size[0]) * data.size[1] * data.size[2] * data.channels)
    throw std::domain_error("a volume's size does not fit its values");
  for (const float v : data.values)
    if (!(v >= 0 && std::isfinite(v))) throw std::domain_error("a voxel is negative or not finite");
}

}  // namespace

Volume::Volume(VoxelData data, const VolumeSettings& settings)
    : filter_(settings.filter),
      wrap_(settings.wrap),
      channels_(data.channels),
      bounds_(cube_bounds(settings.to_world)),
      size_(data.size) {
  check(data);
  for (std::size_t i = 0; i < data.values.size(); ++i) {
    double& max = max_[static_cast<int>(i % static_cast<std::size_t>(channels_))];
    max = std::max(max, double(data.values[i]));
  }
  if (channels_ == 1) max_ = RGB(max_.x);
  make_lattice(settings.to_world);
  make_blocks(data);
}

Volume::Volume(const RGB& value, const Transform& to_world)
    : Volume({{1, 1, 1}, 1, {1.0f}}, {to_world, VolumeFilter::Nearest, VolumeWrap::Clamp}) {
  for (int c = 0; c < 3; ++c)
    if (!(value[c] >= 0 && std::isfinite(value[c])))
      throw std::domain_error("a volume's value is negative or not finite");
  constant_ = true;
  factor_ = max_ = value;
}

int Volume::wrapped(int axis, std::int64_t i) const {
  const std::int64_t n = size_[axis];
  switch (wrap_) {
    case VolumeWrap::Clamp: break;
    case VolumeWrap::Repeat: return static_cast<int>((i % n + n) % n);
    case VolumeWrap::Mirror: {
      const std::int64_t j = (i % (2 * n) + 2 * n) % (2 * n);
      return static_cast<int>(j < n ? j : 2 * n - 1 - j);
    }
  }
  return static_cast<int>(std::clamp<std::int64_t>(i, 0, n - 1));
}

void Volume::make_lattice(const Transform& to_world) {
  const Mat4& to_local = to_world.inverse_matrix();
  const Vec3 scale(size_[0], size_[1], size_[2]);
  for (int column = 0; column < 3; ++column) to_lattice_[column] = Vec3(to_local[column]) * scale;
  lattice_origin_ = Vec3(to_local[3]) * scale;
  if (filter_ == VolumeFilter::Trilinear) lattice_origin_ -= Vec3(0.5);
  Bounds reach;
  for (const Vec3& corner : bounds_.corners()) reach.extend(lattice_point(corner));
  std::uint64_t blocks = 1;
  for (int axis = 0; axis < 3; ++axis) {
    // What rounding adds to a box that just fits the voxels is no cell.
    const double slack = 1e-6;
    const double lo = std::floor(reach.lo[axis] + slack), hi = std::ceil(reach.hi[axis] - slack);
    const double cells = std::max(hi - lo, 1.0);
    const double block_count = std::ceil(cells / kBlock);
    if (!(block_count * static_cast<double>(blocks) <= double(kMaxBlocks) && std::abs(lo) < 1e9))
      throw std::domain_error("the box around a volume is too large for its voxels");
    first_[axis] = static_cast<int>(lo);
    count_[axis] = static_cast<int>(cells);
    blocks_[axis] = static_cast<int>(block_count);
    blocks *= static_cast<std::uint64_t>(blocks_[axis]);
  }
}

std::vector<int> Volume::voxels_of(int axis, int block) const {
  const int first = kBlock * block;
  const int cells = std::min(kBlock, count_[axis] - first);
  std::vector<int> voxels(cells + (filter_ == VolumeFilter::Trilinear ? 1 : 0));
  for (int i = 0; auto& voxel : voxels)
    voxel = wrapped(axis, std::int64_t{first_[axis]} + first + i++);
  return voxels;
}

template <class Visit>
void Volume::for_samples(const VoxelData& data, const Index& block, Visit&& visit) const {
  const auto xs = voxels_of(0, block[0]), ys = voxels_of(1, block[1]), zs = voxels_of(2, block[2]);
  const auto voxel = [&](std::size_t x, std::size_t y, std::size_t z) {
    return &data.values[((z * size_[1] + y) * size_[0] + x) * channels_];
  };
  for (int z = 0; z < std::ssize(zs); ++z)
    for (int y = 0; y < std::ssize(ys); ++y)
      for (int x = 0; x < std::ssize(xs); ++x) visit(x, y, z, voxel(xs[x], ys[y], zs[z]));
}

void Volume::make_blocks(const VoxelData& data) {
  // Beyond the first and last voxel, blocks are copies of others: of the first on each axis that
  // has the same voxels.
  std::array<std::vector<int>, 3> first_like;
  for (int axis = 0; axis < 3; ++axis) {
    std::map<std::vector<int>, int> first;
    for (int b = 0; b < blocks_[axis]; ++b)
      first_like[axis].push_back(first.emplace(voxels_of(axis, b), b).first->second);
  }
  const std::size_t n = block_index(0, 0, blocks_[2]);
  kinds_.resize(n);
  block_.resize(n);
  block_max_.resize(n * channels_);
  const auto for_blocks = [&](int z, const auto& visit) {
    for (int y = 0; y < blocks_[1]; ++y)
      for (int x = 0; x < blocks_[0]; ++x)
        visit(Index{x, y, z}, block_index(x, y, z),
              block_index(first_like[0][x], first_like[1][y], first_like[2][z]));
  };
  parallel_for(blocks_[2], [&](std::int64_t z) {
    for_blocks(static_cast<int>(z), [&](const Index& i, std::size_t block, std::size_t original) {
      if (block == original) read_block(data, i);
    });
  });
  std::uint32_t varying = 0;
  const Vec3 first(first_[0], first_[1], first_[2]);
  for (int z = 0; z < blocks_[2]; ++z)
    for_blocks(z, [&](const Index& i, std::size_t block, std::size_t original) {
      const bool copy = block != original;
      kinds_[block] = kinds_[original];
      std::copy_n(&block_max_[original * channels_], channels_, &block_max_[block * channels_]);
      if (kinds_[block] == BlockKind::Varying) block_[block] = copy ? block_[original] : varying++;
      if (kinds_[block] != BlockKind::Empty)
        for (const int side : {0, 1})
          occupied_.extend(first + double(kBlock) * (Vec3(i[0], i[1], i[2]) + double(side)));
    });
  if (std::uint64_t{varying} * kSamples * channels_ > kMaxValues)
    throw std::domain_error("a volume has too many voxels");
  samples_.resize(std::size_t{varying} * kSamples * channels_);
  parallel_for(blocks_[2], [&](std::int64_t z) {
    for_blocks(static_cast<int>(z), [&](const Index& i, std::size_t block, std::size_t original) {
      if (block != original || kinds_[block] != BlockKind::Varying) return;
      float* samples = &samples_[std::size_t{block_[block]} * kSamples * channels_];
      for_samples(data, i, [&](int x, int y, int z_, const float* voxel) {
        std::copy_n(voxel, channels_, samples + sample_index(x, y, z_) * channels_);
      });
    });
  });
}

void Volume::read_block(const VoxelData& data, const Index& block) {
  const std::size_t index = block_index(block[0], block[1], block[2]);
  std::array<float, 3> lo, hi;
  lo.fill(std::numeric_limits<float>::max());
  hi.fill(0);
  for_samples(data, block, [&](int, int, int, const float* voxel) {
    for (int c = 0; c < channels_; ++c) {
      lo[c] = std::min(lo[c], voxel[c]);
      hi[c] = std::max(hi[c], voxel[c]);
    }
  });
  bool uniform = true, empty = true;
  for (int c = 0; c < channels_; ++c) {
    block_max_[index * channels_ + c] = hi[c];
    uniform &= lo[c] == hi[c];
    empty &= hi[c] == 0;
  }
  kinds_[index] = empty ? BlockKind::Empty : uniform ? BlockKind::Uniform : BlockKind::Varying;
}

double Volume::sample(const Index& i, int channel) const {
  Index block, at;
  for (int axis = 0; axis < 3; ++axis) {
    const int cell = i[axis] - first_[axis];
    block[axis] = std::min(cell / kBlock, blocks_[axis] - 1);
    at[axis] = cell - kBlock * block[axis];
  }
  const std::size_t index = block_index(block[0], block[1], block[2]);
  return kinds_[index] == BlockKind::Varying
             ? block_samples(index)[sample_index(at[0], at[1], at[2]) * channels_ + channel]
             : block_max(index)[channel];
}

/// corner(i, channel): value of corner i of the cell, of which the first is the nearest voxel's.
template <class Corner>
RGB Volume::filtered(const Vec3& local, const Corner& corner) const {
  RGB result(0);
  for (int c = 0; c < channels_; ++c) {
    if (filter_ == VolumeFilter::Nearest) {
      result[c] = corner(0, c);
      continue;
    }
    double v[8];
    for (int i = 0; i < 8; ++i) v[i] = corner(i, c);
    result[c] = trilinear(v, local.x, local.y, local.z);
  }
  return channels_ == 1 ? RGB(result.x) : result;
}

RGB Volume::value(const Vec3& p) const {
  if (constant_) return factor_;
  const Vec3 q = lattice_point(p), cell = glm::floor(q), local = q - cell;
  bool tabled = true;
  Index block, at;
  for (int axis = 0; axis < 3; ++axis) {
    // Beyond that no double tells cells apart.
    if (!(std::abs(cell[axis]) < 1e15)) return RGB(0);
    const auto i = static_cast<std::int64_t>(cell[axis]) - first_[axis];
    tabled = tabled && i >= 0 && i < count_[axis];
    block[axis] = static_cast<int>(i / kBlock);
    at[axis] = static_cast<int>(i % kBlock);
  }
  if (!tabled)
    return filtered(local, [&](int corner, int c) {
      Index i;
      for (int axis = 0; axis < 3; ++axis)
        i[axis] = wrapped(axis, static_cast<std::int64_t>(cell[axis]) + (corner >> axis & 1));
      return sample(i, c);
    });
  const std::size_t index = block_index(block[0], block[1], block[2]);
  if (kinds_[index] != BlockKind::Varying)
    return filtered(local, [&](int, int c) { return block_max(index)[c]; });
  const float* first = block_samples(index) + sample_index(at[0], at[1], at[2]) * channels_;
  return filtered(local,
                  [&](int corner, int c) { return first[kCorners[corner] * channels_ + c]; });
}

RGB Volume::max_within(const Bounds& box) const {
  const bool tabled = glm::all(glm::lessThanEqual(bounds_.lo, box.lo)) &&
                      glm::all(glm::lessThanEqual(box.hi, bounds_.hi));
  if (constant_ || !tabled) return max_;
  Bounds reach;
  for (const Vec3& corner : box.corners()) reach.extend(lattice_point(corner));
  int lo[3], hi[3];
  for (int axis = 0; axis < 3; ++axis) {
    const auto block = [&](double q) {
      const int cell = static_cast<int>(std::floor(q)) - first_[axis];
      return std::clamp(cell / kBlock, 0, blocks_[axis] - 1);
    };
    lo[axis] = block(reach.lo[axis]);
    hi[axis] = block(reach.hi[axis]);
  }
  RGB result(0);
  for (int z = lo[2]; z <= hi[2]; ++z)
    for (int y = lo[1]; y <= hi[1]; ++y)
      for (int x = lo[0]; x <= hi[0]; ++x) {
        const float* m = block_max(block_index(x, y, z));
        result = glm::max(result, channels_ == 1 ? RGB(m[0]) : RGB(m[0], m[1], m[2]));
      }
  return result;
}

std::size_t Volume::memory_bytes() const {
  return (samples_.size() + block_max_.size()) * sizeof(float) +
         block_.size() * sizeof(std::uint32_t) + kinds_.size();
}

}  // namespace fogbow
