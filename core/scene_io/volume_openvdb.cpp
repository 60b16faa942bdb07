// SPDX-License-Identifier: GPL-3.0-or-later
// The format is that of OpenVDB 10, as far as io/, tree/ and math/Maps.h of its headers write it.
// It is read without that library, which trusts the lengths in a file: where one is wrong it writes
// beyond its buffers. (Its program code and start-up are saved as well.)
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <set>

#include "core/scene_io/byte_cursor.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/sparse_voxels.h"
#include "core/scene_io/unpack.h"

namespace fogbow {

namespace {

using Index = SparseVoxels::Index;

constexpr std::uint64_t kMagic = 0x56444220;
constexpr std::uint32_t kOldestVersion = 222, kNewestVersion = 224;
/// Bits of a grid's compression.
constexpr std::uint32_t kZip = 1, kActiveMask = 2, kBlosc = 4;
/// What a node keeps of its inactive values.
enum NodeCode { Background, MinusBackground, One, MaskNone, MaskOne, MaskTwo, All };
constexpr int kLeafBits = 3, kLowerBits = 4, kUpperBits = 5;
constexpr int kRootSize = 1 << (kLeafBits + kLowerBits + kUpperBits);

struct ValueType {
  int channels = 0;
  bool is_double = false, is_half = false;  ///< halves are what nodes are stored in, no more

  std::size_t bytes() const { return channels * (is_double ? 8 : 4); }
  std::size_t stored_bytes() const { return is_half ? channels * 2 : bytes(); }
};

const std::map<std::string, ValueType>& value_types() {
  static const std::map<std::string, ValueType> types{
      {"float", {1}}, {"double", {1, true}}, {"vec3s", {3}}, {"vec3d", {3, true}}};
  return types;
}

struct Descriptor {
  std::string unique_name, parent;
  std::uint64_t begin = 0;
};

/// "Tree_float_5_4_3_HalfFloat" is "float".
std::string short_type(std::string type) {
  const auto drop_suffix = [&](std::string_view suffix) {
    const bool has = type.ends_with(suffix);
    if (has) type.resize(type.size() - suffix.size());
    return has;
  };
  drop_suffix("_HalfFloat");
  if (type.starts_with("Tree_") && drop_suffix("_5_4_3")) type.erase(0, 5);
  return type;
}

bool is_on(std::string_view mask, std::size_t i) {
  return static_cast<unsigned char>(mask[i / 8]) >> (i % 8) & 1;
}

std::size_t count_on(std::string_view mask) {
  std::size_t result = 0;
  for (const char c : mask) result += std::popcount(static_cast<unsigned char>(c));
  return result;
}

void decode(const char* raw, std::size_t count, const ValueType& type, float* to) {
  const auto each = [&]<class T>(T, const auto& convert) {
    for (std::size_t i = 0; i < count * type.channels; ++i) {
      T value;
      std::memcpy(&value, raw + i * sizeof value, sizeof value);
      to[i] = convert(value);
    }
  };
  const auto plain = [](auto v) { return static_cast<float>(v); };
  if (type.is_half)
    each(std::uint16_t{}, from_half);
  else if (type.is_double)
    each(double{}, plain);
  else
    each(float{}, plain);
}

class VdbParser {
 public:
  VdbParser(std::string_view bytes, const std::string& name) : in_(bytes, name), name_(name) {}

  VdbGrid parse(const std::string& wanted, std::uint64_t max_values) {
    read_header();
    read_contents();
    const std::size_t chosen = choose_grid(entries_, wanted, name_);
    in_.seek(descriptors_[chosen].begin);
    read_grid_head();
    const Mat4 index_to_world = read_map();
    SparseVoxels voxels(name_, entries_[chosen].name, entries_[chosen].channels);
    type_ = value_types().at(entries_[chosen].type);
    if (!descriptors_[chosen].parent.empty()) seek_tree_of(descriptors_[chosen].parent);
    type_.is_half = is_half_;
    read_tree(voxels, max_values);
    return voxels.finish(index_to_world);
  }

