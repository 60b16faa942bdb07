// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/volume.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "core/util/parallel.h"

namespace fogbow {

namespace {

/// Voxels are kept in bricks of 8³, within which near ones share cache lines: bits of the three
/// indices in turn.
constexpr int kBrickBits = 3;
constexpr int kBrick = 1 << kBrickBits;
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 31;
constexpr std::uint64_t kMaxBlocks = std::uint64_t{1} << 26;

std::uint32_t spread_bits(int i, int axis) {
  std::uint32_t result = 0;
  for (int bit = 0; bit < kBrickBits; ++bit) result |= (i >> bit & 1u) << (3 * bit + axis);
  return result;
}

Bounds cube_bounds(const Transform& to_world) {
  Bounds b;
  for (const Vec3& corner : Bounds{Vec3(0), Vec3(1)}.corners()) b.extend(to_world.point(corner));
  return b;
}

void check(const VoxelData& data) {
  std::uint64_t values = static_cast<std::uint64_t>(data.channels);
  for (const int n : data.size) {
    if (n < 1) throw std::domain_error("a volume needs at least one voxel on each axis");
    values *= static_cast<std::uint64_t>(n + kBrick);
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
  lay_out(data);
  make_lattice(data.size, settings.to_world);
  data = {};
  make_blocks();
}

Volume::Volume(const RGB& value, const Transform& to_world)
    : Volume({{1, 1, 1}, 1, {1.0f}}, {to_world, VolumeFilter::Nearest, VolumeWrap::Clamp}) {
  for (int c = 0; c < 3; ++c)
    if (!(value[c] >= 0 && std::isfinite(value[c])))
      throw std::domain_error("a volume's value is negative or not finite");
  constant_ = true;
  factor_ = max_ = value;
}

void Volume::lay_out(const VoxelData& data) {
  std::array<std::uint32_t, 3> bricks, stride;
  for (int axis = 0; axis < 3; ++axis) bricks[axis] = (size_[axis] + kBrick - 1) / kBrick;
  stride = {kBrick * kBrick * kBrick, 0, 0};
  stride[1] = stride[0] * bricks[0];
  stride[2] = stride[1] * bricks[1];
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 0; i < size_[axis]; ++i)
      layout_[axis].push_back(channels_ *
                              (i / kBrick * stride[axis] + spread_bits(i % kBrick, axis)));
  voxels_.assign(std::size_t(stride[2]) * bricks[2] * channels_, 0.0f);
  const float* next = data.values.data();
  for (int z = 0; z < size_[2]; ++z)
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x)
        for (int c = 0; c < channels_; ++c) {
          const float v = *next++;
          voxels_[layout_[0][x] + layout_[1][y] + layout_[2][z] + c] = v;
          max_[c] = std::max(max_[c], double(v));
        }
  if (channels_ == 1) max_ = RGB(max_.x);
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

void Volume::make_lattice(const std::array<int, 3>& size, const Transform& to_world) {
  const Mat4& to_local = to_world.inverse_matrix();
  const Vec3 scale(size[0], size[1], size[2]);
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
    for (int i = 0; i <= count_[axis]; ++i)
      offsets_[axis].push_back(layout_[axis][wrapped(axis, std::int64_t{first_[axis]} + i)]);
  }
}

void Volume::make_blocks() {
  const std::size_t n = block_index(0, 0, blocks_[2]);
  kinds_.resize(n);
  block_max_.resize(n * channels_);
  parallel_for(blocks_[2], [&](std::int64_t z) {
    for (int y = 0; y < blocks_[1]; ++y)
      for (int x = 0; x < blocks_[0]; ++x) make_block(x, y, static_cast<int>(z));
  });
  const Vec3 first(first_[0], first_[1], first_[2]);
  for (int z = 0; z < blocks_[2]; ++z)
    for (int y = 0; y < blocks_[1]; ++y)
      for (int x = 0; x < blocks_[0]; ++x)
        if (kinds_[block_index(x, y, z)] != BlockKind::Empty)
          for (const Vec3& side : {Vec3(x, y, z), Vec3(x + 1, y + 1, z + 1)})
            occupied_.extend(first + double(kBlock) * side);
}

void Volume::make_block(int bx, int by, int bz) {
  const std::array<int, 3> block{bx, by, bz};
  std::array<int, 3> begin, end;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = first_[axis] + kBlock * block[axis];
    end[axis] = std::min(begin[axis] + kBlock, first_[axis] + count_[axis]) +
                (filter_ == VolumeFilter::Trilinear ? 1 : 0);
  }
  const std::size_t index = block_index(bx, by, bz);
  float* max = &block_max_[index * channels_];
  bool uniform = true, empty = true;
  for (int c = 0; c < channels_; ++c) {
    const auto at = [&](int x, int y, int z) {
      return voxels_[offsets(0)[x] + offsets(1)[y] + offsets(2)[z] + c];
    };
    const float first = at(begin[0], begin[1], begin[2]);
    float lo = first, hi = first;
    for (int z = begin[2]; z < end[2]; ++z)
      for (int y = begin[1]; y < end[1]; ++y)
        for (int x = begin[0]; x < end[0]; ++x) {
          lo = std::min(lo, at(x, y, z));
          hi = std::max(hi, at(x, y, z));
        }
    max[c] = hi;
    uniform &= lo == hi;
    empty &= hi == 0;
  }
  kinds_[index] = empty ? BlockKind::Empty : uniform ? BlockKind::Uniform : BlockKind::Varying;
}

RGB Volume::value(const Vec3& p) const {
  if (constant_) return factor_;
  const Vec3 q = lattice_point(p);
  const int samples = filter_ == VolumeFilter::Trilinear ? 2 : 1;
  std::uint32_t at[3][2];
  Vec3 local;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::floor(q[axis]);
    // Beyond that no double tells cells apart.
    if (!(std::abs(cell) < 1e15)) return RGB(0);
    local[axis] = q[axis] - cell;
    const auto c = static_cast<std::int64_t>(cell);
    const std::int64_t i = c - first_[axis];
    for (int k = 0; k < samples; ++k)
      at[axis][k] =
          i >= 0 && i < count_[axis] ? offsets_[axis][i + k] : layout_[axis][wrapped(axis, c + k)];
  }
  RGB result(0);
  for (int c = 0; c < channels_; ++c) {
    const float* voxels = voxels_.data() + c;
    if (samples == 1) {
      result[c] = voxels[at[0][0] + at[1][0] + at[2][0]];
      continue;
    }
    double v[8];
    for (int i = 0; i < 8; ++i) v[i] = voxels[at[0][i & 1] + at[1][i >> 1 & 1] + at[2][i >> 2]];
    result[c] = trilinear(v, local.x, local.y, local.z);
  }
  return channels_ == 1 ? RGB(result.x) : result;
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
  return voxels_.size() * sizeof(float) + block_max_.size() * sizeof(float) + kinds_.size();
}

}  // namespace fogbow
