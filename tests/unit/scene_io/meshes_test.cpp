// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <initializer_list>

#include "core/scene_io/mesh_file.h"

namespace fogbow {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

std::string error_of(TriangleMeshData (*parse)(std::string_view, const std::string&),
                     const std::string& bytes) {
  try {
    parse(bytes, "m");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::Scene);
    EXPECT_EQ(error.where().file, "m");
    return error.what();
  }
  ADD_FAILURE() << bytes;
  return {};
}

/// Appends a number in one byte order.
template <class T>
void put(std::string& out, T value, bool big) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof value);
  if (big) std::reverse(raw, raw + sizeof value);
  out.append(raw, sizeof value);
}

TEST(Ply, AsciiWithAllThatMayStandInIt) {
  const auto mesh = parse_ply(
      "ply\r\nformat ascii 1.0\ncomment made by hand\nobj_info x y z\n"
      "element vertex 4\nproperty float z\nproperty uchar red\nproperty double x\nproperty float "
      "y\n"
      "property float nz\nproperty float ny\nproperty float nx\nproperty float s\nproperty float "
      "t\n"
      "element edge 1\nproperty list uchar int stuff\nproperty int a\n"
      "element face 2\nproperty uchar flags\nproperty list uchar uint vertex_indices\n"
      "property list int float texcoord\nend_header\n"
      "0 255 1 2 1 0 0 .5 .25\n3 0 4 5 0 1 0 0 1\n6 0 7 8 0 0 1 1 0\n-1e1 0 +1 -.5 1 0 0 0 0\n"
      "3 1 2 3 4\n"
      "7 3 0 1 2 2 0.5 0.5\n0 4 3 2\n1 0 0\n",
      "m");
  const std::vector<Vec3> positions{{1, 2, 0}, {4, 5, 3}, {7, 8, 6}, {1, -0.5, -10}};
  const std::vector<Vec3> normals{{0, 0, 1}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}};
  EXPECT_EQ(mesh.positions, positions);
  EXPECT_EQ(mesh.normals, normals);
  EXPECT_EQ(mesh.uvs[0], Vec2(0.5, 0.25));
  const std::vector<Triangle> triangles{{0, 1, 2}, {3, 2, 1}, {3, 1, 0}};
  EXPECT_EQ(mesh.triangles, triangles);
}

/// A file with every type of number, for both byte orders.
std::string binary_ply(bool big) {
  std::string out = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                    "_endian 1.0\nelement vertex 3\nproperty double x\nproperty short y\n"
                    "property float z\nproperty ushort skip\nproperty char u\nproperty uint8 v\n"
                    "element other 2\nproperty list ushort int16 l\nproperty uint32 w\n"
                    "element face 1\nproperty list uint16 int vertex_index\nend_header\n";
  for (int i = 0; i < 3; ++i) {
    put<double>(out, 0.5 + i, big);
    put<std::int16_t>(out, static_cast<std::int16_t>(-2 * i), big);
    put<float>(out, 3.25f * static_cast<float>(i * i), big);
    put<std::uint16_t>(out, 9, big);
    put<std::int8_t>(out, static_cast<std::int8_t>(-i), big);
    put<std::uint8_t>(out, static_cast<std::uint8_t>(200 + i), big);
  }
  for (int i = 0; i < 2; ++i) {
    put<std::uint16_t>(out, static_cast<std::uint16_t>(i), big);
    if (i == 1) put<std::int16_t>(out, 4, big);
    put<std::uint32_t>(out, 5, big);
  }
  put<std::uint16_t>(out, 3, big);
  for (const int index : {2, 0, 1}) put<std::int32_t>(out, index, big);
  return out;
}

TEST(Ply, BinaryInBothByteOrders) {
  for (const bool big : {false, true}) {
    const auto mesh = parse_ply(binary_ply(big), "m");
    const std::vector<Vec3> positions{{0.5, 0, 0}, {1.5, -2, 3.25}, {2.5, -4, 13}};
    EXPECT_EQ(mesh.positions, positions);
    EXPECT_TRUE(mesh.normals.empty());
    const std::vector<Vec2> uvs{{0, 200}, {-1, 201}, {-2, 202}};
    EXPECT_EQ(mesh.uvs, uvs);
    EXPECT_EQ(mesh.triangles, std::vector<Triangle>{(Triangle{2, 0, 1})});
  }
}

