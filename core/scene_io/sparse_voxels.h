// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/scene_io/volume_vdb.h"

namespace fogbow {

/// A grid in the table of contents of a file.
struct GridEntry {
  std::string name;
  std::string type;  ///< as the file calls it
  int channels = 0;  ///< 0: of a type that is not read
};

/// Names that come more than once get a number: "name[1]" is the second one.
void number_names(std::vector<GridEntry>& grids);
/// The one that volume_vdb.h promises; throws GridChoiceError.
std::size_t choose_grid(const std::vector<GridEntry>& grids, const std::string& wanted,
                        const std::string& file);

/// Makes a VDB tree dense, in two walks over its nodes: the first, up to allocate(), finds the box
/// of the active voxels, the second fills it.
class SparseVoxels {
 public:
  using Index = std::array<std::int64_t, 3>;
  static constexpr int kLeaf = 8;  ///< voxels a side of a leaf, which lie x slowest, z fastest
  /// One word for each x.
  using LeafMask = std::array<std::uint64_t, kLeaf>;

  SparseVoxels(const std::string& file, const std::string& grid, int channels)
      : file_(file), grid_(grid) {
    result_.voxels.channels = channels;
  }

  /// Throws unless a grid of that class and background can be a density.
  void check_kind(const std::string& grid_class, const float* background) const;

  /// A cube of one value.
  void tile(const Index& origin, std::int64_t size, bool active, const float* value);
  void cover_leaf(const Index& origin, const LeafMask& active);
  void allocate(std::uint64_t max_values);
  void fill_leaf(const Index& origin, const float* values);
  VdbGrid finish(const Mat4& index_to_world);

  [[noreturn]] void fail(const std::string& message) const;

 private:
  void cover(const Index& lo, const Index& hi);
  void set(const Index& at, const float* value);
  std::string name() const;

  const std::string &file_, &grid_;
  Index lo_{}, hi_{};  ///< both within the box
  bool covered_ = false, allocated_ = false;
  VdbGrid result_;
};

}  // namespace fogbow
