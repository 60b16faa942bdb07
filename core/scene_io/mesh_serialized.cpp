// SPDX-License-Identifier: GPL-3.0-or-later
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/scene_io/mesh_file.h"

namespace fogbow {

namespace {

static_assert(std::endian::native == std::endian::little, "the format is little-endian");

constexpr std::uint16_t kMagic = 0x041C;
/// Bits of a mesh's flags, as in Mitsuba's documentation of the format.
constexpr std::uint32_t kNormals = 0x0001, kUvs = 0x0002, kColors = 0x0008, kFaceNormals = 0x0010,
                        kSingle = 0x1000, kDouble = 0x2000;
constexpr std::size_t kMaxName = 1 << 16;
/// Numbers read at a time: memory follows what the file holds, not what it says.
constexpr std::size_t kBlock = 3 << 14;

[[noreturn]] void fail(const std::string& name, const std::string& message) {
  throw Error(ErrorKind::Scene, SourceLocation{name, 0, 0}, message);
}

template <class T>
T read_at(std::string_view bytes, std::size_t at, const std::string& name) {
  T value;
  if (at > bytes.size() || bytes.size() - at < sizeof value) fail(name, "the file ends too early");
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

/// A zlib stream, given out piece by piece.
class Inflater {
 public:
  Inflater(std::string_view bytes, const std::string& name) : rest_(bytes), name_(name) {
    if (inflateInit(&stream_) != Z_OK) throw std::bad_alloc();
  }
  ~Inflater() { inflateEnd(&stream_); }
  Inflater(const Inflater&) = delete;

  void read(void* to, std::size_t size) {
    stream_.next_out = static_cast<Bytef*>(to);
    stream_.avail_out = static_cast<uInt>(size);
    while (stream_.avail_out > 0) {
      if (stream_.avail_in == 0) feed();
      const int status = inflate(&stream_, Z_NO_FLUSH);
      if (status == Z_MEM_ERROR) throw std::bad_alloc();
      const bool ended = status == Z_STREAM_END && stream_.avail_out > 0;
      if (ended || (status != Z_OK && status != Z_STREAM_END && status != Z_BUF_ERROR))
        fail(name_, ended ? "the compressed mesh ends too early" : "a broken compressed mesh");
    }
  }
  template <class T>
  T read() {
    T value;
    read(&value, sizeof value);
    return value;
  }

 private:
  void feed() {
    if (rest_.empty()) fail(name_, "the file ends too early");
    const std::size_t n = std::min<std::size_t>(rest_.size(), 1 << 20);
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(rest_.data()));
    stream_.avail_in = static_cast<uInt>(n);
    rest_.remove_prefix(n);
  }

  z_stream stream_{};
  std::string_view rest_;
  const std::string& name_;
};

class SerializedParser {
 public:
  SerializedParser(std::string_view bytes, const std::string& name, std::int64_t index)
      : bytes_(bytes), name_(name), start_(start_of(index)), in_(bytes.substr(start_ + 4), name) {}

  SerializedMesh parse() {
    const auto flags = in_.read<std::uint32_t>();
    if (version_ >= 4) skip_name();
    if (bool(flags & kSingle) == bool(flags & kDouble))
      fail(name_, "the mesh must be of single or of double precision");
    double_ = flags & kDouble;
    const auto vertices = in_.read<std::uint64_t>(), triangles = in_.read<std::uint64_t>();
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max() / 3;
    if (vertices > kMost || triangles > kMost)
      fail(name_, "the mesh has " + std::to_string(vertices) + " vertices and " +
                      std::to_string(triangles) + " triangles, more than 32 bits can name");
    SerializedMesh result;
    result.face_normals = flags & kFaceNormals;
    TriangleMeshData& mesh = result.mesh;
    read_vectors(vertices, mesh.positions, "position");
    if (flags & kNormals) read_vectors(vertices, mesh.normals, "normal");
    if (flags & kUvs) read_vectors(vertices, mesh.uvs, "texture coordinate");
    std::vector<Vec3> colors;  // nothing asks for them
    if (flags & kColors) read_vectors(vertices, colors, "colour");
    read_triangles(triangles, vertices, mesh);
    return result;
  }