/// Whole numbers near the end of their types, where one taken for another of its size shows.
TEST(Ply, WholeNumbersKeepTheirSign) {
  for (const bool big : {false, true}) {
    std::string bytes = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                        "_endian 1.0\nelement vertex 3\nproperty char x\nproperty uchar y\n"
                        "property short z\nproperty ushort nx\nproperty int ny\nproperty uint nz\n"
                        "element face 1\nproperty list uchar ushort vertex_indices\nend_header\n";
    for (int i = 0; i < 3; ++i) {
      put<std::int8_t>(bytes, -100, big);
      put<std::uint8_t>(bytes, 200, big);
      put<std::int16_t>(bytes, -30000, big);
      put<std::uint16_t>(bytes, 60000, big);
      put<std::int32_t>(bytes, -2000000000, big);
      put<std::uint32_t>(bytes, 4000000000u, big);
    }
    put<std::uint8_t>(bytes, 3, big);
    for (const std::uint16_t index : {0, 1, 2}) put<std::uint16_t>(bytes, index, big);
    const auto mesh = parse_ply(bytes, "m");
    EXPECT_EQ(mesh.positions[1], Vec3(-100, 200, -30000));
    EXPECT_EQ(mesh.normals[1], Vec3(60000, -2e9, 4e9));
  }
}

TEST(Ply, EveryTruncationOfABinaryFileIsAnError) {
  for (const bool big : {false, true}) {
    const std::string whole = binary_ply(big);
    for (std::size_t n = 0; n < whole.size(); ++n) error_of(parse_ply, whole.substr(0, n));
  }
}

TEST(Ply, ErrorsNameTheirPlace) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(error_of(parse_ply, ""), "m:1:1: the header ends without \"end_header\"");
  EXPECT_EQ(error_of(parse_ply, "plx\n"), "m:1:1: expected \"ply\" as the first line");
  EXPECT_EQ(error_of(parse_ply, "ply\nformat ascii 2.0\n").substr(0, 14), "m:2:1: expecte");
  EXPECT_EQ(error_of(parse_ply, "ply\nelement vertex -1\n"),
            "m:2:1: expected a number of elements, found \"-1\"");
  EXPECT_EQ(error_of(parse_ply, "ply\nproperty float x\n"),
            "m:2:1: a property before the first element");
  EXPECT_EQ(error_of(parse_ply, "ply\nelement v 1\nproperty half x\n"),
            "m:3:1: unknown type \"half\"");
  EXPECT_EQ(error_of(parse_ply, "ply\nelement v 1\nproperty list float int x\n").substr(0, 15),
            "m:3:1: expected");
  EXPECT_EQ(error_of(parse_ply, "ply\nelement v 1\nelement v 1\n"),
            "m:3:1: a second element \"v\"");
  EXPECT_EQ(error_of(parse_ply, "ply\nelement v 1\nproperty int a\nproperty int a\n"),
            "m:4:1: a second property \"a\"");
  EXPECT_EQ(error_of(parse_ply, "ply\nend_header\n"), "m:2:1: the header names no format");
  EXPECT_EQ(error_of(parse_ply, "ply\nformat ascii 1.0\nend_header\n"), "m: no faces");
  EXPECT_EQ(error_of(parse_ply, head + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"),
            "m:11:3: expected a finite number, found \"nan\"");
  EXPECT_EQ(error_of(parse_ply, head + "0 0 0\n1 0 0\n0 1 0\n"), "m:13:1: the file ends too early");
  EXPECT_EQ(error_of(parse_ply, head + vertices + "3 0 1 3\n"),
            "m:13:8: a face names vertex 3, but there are 3");
  EXPECT_EQ(error_of(parse_ply, head + vertices + "3 0 1 -1\n"),
            "m:13:9: a face names vertex -1, but there are 3");
  EXPECT_EQ(error_of(parse_ply, head + vertices + "2 0 1 1\n"),
            "m:13:6: a face needs three vertices");
  EXPECT_EQ(error_of(parse_ply, head + vertices + "3 0 1 1.5\n"),
            "m:13:7: expected a whole number");
  for (const char* index : {"1e72", "-1e72", "4294967296"})
    EXPECT_EQ(error_of(parse_ply, head + vertices + "3 0 " + index + " 2\n"),
              "m:13:5: no type holds so large a number");
  EXPECT_EQ(error_of(parse_ply, head + vertices + "-3 0 1 2\n").substr(0, 26),
            "m:13:3: a list longer than");
  EXPECT_EQ(error_of(parse_ply, head + vertices + "255 0 1 2\n").substr(0, 26),
            "m:13:4: a list longer than");
}