 private:
  struct Leaf {
    Index origin;
    std::string_view active;
  };

  void read_header() {
    if (in_.rest() < 8 || in_.read<std::uint64_t>() != kMagic) {
      in_.seek(0);
      in_.fail("expected an OpenVDB file, which begins with \" BDV\"");
    }
    version_ = in_.read<std::uint32_t>();
    if (version_ < kOldestVersion || version_ > kNewestVersion)
      in_.fail("expected version " + std::to_string(kOldestVersion) + " to " +
               std::to_string(kNewestVersion) + " of the format, found " +
               std::to_string(version_));
    in_.take(8);  // of the library that wrote it
    if (in_.read<std::uint8_t>() == 0)
      in_.fail(
          "the file was written as a stream and does not tell where its grids are; write it "
          "with openvdb::io::File");
    in_.take(36);  // UUID
  }

  /// By name: the values as they stand in the file.
  std::map<std::string, std::string_view> read_metadata() {
    std::map<std::string, std::string_view> result;
    for (auto n = in_.read<std::uint32_t>(); n > 0; --n) {
      const std::string name(in_.read_string());
      in_.read_string();  // type
      result[name] = in_.read_string();
    }
    return result;
  }

  void read_contents() {
    read_metadata();
    for (auto n = in_.read<std::uint32_t>(); n > 0; --n) {
      Descriptor descriptor;
      descriptor.unique_name = in_.read_string();
      GridEntry entry;
      // Behind the name there may be a number, separated by a control character.
      entry.name = descriptor.unique_name.substr(0, descriptor.unique_name.find('\x1e'));
      entry.type = short_type(std::string(in_.read_string()));
      if (const auto it = value_types().find(entry.type); it != value_types().end())
        entry.channels = it->second.channels;
      descriptor.parent = in_.read_string();
      descriptor.begin = in_.read<std::uint64_t>();
      in_.take(8);  // place of the leaves' values
      const auto end = in_.read<std::uint64_t>();
      if (descriptor.begin < in_.at() || end < descriptor.begin)
        in_.fail("the grid " + quote(entry.name) + " does not lie behind its description");
      entries_.push_back(std::move(entry));
      descriptors_.push_back(std::move(descriptor));
      in_.seek(end);
    }
    number_names(entries_);
  }

  void read_grid_head() {
    compression_ = in_.read<std::uint32_t>();
    const auto metadata = read_metadata();
    const auto value = [&](const char* name) {
      const auto it = metadata.find(name);
      return it == metadata.end() ? std::string_view() : it->second;
    };
    const std::string_view half = value("is_saved_as_half_float");
    is_half_ = !half.empty() && half[0] != 0;
    class_ = value("class");
    if (class_.empty()) class_ = "unknown";
  }

  /// Instances have a head of their own, and share a tree with the grid that they name.
  void seek_tree_of(const std::string& parent) {
    const auto it = std::find_if(descriptors_.begin(), descriptors_.end(),
                                 [&](const Descriptor& d) { return d.unique_name == parent; });
    if (it == descriptors_.end() || !it->parent.empty() ||
        entries_[it - descriptors_.begin()].channels != type_.channels ||
        value_types().at(entries_[it - descriptors_.begin()].type).is_double != type_.is_double)
      in_.fail("a grid shares the voxels of " + quote(parent) + ", which has none like it");
    in_.seek(it->begin);
    const std::string own_class = class_;
    read_grid_head();
    class_ = own_class;
    read_map();
  }

