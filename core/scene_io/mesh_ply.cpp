// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/mesh_attributes.h"
#include "core/scene_io/mesh_file.h"
#include "core/scene_io/parse_values.h"

namespace fogbow {

namespace {

enum class Scalar { Int8, Uint8, Int16, Uint16, Int32, Uint32, Float32, Float64 };
enum class Format { Ascii, LittleEndian, BigEndian };

std::size_t size_of(Scalar type) {
  static constexpr std::array<std::size_t, 8> kSizes{1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes[static_cast<std::size_t>(type)];
}

bool is_float(Scalar type) { return type == Scalar::Float32 || type == Scalar::Float64; }

std::optional<Scalar> scalar_named(std::string_view name) {
  struct Entry {
    std::string_view name;
    Scalar type;
  };
  static constexpr std::array<Entry, 16> kTable{{{"char", Scalar::Int8},
                                                 {"int8", Scalar::Int8},
                                                 {"uchar", Scalar::Uint8},
                                                 {"uint8", Scalar::Uint8},
                                                 {"short", Scalar::Int16},
                                                 {"int16", Scalar::Int16},
                                                 {"ushort", Scalar::Uint16},
                                                 {"uint16", Scalar::Uint16},
                                                 {"int", Scalar::Int32},
                                                 {"int32", Scalar::Int32},
                                                 {"uint", Scalar::Uint32},
                                                 {"uint32", Scalar::Uint32},
                                                 {"float", Scalar::Float32},
                                                 {"float32", Scalar::Float32},
                                                 {"double", Scalar::Float64},
                                                 {"float64", Scalar::Float64}}};
  for (const Entry& e : kTable)
    if (e.name == name) return e.type;
  return std::nullopt;
}

struct PlyProperty {
  std::string name;
  Scalar type{};
  std::optional<Scalar> count_type;  ///< of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  /// Fewest bytes that one can take in the file.
  std::size_t min_bytes(Format format) const {
    std::size_t result = 0;
    for (const PlyProperty& p : properties)
      result += format == Format::Ascii ? 2 : size_of(p.count_type.value_or(p.type));
    return result;
  }
  /// Index of the first of these properties that there is, −1 if none.
  int find(std::initializer_list<std::string_view> names) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
      for (const std::string_view name : names)
        if (properties[i].name == name) return static_cast<int>(i);
    return -1;
  }
};

class PlyParser {
 public:
  PlyParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  TriangleMeshData parse() {
    read_header();
    for (const PlyElement& element : elements_) {
      check_count(element);
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face" && element.find({"vertex_indices", "vertex_index"}) >= 0)
        read_faces(element);
      else
        for (std::uint64_t i = 0; i < element.count; ++i) read_row(element, -1);
    }
    if (mesh_.triangles.empty()) throw Error(ErrorKind::Scene, {name_, 0, 0}, "no faces");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    if (format_ == Format::Ascii)
      throw Error(ErrorKind::Scene, {name_, line_, static_cast<int>(at_ - line_start_) + 1},
                  message);
    throw Error(ErrorKind::Scene, {name_, 0, 0},
                message + " (at byte " + std::to_string(at_) + ")");
  }

  // Text, of the header and of ascii files.

  void skip_space() {
    for (; at_ < bytes_.size(); ++at_) {
      const char c = bytes_[at_];
      if (c == '\n') {
        ++line_;
        line_start_ = at_ + 1;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        return;
      }
    }
  }

  /// The next header line in words; the cursor stays at its start until advance_line().
  std::vector<std::string_view> header_words() const {
    const std::size_t end = bytes_.find('\n', at_);
    constexpr std::size_t kMaxLine = 4096;
    if (end == std::string_view::npos || end - at_ > kMaxLine)
      fail("the header ends without \"end_header\"");
    std::vector<std::string_view> words;
    std::string_view line = bytes_.substr(at_, end - at_);
    for (;;) {
      line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
      if (line.empty()) return words;
      words.push_back(line.substr(0, line.find_first_of(" \t\r")));
      line.remove_prefix(words.back().size());
    }
  }
  void advance_line() {
    at_ = bytes_.find('\n', at_) + 1;
    line_start_ = at_;
    ++line_;
  }

  void read_header() {
    if (const auto words = header_words(); words.size() != 1 || words[0] != "ply")
      fail("expected \"ply\" as the first line");
    advance_line();
    std::optional<Format> format;
    for (;; advance_line()) {
      const auto words = header_words();
      if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
      if (words[0] == "end_header") break;
      if (words[0] == "format")
        format = read_format(words);
      else if (words[0] == "element")
        read_element(words);
      else if (words[0] == "property")
        read_property(words);
      else
        fail("unknown header line " + quote(words[0]));
    }
    if (!format) fail("the header names no format");
    advance_line();
    format_ = *format;
  }