TEST(Ply, CountsAreCheckedBeforeMemoryIsTaken) {
  for (const char* format : {"ascii", "binary_little_endian"})
    for (const char* count : {"1000", "4294967295", "4294967296", "18446744073709551615"}) {
      const std::string text =
          std::string("ply\nformat ") + format + " 1.0\nelement vertex " + count +
          "\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n";
      EXPECT_NE(error_of(parse_ply, text).find("more than the rest of the file can hold"),
                std::string::npos);
    }
  EXPECT_NE(error_of(parse_ply, "ply\nformat ascii 1.0\nelement vertex 18446744073709551616\n")
                .find("expected a number"),
            std::string::npos);
  EXPECT_NE(
      error_of(parse_ply, "ply\nformat ascii 1.0\nelement e 18446744073709551615\nend_header\n")
          .find("has no properties"),
      std::string::npos);
  std::string list =
      "ply\nformat binary_little_endian 1.0\nelement e 1\nproperty list uint double "
      "l\nend_header\n";
  put<std::uint32_t>(list, 0xffffffffu, false);
  EXPECT_NE(error_of(parse_ply, list).find("longer than the rest"), std::string::npos);
}

TEST(Ply, NonFiniteBinaryNumbersAreErrors) {
  std::string text =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float "
      "y\nproperty float z\nend_header\n";
  const std::size_t header = text.size();
  put<float>(text, 0, false);
  put<float>(text, std::numeric_limits<float>::quiet_NaN(), false);
  put<float>(text, 0, false);
  EXPECT_EQ(error_of(parse_ply, text),
            "m: a position is not finite (at byte " + std::to_string(header + 12) + ")");
}

TEST(Obj, AllFormsOfFaces) {
  const auto mesh = parse_obj(
      "# a comment\nmtllib a.mtl\no thing\nv 0 0 0\nv 1 0 0 1.0\r\nv\t1 1 0\nv 0 1 0 0.5 0.5 0.5\n"
      "vt 0 0\nvt 1 0 0\nvt .5\nvn 0 0 1\nvn 0 1 0\ng part\ns off\nusemtl m\n"
      "f 1/1/1 2/2/1 3/3/1 4/1/1\nf -4/-3/-2 -3/-2/-2 -1/1/1 # again\n  f 1//2 2//2 3//2  \n",
      "m");
  // One vertex for each distinct triple.
  ASSERT_EQ(mesh.positions.size(), 7u);
  const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {4, 5, 6}};
  EXPECT_EQ(mesh.triangles, triangles);
  EXPECT_EQ(mesh.positions[3], Vec3(0, 1, 0));
  EXPECT_EQ(mesh.uvs[2], Vec2(0.5, 0));
  EXPECT_EQ(mesh.normals[0], Vec3(0, 0, 1));
  EXPECT_EQ(mesh.normals[4], Vec3(0, 1, 0));
}

/// Of a fold each side keeps its normals, and of a seam its texture coordinates.
TEST(Obj, CornersThatDifferAreVerticesOfTheirOwn) {
  const auto mesh = parse_obj(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nvn 0 0 1\nvn 1 0 0\n"
      "f 1/1/1 2/1/1 3/1/1\nf 1/1/2 3/1/2 4/1/2\nf 1/2/2 4/1/2 2/1/2\n",
      "m");
  const Vec3 normals[] = {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(1, 0, 0)};
  for (int i = 0; i < 3; ++i)
    for (const std::uint32_t v : mesh.triangles.at(i)) EXPECT_EQ(mesh.normals.at(v), normals[i]);
  EXPECT_EQ(mesh.uvs.at(mesh.triangles[1][0]), Vec2(0));
  EXPECT_EQ(mesh.uvs.at(mesh.triangles[2][0]), Vec2(1));
}