  /// Vectors are rows in OpenVDB.
  Mat4 read_map() {
    const std::string map(in_.read_string());
    const auto vector = [&] {
      Vec3 v;
      for (int i = 0; i < 3; ++i) v[i] = in_.read<double>();
      return v;
    };
    Mat4 m(1.0);
    if (map == "AffineMap" || map == "UnitaryMap") {
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) m[row][column] = in_.read<double>();
      return m;
    }
    const bool translates = map == "TranslationMap" || map.ends_with("ScaleTranslateMap");
    const bool scales = map.ends_with("ScaleMap") || map.ends_with("ScaleTranslateMap");
    const std::string_view rest = std::string_view(map).substr(map.starts_with("Uniform") ? 7 : 0);
    if (rest != "TranslationMap" && rest != "ScaleMap" && rest != "ScaleTranslateMap")
      in_.fail("the map from indices to the world is " + quote(map) +
               (map == "NonlinearFrustumMap" ? ", a frustum" : "") + ": only affine maps are read");
    if (translates) m[3] = Vec4(vector(), 1.0);
    if (scales) {
      const Vec3 scale = vector();
      for (int i = 0; i < 3; ++i) m[i][i] = scale[i];
      in_.take(4 * 3 * sizeof(double));  // what follows from the scale
    }
    return m;
  }

  void read_tree(SparseVoxels& voxels, std::uint64_t max_values) {
    if (const auto buffers = in_.read<std::uint32_t>(); buffers != 1)
      in_.fail("expected one buffer a tree, found " + std::to_string(buffers));
    const std::size_t root = in_.at();
    float background[3] = {};
    read_value(background);
    voxels.check_kind(class_, background);
    in_.seek(root);
    read_root(voxels);
    voxels.allocate(max_values);
    leaves_.clear();
    in_.seek(root);
    read_root(voxels);
    for (const Leaf& leaf : leaves_) {
      const std::string_view active = in_.take(leaf.active.size());
      read_values(active, 1 << (3 * kLeafBits));
      voxels.fill_leaf(leaf.origin, values_.data());
    }
  }

  Index read_root_origin(std::set<Index>& known) {
    Index origin;
    for (std::int64_t& i : origin) {
      i = in_.read<std::int32_t>();
      if (i % kRootSize != 0)
        in_.fail("a node at " + std::to_string(i) + ", which is no multiple of " +
                 std::to_string(kRootSize));
    }
    if (!known.insert(origin).second) in_.fail("two nodes at the same place");
    return origin;
  }

  void read_root(SparseVoxels& voxels) {
    float value[3] = {};
    read_value(value);  // the background
    const auto tiles = in_.read<std::uint32_t>(), children = in_.read<std::uint32_t>();
    std::set<Index> known;
    for (std::uint32_t i = 0; i < tiles; ++i) {
      const Index origin = read_root_origin(known);
      read_value(value);
      voxels.tile(origin, kRootSize, in_.read<std::uint8_t>() != 0, value);
    }
    Index last{};
    for (std::uint32_t i = 0; i < children; ++i) {
      const Index origin = read_root_origin(known);
      // The values of leaves follow in the order of places, whatever the order here.
      if (i > 0 && !(last < origin)) in_.fail("nodes are not in the order of their places");
      last = origin;
      read_node<kUpperBits, kLeafBits + kLowerBits>(voxels, origin);
    }
  }

  /// Of 2^(3 kBits) children, each with 2^kChildBits voxels a side.
  template <int kBits, int kChildBits>
  void read_node(SparseVoxels& voxels, const Index& origin) {
    constexpr std::size_t kCount = 1 << (3 * kBits);
    const std::string_view children = in_.take(kCount / 8), active = in_.take(kCount / 8);
    read_values(active, kCount);
    const auto place = [&](std::size_t i) {
      constexpr std::size_t kMask = (1 << kBits) - 1;
      return Index{origin[0] + static_cast<std::int64_t>(i >> (2 * kBits) << kChildBits),
                   origin[1] + static_cast<std::int64_t>((i >> kBits & kMask) << kChildBits),
                   origin[2] + static_cast<std::int64_t>((i & kMask) << kChildBits)};
    };
    for (std::size_t i = 0; i < kCount; ++i)
      if (!is_on(children, i))
        voxels.tile(place(i), 1 << kChildBits, is_on(active, i), &values_[i * type_.channels]);
    for (std::size_t i = 0; i < kCount; ++i) {
      if (!is_on(children, i)) continue;
      if constexpr (kChildBits > kLeafBits)
        read_node<kLowerBits, kLeafBits>(voxels, place(i));
      else
        read_leaf(voxels, place(i));
    }
  }