  Format read_format(const std::vector<std::string_view>& words) const {
    if (words.size() == 3 && words[2] == "1.0") {
      if (words[1] == "ascii") return Format::Ascii;
      if (words[1] == "binary_little_endian") return Format::LittleEndian;
      if (words[1] == "binary_big_endian") return Format::BigEndian;
    }
    fail("expected format \"ascii\", \"binary_little_endian\" or \"binary_big_endian\" 1.0");
  }

  void read_element(const std::vector<std::string_view>& words) {
    constexpr std::size_t kMaxElements = 64;
    if (words.size() != 3) fail("expected \"element NAME COUNT\"");
    PlyElement element{std::string(words[1]), 0, {}};
    const char* end = words[2].data() + words[2].size();
    const auto [stop, error] = std::from_chars(words[2].data(), end, element.count);
    if (error != std::errc() || stop != end)
      fail("expected a number of elements, found " + quote(words[2]));
    for (const PlyElement& other : elements_)
      if (other.name == element.name) fail("a second element " + quote(element.name));
    if (elements_.size() >= kMaxElements) fail("too many elements");
    elements_.push_back(std::move(element));
  }

  void read_property(const std::vector<std::string_view>& words) {
    constexpr std::size_t kMaxProperties = 256;
    if (elements_.empty()) fail("a property before the first element");
    const bool list = words.size() == 5 && words[1] == "list";
    if (!list && words.size() != 3) fail("expected \"property TYPE NAME\" or a list");
    PlyProperty property;
    const auto type = scalar_named(words[list ? 3 : 1]);
    if (!type) fail("unknown type " + quote(words[list ? 3 : 1]));
    property.type = *type;
    if (list) {
      property.count_type = scalar_named(words[2]);
      if (!property.count_type || is_float(*property.count_type))
        fail("expected a type of whole numbers for the length of a list, found " + quote(words[2]));
    }
    property.name = words.back();
    auto& properties = elements_.back().properties;
    for (const PlyProperty& other : properties)
      if (other.name == property.name) fail("a second property " + quote(property.name));
    if (properties.size() >= kMaxProperties) fail("too many properties");
    properties.push_back(std::move(property));
  }

  void check_count(const PlyElement& element) const {
    if (element.count == 0) return;
    if (element.properties.empty()) fail("element " + quote(element.name) + " has no properties");
    // The last number of an ascii file needs no space behind it.
    const std::uint64_t available = bytes_.size() - at_ + (format_ == Format::Ascii ? 1 : 0);
    if (element.count > available / element.min_bytes(format_))
      fail("the header promises " + std::to_string(element.count) + " of element " +
           quote(element.name) + ", more than the rest of the file can hold");
  }

  // Values.

  double read_value(Scalar type) {
    if (format_ == Format::Ascii) return read_ascii(type);
    const std::size_t size = size_of(type);
    if (bytes_.size() - at_ < size) fail("the file ends too early");
    std::array<char, 8> raw{};
    std::memcpy(raw.data(), bytes_.data() + at_, size);
    if ((format_ == Format::BigEndian) != (std::endian::native == std::endian::big))
      std::reverse(raw.begin(), raw.begin() + static_cast<std::ptrdiff_t>(size));
    at_ += size;
    switch (type) {
      case Scalar::Int8: return read_as<std::int8_t>(raw);
      case Scalar::Uint8: return read_as<std::uint8_t>(raw);
      case Scalar::Int16: return read_as<std::int16_t>(raw);
      case Scalar::Uint16: return read_as<std::uint16_t>(raw);
      case Scalar::Int32: return read_as<std::int32_t>(raw);
      case Scalar::Uint32: return read_as<std::uint32_t>(raw);
      case Scalar::Float32: return read_as<float>(raw);
      case Scalar::Float64: break;
    }
    return read_as<double>(raw);
  }
  template <class T>
  static double read_as(const std::array<char, 8>& raw) {
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return static_cast<double>(value);
  }

  double read_ascii(Scalar type) {
    skip_space();
    std::string_view rest = bytes_.substr(at_);
    double value = 0;
    if (rest.empty()) fail("the file ends too early");
    if (!consume_number(rest, value) ||
        (!rest.empty() && rest[0] != ' ' && rest[0] != '\t' && rest[0] != '\r' && rest[0] != '\n'))
      fail("expected a finite number, found " +
           quote(bytes_.substr(at_, bytes_.find_first_of(" \t\r\n", at_) - at_)));
    constexpr double kMostWhole = 4294967295;  // of the widest type there is
    if (!is_float(type) && value != std::floor(value)) fail("expected a whole number");
    if (!is_float(type) && std::abs(value) > kMostWhole) fail("no type holds so large a number");
    at_ = bytes_.size() - rest.size();
    return value;
  }

  /// Length of a list, checked against what is left of the file.
  std::uint64_t read_count(const PlyProperty& property) {
    const double count = read_value(*property.count_type);
    const std::size_t each = format_ == Format::Ascii ? 2 : size_of(property.type);
    if (count < 0 || count > static_cast<double>((bytes_.size() - at_ + 1) / each))
      fail("a list longer than the rest of the file, or of negative length");
    return static_cast<std::uint64_t>(count);
  }