TEST(Obj, FacesWithoutNormals) {
  const auto plain = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3", "m");
  EXPECT_TRUE(plain.normals.empty());
  EXPECT_TRUE(plain.uvs.empty());
  EXPECT_EQ(plain.triangles.size(), 1u);
  const auto mixed = parse_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 2\nf 1//1 2//1 3", "m");
  EXPECT_EQ(mixed.normals[0], Vec3(0, 0, 2));
  EXPECT_EQ(mixed.normals[2], Vec3(0));
}

TEST(Obj, ErrorsNameTheirPlace) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_EQ(error_of(parse_obj, ""), "m: no faces");
  EXPECT_EQ(error_of(parse_obj, v), "m: no faces");
  EXPECT_EQ(error_of(parse_obj, "v 0 0\n"), "m:1:6: expected a finite number, found \"\"");
  EXPECT_EQ(error_of(parse_obj, "v 0 nan 0\n"), "m:1:5: expected a finite number, found \"nan\"");
  EXPECT_EQ(error_of(parse_obj, "v 0 1e999 0\n"),
            "m:1:5: expected a finite number, found \"1e999\"");
  EXPECT_EQ(error_of(parse_obj, "v 0 1x 0\n"),
            "m:1:6: expected space after a number, found \"x 0\"");
  EXPECT_EQ(error_of(parse_obj, v + "vn 0 0 inf\n"),
            "m:4:8: expected a finite number, found \"inf\"");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 2\n"), "m:4:6: a face needs three corners, found 2");
  EXPECT_EQ(error_of(parse_obj, v + "f\n"), "m:4:2: a face needs three corners, found 0");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 2 4\n"),
            "m:4:7: index of a vertex out of range: there are 3 so far");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 2 0\n"),
            "m:4:7: index of a vertex out of range: there are 3 so far");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 -4 2\n"),
            "m:4:5: index of a vertex out of range: there are 3 so far");
  EXPECT_EQ(error_of(parse_obj, v + "f 1/1 2 3\n"),
            "m:4:5: index of a texture coordinate out of range: there are 0 so far");
  EXPECT_EQ(error_of(parse_obj, v + "f 1//1 2 3\n"),
            "m:4:6: index of a normal out of range: there are 0 so far");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 2 99999999999999999999\n"),
            "m:4:7: index of a vertex out of range: there are 3 so far");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 2 x\n"),
            "m:4:7: expected the index of a vertex, found \"x\"");
  EXPECT_EQ(error_of(parse_obj, v + "f 1 2 3.5\n"),
            "m:4:8: expected space after the corner of a face, found \".5\"");
}

/// As it lies in a file of one mesh.
std::string packed_mesh(int version, const std::string& raw) {
  std::string packed(compressBound(raw.size()), '\0');
  uLongf size = packed.size();
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(raw.data()), raw.size());
  packed.resize(size);
  std::string file;
  put(file, std::uint16_t{0x041C}, false);
  put(file, static_cast<std::uint16_t>(version), false);
  return file + packed;
}