  void read_leaf(SparseVoxels& voxels, const Index& origin) {
    SparseVoxels::LeafMask active;
    const std::string_view bytes = in_.take(sizeof active);
    std::memcpy(active.data(), bytes.data(), sizeof active);
    voxels.cover_leaf(origin, active);
    leaves_.push_back({origin, bytes});
  }

  void read_value(float* to) {
    ValueType whole = type_;
    whole.is_half = false;
    decode(in_.take(whole.bytes()).data(), 1, whole, to);
  }

  /// To `values_`: those of a node, of which only the active ones may be stored.
  void read_values(std::string_view active, std::size_t count) {
    const int code = in_.read<std::uint8_t>();
    if (code > All) in_.fail("a node keeps its values in the unknown way " + std::to_string(code));
    float inactive[2][3] = {};  // the background is zero
    if (code == One || code == MaskOne || code == MaskTwo) read_value(inactive[0]);
    if (code == MaskTwo) read_value(inactive[1]);
    std::string_view selection;
    if (code == MaskNone || code == MaskOne || code == MaskTwo) selection = in_.take(count / 8);
    const bool packed = (compression_ & kActiveMask) && code != All;
    const std::size_t stored = packed ? count_on(active) : count;
    values_.resize(count * type_.channels);
    read_data(stored);
    if (stored == count) return;
    // From the back, so that none is overwritten before it has moved.
    for (std::size_t i = count, next = stored; i-- > 0;) {
      const float* from = is_on(active, i) ? &values_[--next * type_.channels]
                                           : inactive[!selection.empty() && is_on(selection, i)];
      float* to = &values_[i * type_.channels];
      if (from != to) std::copy(from, from + type_.channels, to);
    }
  }

  /// To the front of `values_`.
  void read_data(std::size_t count) {
    if (count == 0 && type_.is_half) return;
    const std::size_t size = count * type_.stored_bytes();
    if (!(compression_ & (kZip | kBlosc))) {
      decode(in_.take(size).data(), count, type_, values_.data());
      return;
    }
    const auto length = in_.read<std::int64_t>();
    if (length <= 0) {  // stored as it is
      if (0 - static_cast<std::uint64_t>(length) != size)
        in_.fail("expected " + std::to_string(size) + " bytes, found " + std::to_string(length));
      decode(in_.take(size).data(), count, type_, values_.data());
      return;
    }
    const std::string_view packed = in_.take(static_cast<std::uint64_t>(length));
    unpacked_.resize(size);
    const bool sound = compression_ & kBlosc ? unpack_blosc(packed, unpacked_.data(), size)
                                             : unpack_zlib(packed, unpacked_.data(), size);
    if (!sound)
      in_.fail("broken compressed values, or not " + std::to_string(size) + " bytes of them");
    decode(unpacked_.data(), count, type_, values_.data());
  }

  ByteCursor in_;
  const std::string& name_;
  std::uint32_t version_ = 0, compression_ = 0;
  std::vector<GridEntry> entries_;
  std::vector<Descriptor> descriptors_;
  std::string class_;
  bool is_half_ = false;
  ValueType type_;
  std::vector<Leaf> leaves_;
  std::vector<float> values_;
  std::string unpacked_;
};

}  // namespace

VdbGrid parse_vdb(std::string_view bytes, const std::string& name, const std::string& grid,
                  std::uint64_t max_values) {
  return VdbParser(bytes, name).parse(grid, max_values);
}

}  // namespace fogbow