  /// Reads one element: scalars into row_, the list property `list` into list_.
  void read_row(const PlyElement& element, int list) {
    row_.resize(element.properties.size());
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const PlyProperty& property = element.properties[i];
      if (!property.count_type) {
        row_[i] = read_value(property.type);
        continue;
      }
      const std::uint64_t count = read_count(property);
      const bool wanted = static_cast<int>(i) == list;
      if (wanted) list_.clear();
      for (std::uint64_t j = 0; j < count; ++j) {
        const double value = read_value(property.type);
        if (wanted) list_.push_back(value);
      }
    }
  }

  static std::vector<AttributeColumns> attributes_of(const PlyElement& element, bool of_faces) {
    std::vector<std::string> names;
    for (const PlyProperty& p : element.properties) names.push_back(p.count_type ? "" : p.name);
    return attribute_columns(names, of_faces);
  }
  void keep(std::vector<AttributeColumns>& attributes) {
    for (AttributeColumns& a : attributes) {
      for (const float value : a.attribute.values)
        if (!std::isfinite(value)) fail("a value of " + quote(a.attribute.name) + " is not finite");
      mesh_.attributes.push_back(std::move(a.attribute));
    }
  }

  double column(int index) const { return row_[static_cast<std::size_t>(index)]; }
  void require_finite(double a, double b, double c, const char* what) const {
    if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(c))
      fail(std::string("a ") + what + " is not finite");
  }

  void read_vertices(const PlyElement& element) {
    const std::array<int, 3> p{element.find({"x"}), element.find({"y"}), element.find({"z"})};
    const std::array<int, 3> n{element.find({"nx"}), element.find({"ny"}), element.find({"nz"})};
    const std::array<int, 2> uv{element.find({"u", "s", "texture_u"}),
                                element.find({"v", "t", "texture_v"})};
    if (p[0] < 0 || p[1] < 0 || p[2] < 0) fail("vertices need the properties x, y and z");
    for (const int i : {p[0], p[1], p[2], n[0], n[1], n[2], uv[0], uv[1]})
      if (i >= 0 && element.properties[static_cast<std::size_t>(i)].count_type)
        fail("a coordinate of a vertex is a list");
    if (element.count > ~std::uint32_t{0}) fail("more than 2^32 vertices");
    const bool normals = n[0] >= 0 && n[1] >= 0 && n[2] >= 0, uvs = uv[0] >= 0 && uv[1] >= 0;
    mesh_.positions.reserve(element.count);
    if (normals) mesh_.normals.reserve(element.count);
    if (uvs) mesh_.uvs.reserve(element.count);
    std::vector<AttributeColumns> attributes = attributes_of(element, false);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element, -1);
      mesh_.positions.emplace_back(column(p[0]), column(p[1]), column(p[2]));
      require_finite(column(p[0]), column(p[1]), column(p[2]), "position");
      if (normals) {
        mesh_.normals.emplace_back(column(n[0]), column(n[1]), column(n[2]));
        require_finite(column(n[0]), column(n[1]), column(n[2]), "normal");
      }
      if (uvs) {
        mesh_.uvs.emplace_back(column(uv[0]), column(uv[1]));
        require_finite(column(uv[0]), column(uv[1]), 0, "texture coordinate");
      }
      for (AttributeColumns& a : attributes) a.take(row_);
    }
    keep(attributes);
  }

  void read_faces(const PlyElement& element) {
    const int list = element.find({"vertex_indices", "vertex_index"});
    const PlyProperty& indices = element.properties[static_cast<std::size_t>(list)];
    if (!indices.count_type || is_float(indices.type))
      fail("the vertices of a face must be a list of whole numbers");
    double vertex_count = 0;
    for (const PlyElement& other : elements_)
      if (other.name == "vertex") vertex_count = static_cast<double>(other.count);
    mesh_.triangles.reserve(element.count);
    std::vector<AttributeColumns> attributes = attributes_of(element, true);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      read_row(element, list);
      if (list_.size() < 3) fail("a face needs three vertices");
      for (const double index : list_)
        if (index < 0 || index >= vertex_count)
          fail("a face names vertex " + std::to_string(static_cast<std::int64_t>(index)) +
               ", but there are " + std::to_string(static_cast<std::int64_t>(vertex_count)));
      for (std::size_t j = 2; j < list_.size(); ++j) {
        mesh_.triangles.push_back({static_cast<std::uint32_t>(list_[0]),
                                   static_cast<std::uint32_t>(list_[j - 1]),
                                   static_cast<std::uint32_t>(list_[j])});
        for (AttributeColumns& a : attributes) a.take(row_);
      }
    }
    keep(attributes);
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0, line_start_ = 0;
  int line_ = 1;
  Format format_ = Format::Ascii;
  std::vector<PlyElement> elements_;
  std::vector<double> row_, list_;
  TriangleMeshData mesh_;
};

}  // namespace

TriangleMeshData parse_ply(std::string_view bytes, const std::string& name) {
  return PlyParser(bytes, name).parse();
}

}  // namespace fogbow