/// A mesh of two triangles, its header and flags as Mitsuba 0.6's documentation lists them.
template <class T>
std::string serialized_mesh(int version, std::uint32_t flags, double shift = 0) {
  std::string raw;
  put(raw, flags | (sizeof(T) == 4 ? 0x1000u : 0x2000u), false);
  if (version == 4) raw += std::string("a name\0", 7);
  put(raw, std::uint64_t{4}, false);
  put(raw, std::uint64_t{2}, false);
  const auto numbers = [&](std::initializer_list<double> values) {
    for (const double v : values) put(raw, static_cast<T>(v), false);
  };
  numbers({0 + shift, 0, 0, 1 + shift, 0, 0, 1 + shift, 1, 0, 0 + shift, 1, 0});
  if (flags & 1) numbers({0, 0, 1, 0, 0, 1, 0, 0.5, 1, 0, 0, 1});
  if (flags & 2) numbers({0, 0, 1, 0, 1, 0.25, 0, 1});
  if (flags & 8) numbers({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
  for (const std::uint32_t v : {0, 1, 2, 0, 2, 3}) put(raw, v, false);
  return packed_mesh(version, raw);
}

std::string serialized_file(int version, const std::vector<std::string>& meshes) {
  std::string file, ends;
  for (const std::string& mesh : meshes) {
    if (version == 4)
      put(ends, static_cast<std::uint64_t>(file.size()), false);
    else
      put(ends, static_cast<std::uint32_t>(file.size()), false);
    file += mesh;
  }
  put(ends, static_cast<std::uint32_t>(meshes.size()), false);
  return file + ends;
}

/// More vertices and triangles than are read at a time.
TEST(Serialized, LargeMeshesAreWhole) {
  constexpr std::uint32_t n = 40000;
  std::string raw;
  put(raw, 0x1000u, false);
  put(raw, std::uint64_t{n}, false);
  put(raw, std::uint64_t{n - 2}, false);
  for (std::uint32_t i = 0; i < 3 * n; ++i) put(raw, static_cast<float>(i), false);
  for (std::uint32_t i = 0; i + 2 < n; ++i)
    for (const std::uint32_t v : {i, i + 1, i + 2}) put(raw, v, false);
  const auto mesh = parse_serialized(packed_mesh(3, raw), "m", 0).mesh;
  ASSERT_EQ(mesh.positions.size(), n);
  ASSERT_EQ(mesh.triangles.size(), n - 2);
  for (std::uint32_t i = 0; i < n; ++i)
    ASSERT_EQ(mesh.positions[i], Vec3(3 * i, 3 * i + 1, 3 * i + 2));
  for (std::uint32_t i = 0; i + 2 < n; ++i)
    ASSERT_EQ(mesh.triangles[i], (Triangle{i, i + 1, i + 2}));
}

TEST(Serialized, EveryVersionPrecisionAndAttribute) {
  for (const int version : {3, 4})
    for (std::uint32_t flags = 0; flags < 32; ++flags) {
      if (flags & 4) continue;
      for (const bool single : {true, false}) {
        const std::string bytes = single ? serialized_mesh<float>(version, flags)
                                         : serialized_mesh<double>(version, flags);
        const SerializedMesh file = parse_serialized(bytes, "m", 0);
        const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        const std::vector<Triangle> triangles{{0, 1, 2}, {0, 2, 3}};
        EXPECT_EQ(file.mesh.positions, positions);
        EXPECT_EQ(file.mesh.triangles, triangles);
        EXPECT_EQ(file.mesh.normals.size(), flags & 1 ? 4u : 0u);
        EXPECT_EQ(file.mesh.uvs.size(), flags & 2 ? 4u : 0u);
        EXPECT_EQ(file.face_normals, bool(flags & 16));
        if (flags & 1) {
          EXPECT_EQ(file.mesh.normals[2], Vec3(0, 0.5, 1));
        }
        if (flags & 2) {
          EXPECT_EQ(file.mesh.uvs[2], Vec2(1, 0.25));
        }
      }
    }
}

TEST(Serialized, MeshesAreFoundByNumber) {
  for (const int version : {3, 4}) {
    const std::string bytes = serialized_file(
        version, {serialized_mesh<float>(version, 0, 0), serialized_mesh<double>(version, 3, 10),
                  serialized_mesh<float>(version, 1, 20)});
    for (int i = 0; i < 3; ++i)
      EXPECT_EQ(parse_serialized(bytes, "m", i).mesh.positions[0], Vec3(10 * i, 0, 0));
  }
}

TEST(Serialized, ComplainsOfWhatIsWrong) {
  const auto complains = [](const std::string& bytes, const char* message, std::int64_t index = 0) {
    try {
      parse_serialized(bytes, "m", index);
      ADD_FAILURE() << message;
    } catch (const Error& error) {
      EXPECT_EQ(error.where().file, "m");
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  };
  const std::string good = serialized_mesh<float>(4, 3);
  complains("", "ends too early");
  complains("ply\n", "no mesh in Mitsuba's serialized format");
  std::string other = good;
  other[2] = 5;
  complains(other, "found 5");
  complains(serialized_file(4, {good}), "but the file holds 1 meshes", 1);
  complains(good.substr(0, 3) + std::string(1, '\0') + "garbage", "a broken compressed mesh");
  // Every truncation, but of the checksum and the mark before it, is an error; every flipped byte
  // is one or gives some other mesh.
  for (std::size_t n = 0; n < good.size() - 6; ++n) complains(good.substr(0, n), "");
  for (std::size_t n = 0; n < good.size(); ++n)
    for (const int bit : {1, 16, 128}) {
      std::string bad = good;
      bad[n] = static_cast<char>(bad[n] ^ bit);
      try {
        parse_serialized(bad, "m", 0);
      } catch (const Error&) {
      }
    }
}

}  // namespace
}  // namespace fogbow
