// SPDX-License-Identifier: GPL-3.0-or-later
// Whatever a file holds, reading it ends in a scene or in an Error with its place, soon.
#include <ctime>
#include <set>

#include "core/util/rng.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;
namespace fs = std::filesystem;

// Sanitizers slow everything down by about ten.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr double kPatience = 10;
#else
constexpr double kPatience = 1;
#endif

/// Of this process: other jobs of the machine do not count.
double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// The error of a file, which must come within a second and name a place.
std::string swift_error(SceneFolder& folder, const std::string& name) {
  const double start = cpu_seconds();
  const std::string text = folder.error_of_file(name);
  EXPECT_LT(cpu_seconds() - start, kPatience) << text;
  EXPECT_FALSE(folder.where.file.empty()) << text;
  EXPECT_TRUE(folder.kind == ErrorKind::Scene || folder.kind == ErrorKind::InputOutput) << text;
  EXPECT_LT(text.size(), 1000u);
  return text;
}

std::string swift_error_of_text(SceneFolder& folder, const std::string& text) {
  folder.write("hostile.xml", text);
  return swift_error(folder, "hostile.xml");
}

std::string volume_scene(const std::string& file) {
  return SceneFolder::wrap(
      "<shape type=\"cube\"><medium type=\"heterogeneous\" name=\"interior\">"
      "<volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" value=\"" +
      file + "\"/></volume></medium></shape>");
}

std::string mesh_scene(const std::string& file) {
  if (fs::path(file).extension() == ".vol") return volume_scene(file);
  return SceneFolder::wrap("<shape type=\"" + fs::path(file).extension().string().substr(1) +
                           "\"><string name=\"filename\" value=\"" + file + "\"/></shape>");
}

/// A scene or an Error with a place: anything else is a failure.
void read_somehow(SceneFolder& folder, const std::string& text) {
  try {
    folder.load_text(text);
  } catch (const Error& error) {
    EXPECT_FALSE(error.where().file.empty()) << error.what();
  }
}

/// Files of the corpus: every one ends in the error that its comment or name in the table says.
TEST(HostileInput, Corpus) {
  const std::pair<const char*, const char*> expected[] = {
      {"binary_garbage.xml", "null byte"},
      {"empty_name.xml", "is empty"},
      {"enormous_film.xml", "more than 268435456 pixels"},
      {"entity_bomb.xml", "expected a finite number"},
      {"huge_numbers.xml", "transform is singular"},
      {"infinite_radius.xml", "expected a finite number"},
      {"mutual_a.xml", "includes itself"},
      {"mutual_b.xml", "includes itself"},
      {"nan_everywhere.xml", "expected finite numbers"},
      {"null_byte.xml", "null byte"},
      {"reads_a_device.xml", "is no regular file"},
      {"reads_a_folder.xml", "is no regular file"},
      {"ref_cycle.xml", "contains itself"},
      {"ref_to_itself.xml", "contains itself"},
      {"self_include.xml", "includes itself"},
      {"unclosed.xml", "malformed XML"},
      {"utf16.xml", "UTF-16"},
      {"wide_matrix.xml", "9 or 16 numbers"},
      {"enormous_count.ply", "more than the rest of the file can hold"},
      {"enormous_list.ply", "longer than the rest of the file"},
      {"index_out_of_range.ply", "names vertex 7"},
      {"nan.ply", "expected a finite number"},
      {"no_properties.ply", "has no properties"},
      {"not_a_mesh.ply", "expected \"ply\""},
      {"infinite_vertex.ply", "expected a finite number"},
      {"enormous_count.serialized", "more than 32 bits can name"},
      {"fewer_vertices.serialized", "ends too early"},
      {"index_out_of_range.serialized", "names vertex 7"},
      {"nan.serialized", "is not finite"},
      {"no_precision.serialized", "single or of double precision"},
      {"not_a_mesh.serialized", "no mesh in Mitsuba's serialized format"},
      {"unpacked.serialized", "a broken compressed mesh"},
      {"index_out_of_range.obj", "out of range"},
      {"nan.obj", "expected a finite number"},
      {"no_faces.obj", "no faces"},
      {"overflowing_index.obj", "out of range"},
      {"directions.vol", "directions (encoding 4)"},
      {"empty.vol", "begins with \"VOL\" (at byte 0)"},
      {"enormous.vol", "more than 2147483648 voxels"},
      {"infinite.vol", "voxel (1, 1, 1) is not finite (at byte 76)"},
      {"infinite_half.vol", "voxel (1, 1, 1) is not finite (at byte 62)"},
      {"nan.vol", "voxel (1, 0, 1) is not finite"},
      {"negative.vol", "voxel (1, 1, 0) is negative"},
      {"negative_size.vol", "at least one voxel on each axis, found -2 (at byte 12)"},
      {"no_voxels.vol", "at least one voxel"},
      {"not_a_volume.vol", "begins with \"VOL\""},
      {"old_version.vol", "expected version 3 of the format, found 2 (at byte 3)"},
      {"only_a_header.vol", "ends within its header"},
      {"overflowing.vol", "more than 2147483648 voxels"},
      {"truncated.vol", "promises 8 values, but the file holds 7"},
      {"two_channels.vol", "1 or 3 channels, found 2"},
      {"unknown_encoding.vol", "found 77"},
  };
  SceneFolder folder;
  std::set<std::string> tested;
  for (const auto& entry : fs::directory_iterator("tests/regression/corpus"))
    fs::copy(entry.path(), folder.path(entry.path().filename().string()));
  for (const auto& [name, message] : expected) {
    SCOPED_TRACE(name);
    std::string scene = name;
    if (fs::path(name).extension() != ".xml")
      folder.write(scene = std::string(name) + ".xml", mesh_scene(name));
    const std::string text = swift_error(folder, scene);
    EXPECT_NE(text.find(message), std::string::npos) << text;
    tested.insert(name);
  }
  for (const auto& entry : fs::directory_iterator("tests/regression/corpus"))
    EXPECT_TRUE(tested.contains(entry.path().filename().string())) << entry.path();
}

