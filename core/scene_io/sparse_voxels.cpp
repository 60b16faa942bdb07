// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/sparse_voxels.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <stdexcept>

#include "core/scene_io/diagnostics.h"

namespace fogbow {

namespace {

/// Of the table of contents, so much that a message stays readable.
std::string contents(const std::vector<GridEntry>& grids) {
  constexpr std::size_t kMost = 8;
  if (grids.empty()) return "no grid";
  std::string result;
  for (std::size_t i = 0; i < std::min(grids.size(), kMost); ++i)
    result += (i > 0 ? ", " : "") + quote(grids[i].name) + " (" + quote(grids[i].type) + ")";
  if (grids.size() > kMost) result += " and " + std::to_string(grids.size() - kMost) + " more";
  return result;
}

std::string text(const SparseVoxels::Index& i, const char* between) {
  return std::to_string(i[0]) + between + std::to_string(i[1]) + between + std::to_string(i[2]);
}

}  // namespace

void number_names(std::vector<GridEntry>& grids) {
  std::map<std::string, int> seen;
  for (GridEntry& grid : grids)
    if (const int before = seen[grid.name]++; before > 0)
      grid.name += "[" + std::to_string(before) + "]";
}

std::size_t choose_grid(const std::vector<GridEntry>& grids, const std::string& wanted,
                        const std::string& file) {
  const auto fail = [&](const std::string& message) {
    throw GridChoiceError(ErrorKind::Scene, {file, 0, 0},
                          message + "; it holds " + contents(grids));
  };
  const auto named = [&](const std::string& name) {
    return std::find_if(grids.begin(), grids.end(),
                        [&](const GridEntry& g) { return g.name == name; }) -
           grids.begin();
  };
  if (!wanted.empty()) {
    const std::size_t i = named(wanted);
    if (i == grids.size()) fail("there is no grid " + quote(wanted));
    if (grids[i].channels == 0)
      fail("the grid " + quote(wanted) + " is of type " + quote(grids[i].type) +
           ", but a medium takes real numbers, single or in threes");
    return i;
  }
  for (const int channels : {1, 3}) {
    const auto fits = [&](const GridEntry& g) { return g.channels == channels; };
    const auto count = std::count_if(grids.begin(), grids.end(), fits);
    if (count == 1) return std::find_if(grids.begin(), grids.end(), fits) - grids.begin();
    if (count == 0) continue;
    const std::size_t density = named("density");
    if (density < grids.size() && fits(grids[density])) return density;
    fail("\"grid\" must say which grid is meant");
  }
  fail("there is no grid of real numbers");
  return 0;
}

std::string SparseVoxels::name() const { return "the grid " + quote(grid_); }

void SparseVoxels::fail(const std::string& message) const {
  throw Error(ErrorKind::Scene, {file_, 0, 0}, message);
}

void SparseVoxels::check_kind(const std::string& grid_class, const float* background) const {
  if (grid_class == "level set")
    fail(
        name() +
        " is a level set: it holds distances to a surface, not densities; OpenVDB's sdfToFogVolume "
        "makes densities of it");
  if (grid_class == "staggered")
    fail(name() + " is staggered: its values belong to faces of voxels, not to one point each");
  if (grid_class != "fog volume" && grid_class != "unknown")
    fail(name() + " is of the class " + quote(grid_class) +
         ", expected \"fog volume\" or \"unknown\"");
  for (int c = 0; c < result_.voxels.channels; ++c)
    if (background[c] != 0)
      fail(name() + " (class " + quote(grid_class) + ") has the background " +
           std::to_string(background[c]) + ": a medium must end somewhere, so it must be zero");
}

void SparseVoxels::cover(const Index& lo, const Index& hi) {
  for (int axis = 0; axis < 3; ++axis) {
    lo_[axis] = covered_ ? std::min(lo_[axis], lo[axis]) : lo[axis];
    hi_[axis] = covered_ ? std::max(hi_[axis], hi[axis]) : hi[axis];
  }
  covered_ = true;
}

void SparseVoxels::cover_leaf(const Index& origin, const LeafMask& active) {
  for (int x = 0; x < kLeaf; ++x) {
    if (active[x] == 0) continue;
    std::uint64_t rows = active[x];
    for (const int shift : {4, 2, 1}) rows |= rows >> shift;  // bit 0 of each row: it has any
    rows &= 0x0101010101010101u;
    std::uint64_t columns = active[x];
    for (const int shift : {32, 16, 8}) columns |= columns >> shift;
    columns &= 0xff;
    cover({origin[0] + x, origin[1] + std::countr_zero(rows) / 8,
           origin[2] + std::countr_zero(columns)},
          {origin[0] + x, origin[1] + 7 - std::countl_zero(rows) / 8,
           origin[2] + 63 - std::countl_zero(columns)});
  }
}

void SparseVoxels::allocate(std::uint64_t max_values) {
  VoxelData& voxels = result_.voxels;
  const Index size{hi_[0] - lo_[0] + 1, hi_[1] - lo_[1] + 1, hi_[2] - lo_[2] + 1};
  std::uint64_t count = static_cast<std::uint64_t>(voxels.channels);
  bool too_large = false;
  for (const std::int64_t n : size) {
    // Each of them has less than 33 bits, and what has too many does not grow.
    too_large = too_large || static_cast<std::uint64_t>(n + 2) > max_values / count;
    if (!too_large) count *= static_cast<std::uint64_t>(n + 2);
  }
  if (too_large)
    fail("the active voxels of " + name() + " lie in a box of " + text(size, " × ") +
         " voxels: with a layer around it, more than " + std::to_string(max_values) + " values");
  for (int axis = 0; axis < 3; ++axis) {
    voxels.size[axis] = static_cast<int>(size[axis] + 2);
    result_.first[axis] = static_cast<std::int32_t>(lo_[axis]);
  }
  voxels.values.assign(count, 0.0f);
  allocated_ = true;
}

void SparseVoxels::set(const Index& at, const float* value) {
  VoxelData& v = result_.voxels;
  std::size_t offset = 0;
  for (int axis = 2; axis >= 0; --axis)
    offset = offset * v.size[axis] + static_cast<std::size_t>(at[axis] - lo_[axis] + 1);
  for (int c = 0; c < v.channels; ++c) {
    if (!(value[c] >= 0 && std::isfinite(value[c])))
      fail("voxel (" + text(at, ", ") + ") of " + name() + " is " +
           (std::isfinite(value[c]) ? "negative: " + number(value[c]) : "not finite"));
    v.values[offset * v.channels + c] = std::abs(value[c]);  // no negative zero
  }
}

void SparseVoxels::tile(const Index& origin, std::int64_t size, bool active, const float* value) {
  const auto last = [&](int axis) { return origin[axis] + size - 1; };
  if (!allocated_) {
    if (active) cover(origin, {last(0), last(1), last(2)});
    return;
  }
  if (std::all_of(value, value + result_.voxels.channels, [](float v) { return v == 0; })) return;
  Index lo, hi;
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = std::max(origin[axis], lo_[axis]);
    hi[axis] = std::min(last(axis), hi_[axis]);
  }
  if (!covered_) return;
  for (std::int64_t z = lo[2]; z <= hi[2]; ++z)
    for (std::int64_t y = lo[1]; y <= hi[1]; ++y)
      for (std::int64_t x = lo[0]; x <= hi[0]; ++x) set({x, y, z}, value);
}

void SparseVoxels::fill_leaf(const Index& origin, const float* values) {
  if (!covered_) return;
  Index begin, end;
  for (int axis = 0; axis < 3; ++axis) {
    begin[axis] = std::max<std::int64_t>(lo_[axis] - origin[axis], 0);
    end[axis] = std::min<std::int64_t>(hi_[axis] - origin[axis] + 1, kLeaf);
  }
  for (std::int64_t x = begin[0]; x < end[0]; ++x)
    for (std::int64_t y = begin[1]; y < end[1]; ++y)
      for (std::int64_t z = begin[2]; z < end[2]; ++z)
        set({origin[0] + x, origin[1] + y, origin[2] + z},
            values + ((x * kLeaf + y) * kLeaf + z) * result_.voxels.channels);
}

VdbGrid SparseVoxels::finish(const Mat4& index_to_world) {
  try {
    result_.index_to_world = Transform(index_to_world);
  } catch (const std::domain_error& error) {
    fail("the map of " + name() + " from indices to the world: " + error.what());
  }
  return std::move(result_);
}

}  // namespace fogbow
