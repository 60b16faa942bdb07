// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <charconv>
#include <cstdint>
#include <unordered_map>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/mesh_file.h"
#include "core/scene_io/parse_values.h"

namespace fogbow {

namespace {

/// Indices into the lists of positions, texture coordinates and normals; −1 where left out.
using Corner = std::array<std::int64_t, 3>;

struct CornerHash {
  std::size_t operator()(const Corner& c) const {
    std::uint64_t h = 0;
    for (const std::int64_t i : c) {
      h = (h ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
      h ^= h >> 32;
    }
    return h;
  }
};

class ObjParser {
 public:
  ObjParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  TriangleMeshData parse() {
    while (at_ < text_.size()) {
      const std::size_t end = std::min(text_.find('\n', at_), text_.size());
      line_ = text_.substr(at_, end - at_);
      ++line_number_;
      parse_line(line_);
      at_ = end + 1;
    }
    if (mesh_.triangles.empty()) throw Error(ErrorKind::Scene, {name_, 0, 0}, "no faces");
    if (!any_normal_) mesh_.normals.clear();
    if (!any_uv_) mesh_.uvs.clear();
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(std::string_view rest, const std::string& message) const {
    const auto column = static_cast<int>(line_.size() - rest.size()) + 1;
    throw Error(ErrorKind::Scene, {name_, line_number_, column}, message);
  }

  static void skip_space(std::string_view& rest) {
    while (!rest.empty() && (rest[0] == ' ' || rest[0] == '\t' || rest[0] == '\r'))
      rest.remove_prefix(1);
  }

  void parse_line(std::string_view rest) {
    skip_space(rest);
    const std::string_view key = rest.substr(0, rest.find_first_of(" \t\r"));
    if (key != "v" && key != "vt" && key != "vn" && key != "f") return;
    rest.remove_prefix(key.size());
    if (key == "v")
      positions_.push_back(read_triple(rest));
    else if (key == "vt")
      read_uv(rest);
    else if (key == "vn")
      normals_.push_back(read_triple(rest));
    else
      read_face(rest);
  }

  double read_number(std::string_view& rest) const {
    skip_space(rest);
    double value = 0;
    if (!consume_number(rest, value))
      fail(rest, "expected a finite number, found " + quote(rest.substr(0, rest.find(' '))));
    if (!rest.empty() && rest[0] != ' ' && rest[0] != '\t' && rest[0] != '\r')
      fail(rest, "expected space after a number, found " + quote(rest));
    return value;
  }

  Vec3 read_triple(std::string_view& rest) const {
    Vec3 result;
    for (int i = 0; i < 3; ++i) result[i] = read_number(rest);
    return result;
  }

  void read_uv(std::string_view rest) {
    const double u = read_number(rest);
    skip_space(rest);
    uvs_.push_back({u, rest.empty() ? 0.0 : read_number(rest)});
  }

  /// One of v, v/vt, v//vn and v/vt/vn; from 1, or negative from the end.
  Corner read_corner(std::string_view& rest) const {
    Corner corner{-1, -1, -1};
    const std::array<std::size_t, 3> sizes{positions_.size(), uvs_.size(), normals_.size()};
    static constexpr std::array<const char*, 3> kWhat{"vertex", "texture coordinate", "normal"};
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0) {
        if (rest.empty() || rest[0] != '/') break;
        rest.remove_prefix(1);
        if (i == 1 && !rest.empty() && rest[0] == '/') continue;
      }
      std::int64_t index = 0;
      const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), index);
      const auto size = static_cast<std::int64_t>(sizes[i]);
      if (error == std::errc::invalid_argument)
        fail(rest, "expected the index of a " + std::string(kWhat[i]) + ", found " + quote(rest));
      if (error != std::errc() || index == 0 || index > size || index < -size)
        fail(rest, "index of a " + std::string(kWhat[i]) + " out of range: there are " +
                       std::to_string(size) + " so far");
      corner[i] = index > 0 ? index - 1 : size + index;
      rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
    }
    if (!rest.empty() && rest[0] != ' ' && rest[0] != '\t' && rest[0] != '\r')
      fail(rest, "expected space after the corner of a face, found " + quote(rest));
    return corner;
  }

  std::uint32_t vertex(const Corner& corner, std::string_view rest) {
    const auto [it, added] =
        vertices_.try_emplace(corner, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (!added) return it->second;
    if (mesh_.positions.size() >= ~std::uint32_t{0}) fail(rest, "more than 2^32 vertices");
    mesh_.positions.push_back(positions_[static_cast<std::size_t>(corner[0])]);
    any_uv_ = any_uv_ || corner[1] >= 0;
    any_normal_ = any_normal_ || corner[2] >= 0;
    mesh_.uvs.push_back(corner[1] < 0 ? Vec2(0) : uvs_[static_cast<std::size_t>(corner[1])]);
    mesh_.normals.push_back(corner[2] < 0 ? Vec3(0)
                                          : normals_[static_cast<std::size_t>(corner[2])]);
    return it->second;
  }

  void read_face(std::string_view rest) {
    std::array<std::uint32_t, 3> triangle{};
    int corners = 0;
    for (skip_space(rest); !rest.empty() && rest[0] != '#'; skip_space(rest)) {
      const std::uint32_t index = vertex(read_corner(rest), rest);
      if (corners < 3) {
        triangle[static_cast<std::size_t>(corners)] = index;
      } else {
        triangle[1] = triangle[2];
        triangle[2] = index;
      }
      if (++corners >= 3) mesh_.triangles.push_back(triangle);
    }
    if (corners < 3) fail(rest, "a face needs three corners, found " + std::to_string(corners));
  }

  std::string_view text_, line_;
  const std::string& name_;
  std::size_t at_ = 0;
  int line_number_ = 0;
  std::vector<Vec3> positions_, normals_;
  std::vector<Vec2> uvs_;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
  bool any_uv_ = false, any_normal_ = false;
  TriangleMeshData mesh_;
};

}  // namespace

TriangleMeshData parse_obj(std::string_view text, const std::string& name) {
  return ObjParser(text, name).parse();
}

}  // namespace fogbow