const char* kSmallScene = R"(<?xml version="1.0"?>
<scene version="3.0.0"><default name="r" value="2"/><!-- é -->
<sensor type="perspective"><transform name="to_world"><lookat origin="0,0,5" target="0,0,0" up="0,1,0"/>
</transform><film type="hdrfilm"><integer name="width" value="8"/><rfilter type="box"/></film></sensor>
<bsdf type="twosided" id="b"><bsdf type="diffuse"><rgb name="reflectance" value=".1 .2 .3"/></bsdf></bsdf>
<shape type="sphere"><float name="radius" value="$r"/><ref id="b"/><medium type="homogeneous"
name="interior"><phase type="hg"><float name="g" value="0.5"/></phase></medium></shape>
<emitter type="point"><point name="position" x="1" y="2" z="3"/></emitter></scene>)";

const char* kSmallPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
    "z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";
const char* kSmallObj =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 1\nvn 0 0 1\nf 1/1/1 2/2/1 -1/1/1\n";

TEST(HostileInput, EveryTruncationOfASceneIsAnError) {
  SceneFolder folder;
  const std::string whole = kSmallScene;
  folder.load_text(whole);
  EXPECT_TRUE(folder.warnings.empty());
  for (std::size_t n = 0; n < whole.size(); ++n) swift_error_of_text(folder, whole.substr(0, n));
}

/// Some prefixes of text meshes are meshes themselves.
TEST(HostileInput, EveryTruncationOfAMeshIsReadOrAnError) {
  SceneFolder folder;
  for (const auto& [name, content] :
       {std::pair{"m.ply", kSmallPly}, std::pair{"m.obj", kSmallObj}}) {
    const std::string whole = content, scene = mesh_scene(name);
    folder.write(name, whole);
    folder.load_text(scene);
    for (std::size_t n = 0; n < whole.size(); ++n) {
      folder.write(name, whole.substr(0, n));
      read_somehow(folder, scene);
    }
    folder.write(name, whole.substr(0, whole.rfind(' ')));
    swift_error_of_text(folder, scene);
  }
}

