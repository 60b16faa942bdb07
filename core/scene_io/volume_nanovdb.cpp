// SPDX-License-Identifier: GPL-3.0-or-later
// NanoVDB's header says how a grid lies in memory; its own functions follow offsets unchecked, so
// the walk over the nodes is ours.
#include <nanovdb/NanoVDB.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/scene_io/byte_cursor.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/sparse_voxels.h"
#include "core/scene_io/unpack.h"

namespace fogbow {

namespace {

using Index = SparseVoxels::Index;
using nanovdb::GridClass;
using nanovdb::GridType;

enum Codec { None, Zip, Blosc };
constexpr std::uint64_t kBloscChunk = std::uint64_t{1} << 30;
/// No file that zlib or LZ4 made unpacks to more than so many times its length.
constexpr std::uint64_t kMaxRatio = 1100;

std::string type_name(GridType type) {
  return type < GridType::End ? nanovdb::toStr(type)
                              : "type " + std::to_string(static_cast<std::uint32_t>(type));
}

int channels_of(GridType type) {
  switch (type) {
    case GridType::Float:
    case GridType::Double:
    case GridType::Fp4:
    case GridType::Fp8:
    case GridType::Fp16:
    case GridType::FpN: return 1;
    case GridType::Vec3f:
    case GridType::Vec3d: return 3;
    default: return 0;
  }
}

/// As OpenVDB calls it.
std::string class_name(GridClass grid_class) {
  switch (grid_class) {
    case GridClass::Unknown: return "unknown";
    case GridClass::LevelSet: return "level set";
    case GridClass::FogVolume: return "fog volume";
    case GridClass::Staggered: return "staggered";
    case GridClass::VoxelVolume: return "voxel volume";
    default: return "class " + std::to_string(static_cast<std::uint32_t>(grid_class));
  }
}

template <class T>
std::array<float, 3> floats(const T& v) {
  return {static_cast<float>(v), 0, 0};
}
template <class T>
std::array<float, 3> floats(const nanovdb::Vec3<T>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

/// A grid as it is in memory, aligned; what lies in it is handed out only if all of it does.
class GridMemory {
 public:
  explicit GridMemory(std::uint64_t size) : size_(size), blocks_((size + 31) / 32) {}

  char* data() { return reinterpret_cast<char*>(blocks_.data()); }
  std::uint64_t size() const { return size_; }

  /// Null unless a T, and `extra` bytes behind it, lie at `offset`.
  template <class T>
  const T* find(std::uint64_t offset, std::uint64_t extra = 0) const {
    static_assert(alignof(T) <= alignof(Block));
    const std::uint64_t needed = sizeof(T) + extra;
    if (offset % alignof(T) != 0 || needed > size_ || offset > size_ - needed) return nullptr;
    return reinterpret_cast<const T*>(reinterpret_cast<const char*>(blocks_.data()) + offset);
  }

 private:
  struct alignas(NANOVDB_DATA_ALIGNMENT) Block {
    char bytes[NANOVDB_DATA_ALIGNMENT];
  };
  std::uint64_t size_;
  std::vector<Block> blocks_;
};

/// Of the nodes of a grid whose voxels are a `Build`.
template <class Build>
class Walk {
  using Root = typename nanovdb::NanoRoot<Build>::DataType;
  using Upper = typename nanovdb::NanoUpper<Build>::DataType;
  using Lower = typename nanovdb::NanoLower<Build>::DataType;
  using Leaf = typename nanovdb::NanoLeaf<Build>::DataType;
  static constexpr int kLeafBits = 3, kLowerBits = 7, kUpperBits = 12;  ///< of voxels a side

 public:
  Walk(const GridMemory& memory, SparseVoxels& voxels) : memory_(memory), voxels_(voxels) {}

  void run(const std::string& grid_class, std::uint64_t max_values) {
    const std::uint64_t tree = sizeof(nanovdb::GridData);
    const std::uint64_t offset = tree + get<nanovdb::TreeData<3>>(tree, "the tree").mNodeOffset[3];
    voxels_.check_kind(grid_class, floats(get<Root>(offset, "the root").mBackground).data());
    walk_root(offset);
    voxels_.allocate(max_values);
    filling_ = true;
    visited_ = {};
    walk_root(offset);
  }

 private:
  template <class T>
  const T& get(std::uint64_t offset, const char* what, std::uint64_t extra = 0) const {
    const T* found = memory_.find<T>(offset, extra);
    if (!found)
      voxels_.fail(std::string(what) + " would lie at byte " + std::to_string(offset) +
                   " of a grid of " + std::to_string(memory_.size()) + " bytes");
    return *found;
  }
  /// Else a few bytes could make a walk without end.
  template <class T>
  void count_node(int level) {
    if (++visited_[level] > memory_.size() / sizeof(T))
      voxels_.fail("more nodes than the grid can hold: some stand at several places");
  }

  void walk_root(std::uint64_t offset) {
    using Tile = typename Root::Tile;
    const std::uint32_t count = get<Root>(offset, "the root").mTableSize;
    std::set<std::uint64_t> known;
    for (std::uint32_t i = 0; i < count; ++i) {
      const Tile& tile =
          get<Tile>(offset + sizeof(Root) + i * std::uint64_t{sizeof(Tile)}, "a tile of the root");
      const nanovdb::Coord at = Root::KeyToCoord(tile.key);
      if (Root::CoordToKey(at) != tile.key || !known.insert(tile.key).second)
        voxels_.fail("a tile of the root has a key that is malformed or not its own");
      const Index origin{at[0], at[1], at[2]};
      if (tile.child == 0)
        voxels_.tile(origin, 1 << kUpperBits, tile.state != 0, floats(tile.value).data());
      else
        walk_node<Upper, kLowerBits>(offset + static_cast<std::uint64_t>(tile.child), origin);
    }
  }

  /// A node whose children have 2^kChildBits voxels a side.
  template <class Node, int kChildBits>
  void walk_node(std::uint64_t offset, const Index& origin) {
    constexpr int kBits = kChildBits == kLeafBits ? 4 : 5;
    constexpr std::uint32_t kCount = 1u << (3 * kBits), kMask = (1u << kBits) - 1;
    static_assert(sizeof(Node::mTable) / sizeof(Node::mTable[0]) == kCount);
    count_node<Node>(kChildBits == kLeafBits ? 1 : 2);
    const Node& node = get<Node>(offset, "a node");
    for (std::uint32_t i = 0; i < kCount; ++i) {
      const Index place{origin[0] + (i >> (2 * kBits) << kChildBits),
                        origin[1] + ((i >> kBits & kMask) << kChildBits),
                        origin[2] + ((i & kMask) << kChildBits)};
      if (!node.mChildMask.isOn(i)) {
        voxels_.tile(place, 1 << kChildBits, node.mValueMask.isOn(i),
                     floats(node.mTable[i].value).data());
        continue;
      }
      const std::uint64_t child = offset + static_cast<std::uint64_t>(node.mTable[i].child);
      if constexpr (kChildBits == kLeafBits)
        walk_leaf(child, place);
      else
        walk_node<Lower, kLeafBits>(child, place);
    }
  }

  void walk_leaf(std::uint64_t offset, const Index& origin) {
    count_node<Leaf>(0);
    const Leaf* leaf = &get<Leaf>(offset, "a leaf");
    if constexpr (!Leaf::FIXED_SIZE) {  // FpN: codes of 2^n bits follow
      constexpr int kMostBits = 4;
      if (leaf->mFlags >> 5 > kMostBits) voxels_.fail("a leaf has codes of more than 16 bits");
      leaf = &get<Leaf>(offset, "a leaf", leaf->bitWidth() * std::uint64_t{64});
    }
    if (!filling_) {
      SparseVoxels::LeafMask active;
      static_assert(sizeof active == sizeof leaf->mValueMask);
      std::memcpy(active.data(), &leaf->mValueMask, sizeof active);
      voxels_.cover_leaf(origin, active);
      return;
    }
    constexpr std::uint32_t kCount = 1u << (3 * kLeafBits);
    const int channels = std::is_arithmetic_v<typename Root::ValueT> ? 1 : 3;
    float values[3 * kCount];
    for (std::uint32_t i = 0; i < kCount; ++i)
      std::copy_n(floats(leaf->getValue(i)).data(), channels, values + channels * i);
    voxels_.fill_leaf(origin, values);
  }

  const GridMemory& memory_;
  SparseVoxels& voxels_;
  bool filling_ = false;
  std::array<std::uint64_t, 3> visited_{};
};

class NanoParser {
 public:
  NanoParser(std::string_view bytes, const std::string& name) : in_(bytes, name), name_(name) {}

  VdbGrid parse(const std::string& wanted, std::uint64_t max_values) {
    while (places_.empty() || in_.rest() > 0) read_segment();
    number_names(entries_);
    const std::size_t chosen = choose_grid(entries_, wanted, name_);
    const GridMemory memory = unpack(places_[chosen]);
    const auto* head = memory.find<nanovdb::GridData>(0);
    if (!head || head->mMagic != NANOVDB_MAGIC_NUMBER)
      in_.fail("the grid " + quote(entries_[chosen].name) + " does not begin with \"NanoVDB0\"");
    check_version(head->mVersion.getMajor());
    if (head->mGridType != places_[chosen].type)
      in_.fail("the grid " + quote(entries_[chosen].name) + " says that its type is " +
               type_name(head->mGridType) + ", the file that it is " + entries_[chosen].type);
    SparseVoxels voxels(name_, entries_[chosen].name, entries_[chosen].channels);
    walk(head->mGridType, memory, voxels, class_name(head->mGridClass), max_values);
    return voxels.finish(index_to_world(head->mMap));
  }

 private:
  struct Place {
    std::uint64_t begin, file_size, grid_size;
    GridType type;
    int codec;
  };

  void check_version(std::uint32_t major) const {
    if (major != NANOVDB_MAJOR_VERSION_NUMBER)
      in_.fail("expected version " + std::to_string(NANOVDB_MAJOR_VERSION_NUMBER) +
               " of NanoVDB, found " + std::to_string(major));
  }

  /// Descriptions of grids, then the grids themselves.
  void read_segment() {
    if (in_.rest() < 16 || in_.read<std::uint64_t>() != NANOVDB_MAGIC_NUMBER)
      in_.fail("expected a NanoVDB file, whose parts begin with \"NanoVDB0\"");
    check_version(in_.read<std::uint32_t>() >> 21);
    const auto count = in_.read<std::uint16_t>();
    const int codec = in_.read<std::uint16_t>();
    if (codec > Blosc) in_.fail("grids are packed in the unknown way " + std::to_string(codec));
    const std::size_t first = places_.size();
    for (int i = 0; i < count; ++i) read_description(codec);
    for (std::size_t i = first; i < places_.size(); ++i) {
      places_[i].begin = in_.at();
      in_.take(places_[i].file_size);
    }
    if (count == 0) in_.fail("a part of the file has no grids");
  }

  void read_description(int codec) {
    Place place{};
    place.grid_size = in_.read<std::uint64_t>();
    place.file_size = in_.read<std::uint64_t>();
    in_.take(16);  // hash of the name, number of active voxels
    place.type = static_cast<GridType>(in_.read<std::uint32_t>());
    place.codec = codec;
    in_.take(4 + 48 + 24 + 24);  // class, boxes, size of a voxel
    const auto name_size = in_.read<std::uint32_t>();
    in_.take(16 + 12 + 2 + 2 + 4);  // numbers of nodes and tiles, codec, padding, version
    GridEntry entry;
    entry.name = in_.take(name_size);
    entry.name.resize(std::min(entry.name.find('\0'), entry.name.size()));
    entry.type = type_name(place.type);
    entry.channels = channels_of(place.type);
    entries_.push_back(std::move(entry));
    places_.push_back(place);
  }

  GridMemory unpack(const Place& place) {
    in_.seek(place.begin);
    const std::uint64_t ratio = place.codec == None ? 1 : kMaxRatio;
    if (place.grid_size / ratio > place.file_size)
      in_.fail("a grid of " + std::to_string(place.grid_size) + " bytes cannot be in " +
               std::to_string(place.file_size) + " bytes of a file");
    GridMemory memory(place.grid_size);
    if (place.codec == None) {
      const std::string_view bytes = in_.take(place.grid_size);
      std::copy(bytes.begin(), bytes.end(), memory.data());
      return memory;
    }
    const std::uint64_t chunk = place.codec == Zip ? place.grid_size : kBloscChunk;
    for (std::uint64_t done = 0; done < place.grid_size;) {
      const std::uint64_t size = std::min(chunk, place.grid_size - done);
      const std::string_view packed = in_.take(in_.read<std::uint64_t>());
      const bool sound = place.codec == Zip ? unpack_zlib(packed, memory.data() + done, size)
                                            : unpack_blosc(packed, memory.data() + done, size);
      if (!sound) in_.fail("a broken packed grid, or not " + std::to_string(size) + " bytes of it");
      done += size;
    }
    return memory;
  }

  static void walk(GridType type, const GridMemory& memory, SparseVoxels& voxels,
                   const std::string& grid_class, std::uint64_t max_values) {
    const auto run = [&]<class Build>(Build*) {
      Walk<Build>(memory, voxels).run(grid_class, max_values);
    };
    switch (type) {
      case GridType::Float: return run(static_cast<float*>(nullptr));
      case GridType::Double: return run(static_cast<double*>(nullptr));
      case GridType::Vec3f: return run(static_cast<nanovdb::Vec3f*>(nullptr));
      case GridType::Vec3d: return run(static_cast<nanovdb::Vec3d*>(nullptr));
      case GridType::Fp4: return run(static_cast<nanovdb::Fp4*>(nullptr));
      case GridType::Fp8: return run(static_cast<nanovdb::Fp8*>(nullptr));
      case GridType::Fp16: return run(static_cast<nanovdb::Fp16*>(nullptr));
      default: return run(static_cast<nanovdb::FpN*>(nullptr));
    }
  }

  static Mat4 index_to_world(const nanovdb::Map& map) {
    Mat4 m(1.0);
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) m[column][row] = map.mMatD[3 * row + column];
      m[3][row] = map.mVecD[row];
    }
    return m;
  }

  ByteCursor in_;
  const std::string& name_;
  std::vector<GridEntry> entries_;
  std::vector<Place> places_;
};

}  // namespace

VdbGrid parse_nanovdb(std::string_view bytes, const std::string& name, const std::string& grid,
                      std::uint64_t max_values) {
  return NanoParser(bytes, name).parse(grid, max_values);
}

}  // namespace fogbow