 private:
  /// Also reads the header there; the place of any mesh but the first stands at the end of the
  /// file, with their number last.
  std::size_t start_of(std::int64_t index) {
    read_header(0);
    if (index == 0) return 0;
    const std::uint64_t each = version_ >= 4 ? 8 : 4, size = bytes_.size();
    if (size < 8) fail(name_, "the file ends too early");
    const auto count = read_at<std::uint32_t>(bytes_, size - 4, name_);
    if (count > (size - 4) / each) fail(name_, "the file names more meshes than it can hold");
    if (index < 0 || index >= count)
      fail(name_, "\"shape_index\" is " + std::to_string(index) + ", but the file holds " +
                      std::to_string(count) + " meshes");
    const std::size_t entry = size - 4 - each * (count - static_cast<std::uint64_t>(index));
    const std::uint64_t start = version_ >= 4 ? read_at<std::uint64_t>(bytes_, entry, name_)
                                              : read_at<std::uint32_t>(bytes_, entry, name_);
    if (start > size) fail(name_, "a mesh begins beyond the end of the file");
    read_header(start);
    return start;
  }

  void read_header(std::size_t at) {
    if (read_at<std::uint16_t>(bytes_, at, name_) != kMagic)
      fail(name_, "no mesh in Mitsuba's serialized format begins at byte " + std::to_string(at));
    version_ = read_at<std::uint16_t>(bytes_, at + 2, name_);
    if (version_ != 3 && version_ != 4)
      fail(name_,
           "expected version 3 or 4 of the serialized format, found " + std::to_string(version_));
  }

  void skip_name() {
    for (std::size_t i = 0; in_.read<char>() != '\0'; ++i)
      if (i >= kMaxName) fail(name_, "the name of the mesh is very long");
  }

  template <class T>
  void read_numbers(std::uint64_t count, std::vector<double>& numbers) {
    std::vector<T> raw(count);
    in_.read(raw.data(), count * sizeof(T));
    numbers.assign(raw.begin(), raw.end());
  }

  template <class Vector>
  void read_vectors(std::uint64_t count, std::vector<Vector>& to, const char* what) {
    constexpr std::uint64_t n = Vector::length();
    std::vector<double> numbers;
    while (to.size() < count) {
      const std::uint64_t now = std::min<std::uint64_t>(count - to.size(), kBlock / n);
      double_ ? read_numbers<double>(n * now, numbers) : read_numbers<float>(n * now, numbers);
      for (std::uint64_t i = 0; i < now; ++i) {
        Vector v;
        for (std::uint64_t c = 0; c < n; ++c) {
          v[static_cast<int>(c)] = numbers[n * i + c];
          if (!std::isfinite(numbers[n * i + c]))
            fail(name_, std::string("a ") + what + " is not finite");
        }
        to.push_back(v);
      }
    }
  }

  void read_triangles(std::uint64_t count, std::uint64_t vertices, TriangleMeshData& mesh) {
    std::vector<std::array<std::uint32_t, 3>> block;
    while (mesh.triangles.size() < count) {
      block.resize(std::min<std::uint64_t>(count - mesh.triangles.size(), kBlock / 3));
      in_.read(block.data(), block.size() * sizeof block[0]);
      for (const auto& triangle : block)
        for (const std::uint32_t v : triangle)
          if (v >= vertices)
            fail(name_, "a triangle names vertex " + std::to_string(v) + ", but there are " +
                            std::to_string(vertices));
      mesh.triangles.insert(mesh.triangles.end(), block.begin(), block.end());
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  int version_ = 0;
  std::size_t start_;
  Inflater in_;
  bool double_ = false;
};

}  // namespace

SerializedMesh parse_serialized(std::string_view bytes, const std::string& name,
                                std::int64_t index) {
  return SerializedParser(bytes, name, index).parse();
}

}  // namespace fogbow