/// Bytes flipped, doubled, dropped and replaced, by a fixed seed.
std::string damaged(std::string text, Rng& rng) {
  static const std::string kNasty[] = {"\"",
                                       "<",
                                       ">",
                                       "&",
                                       "$r",
                                       "/",
                                       "-",
                                       "1e999",
                                       "nan",
                                       "\n",
                                       "99999999999999999999",
                                       std::string(1, '\0'),
                                       "\xff",
                                       "="};
  const auto below = [&](std::size_t n) {
    return static_cast<std::size_t>(rng.uniform() * static_cast<double>(n));
  };
  for (std::size_t i = 1 + below(4); i > 0 && !text.empty(); --i) {
    const std::size_t at = below(text.size());
    switch (below(4)) {
      case 0: text[at] = static_cast<char>(below(256)); break;
      case 1: text.insert(at, text.substr(at, 1 + below(40))); break;
      case 2: text.erase(at, 1 + below(20)); break;
      default: text.insert(at, kNasty[below(std::size(kNasty))]);
    }
  }
  return text;
}

TEST(HostileInput, DamagedFilesAreReadOrAnError) {
  SceneFolder folder;
  Rng rng(testing::suite_seed(), RngDomain::Test, 0, 0);
  for (int i = 0; i < 1000; ++i) read_somehow(folder, damaged(kSmallScene, rng));
  for (int i = 0; i < 1000; ++i) {
    const bool ply = i % 2 == 0;
    folder.write(ply ? "m.ply" : "m.obj", damaged(ply ? kSmallPly : kSmallObj, rng));
    read_somehow(folder, mesh_scene(ply ? "m.ply" : "m.obj"));
  }
}

TEST(HostileInput, SubstitutionsDoNotExplode) {
  SceneFolder folder;
  std::string laughs = "<default name=\"a0\" value=\"" + std::string(100, 'x') + "\"/>";
  for (int i = 1; i < 64; ++i) {
    const std::string before = "$a" + std::to_string(i - 1);
    laughs +=
        "\n<default name=\"a" + std::to_string(i) + "\" value=\"" + before + " " + before + "\"/>";
  }
  EXPECT_NE(
      swift_error_of_text(folder, SceneFolder::wrap(laughs)).find("substitutions grow beyond"),
      std::string::npos);
  EXPECT_GT(folder.where.line, 10);
  // Empty values cost no memory, but time.
  std::string empty = "<default name=\"e\" value=\"\"/><string name=\"s\" value=\"";
  for (int i = 0; i < 2000000; ++i) empty += "$e";
  EXPECT_NE(
      swift_error_of_text(folder, SceneFolder::wrap(empty + "\"/>")).find("substitutions grow"),
      std::string::npos);
  EXPECT_NE(swift_error_of_text(folder, SceneFolder::wrap("<default name=\"x\" value=\"$x\"/>"))
                .find("not defined"),
            std::string::npos);
}

TEST(HostileInput, IncludesDoNotExplode) {
  SceneFolder folder;
  const auto include = [](int i) {
    return "<include filename=\"i" + std::to_string(i) + ".xml\"/>";
  };
  for (int i = 0; i < 40; ++i)
    folder.write("i" + std::to_string(i) + ".xml",
                 "<scene version=\"3.0.0\">" + include(i + 1) + "</scene>");
  EXPECT_NE(
      swift_error_of_text(folder, SceneFolder::wrap(include(0))).find("nested deeper than 16"),
      std::string::npos);
  // Ten of each in each: 10^12 files if they were all read.
  std::string ten;
  for (int i = 0; i < 12; ++i) {
    ten.clear();
    for (int j = 0; j < 10; ++j) ten += include(i + 1);
    folder.write("i" + std::to_string(i) + ".xml", "<scene version=\"3.0.0\">" + ten + "</scene>");
  }
  folder.write("i12.xml", "<scene version=\"3.0.0\"/>");
  EXPECT_NE(
      swift_error_of_text(folder, SceneFolder::wrap(include(0))).find("more than 1000 includes"),
      std::string::npos);
}

TEST(HostileInput, NestingAndCountsAreBounded) {
  SceneFolder folder;
  const auto repeated = [](const std::string& text, int count) {
    std::string result;
    for (int i = 0; i < count; ++i) result += text;
    return result;
  };
  const std::string open = "<bsdf type=\"twosided\">";
  EXPECT_NE(swift_error_of_text(
                folder, SceneFolder::wrap(repeated(open, 100000) + repeated("</bsdf>", 100000)))
                .find("nested deeper than 64"),
            std::string::npos);
  EXPECT_NE(
      swift_error_of_text(folder, SceneFolder::wrap(repeated(open, 100000))).find("malformed"),
      std::string::npos);
  EXPECT_NE(swift_error_of_text(folder, SceneFolder::wrap(repeated("<a/>", 1000001)))
                .find("more than 1000000 elements"),
            std::string::npos);
  EXPECT_NE(swift_error_of_text(folder, SceneFolder::wrap(repeated("<", 5000000)))
                .find("more than 1000000 elements"),
            std::string::npos);
  std::string attributes, properties, chain;
  for (int i = 0; i < 100000; ++i) {
    const std::string n = std::to_string(i);
    attributes += " a" + n + "=\"\"";
    properties += "<float name=\"a" + n + "\" value=\"1\"/>";
    if (i < 10000)
      chain += "<bsdf type=\"twosided\" id=\"a" + n + "\"><ref id=\"a" + std::to_string(i + 1) +
               "\"/></bsdf>";
  }
  EXPECT_NE(swift_error_of_text(folder, SceneFolder::wrap("<shape" + attributes + "/>"))
                .find("too many attributes"),
            std::string::npos);
  EXPECT_NE(swift_error_of_text(
                folder, SceneFolder::wrap("<shape type=\"cube\">" + properties + "</shape>"))
                .find("more than 256 properties"),
            std::string::npos);
  EXPECT_NE(swift_error_of_text(folder,
                                SceneFolder::wrap(chain + "<bsdf type=\"diffuse\" id=\"a10000\"/>"))
                .find("nested deeper than 64"),
            std::string::npos);
}

/// Each object refers twice to the next: built once each, or this would take 2^60 steps.
TEST(HostileInput, SharedReferencesAreBuiltOnce) {
  SceneFolder folder;
  std::string chain;
  for (int i = 0; i < 60; ++i) {
    const std::string ref = "<ref id=\"a" + std::to_string(i + 1) + "\"/>";
    chain += "<bsdf type=\"twosided\" id=\"a" + std::to_string(i) + "\">" + ref + ref + "</bsdf>";
  }
  const double start = cpu_seconds();
  read_somehow(folder, SceneFolder::wrap(chain + "<bsdf type=\"diffuse\" id=\"a60\"/>"));
  EXPECT_LT(cpu_seconds() - start, kPatience);
}

TEST(HostileInput, LongTextsAreShortInMessages) {
  SceneFolder folder;
  const std::string endless(5000000, 'x');
  swift_error_of_text(folder, SceneFolder::wrap("<shape type=\"" + endless + "\"/>"));
  swift_error_of_text(folder, SceneFolder::wrap("<shape type=\"cube\"><float name=\"a\" value=\"" +
                                                endless + "\"/></shape>"));
  swift_error_of_text(folder, SceneFolder::wrap("<" + endless + "/>"));
  swift_error_of_text(folder, SceneFolder::wrap("<ref id=\"" + endless + "\"/>"));
  swift_error_of_text(folder, SceneFolder::wrap("<include filename=\"" + endless + "\"/>"));
  swift_error_of_text(folder,
                      SceneFolder::wrap("<bsdf type=\"null\" id=\"" + endless +
                                        "\"/><bsdf type=\"null\" id=\"" + endless + "\"/>"));
  swift_error_of_text(
      folder, SceneFolder::wrap("<shape type=\"obj\"><string name=\"filename\" value=\"" + endless +
                                "\"/></shape>"));
  swift_error_of_text(folder, SceneFolder::wrap("<string name=\"s\" value=\"$" + endless + "\"/>"));
  swift_error_of_text(folder, SceneFolder::wrap("<shape type=\"sphere\"><string name=\"" + endless +
                                                "\" value=\"\"/><string name=\"" + endless +
                                                "\" value=\"\"/></shape>"));
  swift_error_of_text(folder, endless);
}

/// A file longer than the limit costs nothing: it is sparse, and refused by its size.
TEST(HostileInput, LongFilesAreRefusedBySize) {
  SceneFolder folder;
  folder.write("long.xml", "<scene/>");
  fs::resize_file(folder.path("long.xml"), std::uintmax_t{1} << 36);
  EXPECT_NE(swift_error(folder, "long.xml").find("more than the limit"), std::string::npos);
  folder.write("long.ply", "ply\n");
  fs::resize_file(folder.path("long.ply"), std::uintmax_t{1} << 36);
  EXPECT_NE(swift_error_of_text(folder, mesh_scene("long.ply")).find("more than the limit"),
            std::string::npos);
}

}  // namespace
}  // namespace fogbow
