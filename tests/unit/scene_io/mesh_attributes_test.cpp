// SPDX-License-Identifier: GPL-3.0-or-later
// Names and values: those of Mitsuba 3.9.1 for the same files.
#include "core/geometry/shapes.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

/// One triangle and a square, with these properties besides.
std::string ply(const std::string& vertex_properties, const std::array<std::string, 4>& vertices,
                const std::string& face_properties = "",
                const std::array<std::string, 2>& faces = {}) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
         "property float z\n" +
         vertex_properties + "element face 2\nproperty list uchar int vertex_indices\n" +
         face_properties + "end_header\n0 0 0 " + vertices[0] + "\n1 0 0 " + vertices[1] +
         "\n0 1 0 " + vertices[2] + "\n1 1 0 " + vertices[3] + "\n3 0 1 2 " + faces[0] +
         "\n4 0 1 3 2 " + faces[1] + "\n";
}

std::string floats(const std::string& names) {
  std::string result;
  for (std::size_t at = 0, end; at < names.size(); at = end + 1) {
    end = std::min(names.find(' ', at), names.size());
    result += "property float " + names.substr(at, end - at) + "\n";
  }
  return result;
}

const std::array<std::string, 4> kColors{".1 .2 .3", ".4 .5 .6", ".7 .8 .9", "0 0 0"};

class MeshAttributes : public ::testing::Test {
 protected:
  std::string shape(const std::string& file, const std::string& texture, bool lamp = false) {
    folder_.write("a.ply", file);
    const std::string inside = "<texture type=\"mesh_attribute\" name=\"" +
                               std::string(lamp ? "radiance" : "reflectance") + "\">" + texture +
                               "</texture>";
    return R"(<shape type="ply"><string name="filename" value="a.ply"/>)" +
           (lamp ? "<emitter type=\"area\">" + inside + "</emitter>"
                 : "<bsdf type=\"diffuse\">" + inside + "</bsdf>") +
           "</shape>";
  }
  /// Where barycentrics of a triangle say.
  RGB reflectance(const std::string& file, const std::string& name, std::uint32_t triangle,
                  const Vec2& local, const std::string& more = "") {
    const auto scene =
        folder_.load(shape(file, "<string name=\"name\" value=\"" + name + "\"/>" + more));
    SurfacePoint x = scene.surfaces.at(0).shape->surface_point(triangle, local);
    x.shape = scene.surfaces.at(0).shape.get();
    return scene.surfaces.at(0).bsdf->albedo(x);
  }
  std::string error(const std::string& file, const std::string& name, bool lamp = false) {
    return folder_.error(shape(file, "<string name=\"name\" value=\"" + name + "\"/>", lamp));
  }
  static void expect_color(const RGB& a, const RGB& b) { EXPECT_LT(length(a - b), 1e-6); }

  SceneFolder folder_;
};

TEST_F(MeshAttributes, VerticesAreInterpolated) {
  const std::string file = ply(floats("r g b w_0 foo_x foo_y foo_z tint_r tint_g tint_b"),
                               {".1 .2 .3 .5 1 0 0 0 0 0", ".4 .5 .6 .25 0 1 0 0 0 1",
                                ".7 .8 .9 .75 0 0 1 0 0 0", "0 0 0 0 0 0 0 0 0 0"});
  // At x = 1/4, y = 1/2.
  const Vec2 at(0.25, 0.5);
  expect_color(reflectance(file, "vertex_color", 0, at), {0.475, 0.575, 0.675});
  expect_color(reflectance(file, "vertex_color", 0, at, R"(<float name="scale" value=".5"/>)"),
               {0.2375, 0.2875, 0.3375});
  expect_color(reflectance(file, "vertex_w", 0, at), RGB(0.5625));
  expect_color(reflectance(file, "vertex_foo", 0, at), {0.25, 0.25, 0.5});
  expect_color(reflectance(file, "vertex_tint_color", 0, at), {0, 0, 0.25});
  EXPECT_TRUE(folder_.warnings.empty());
}

TEST_F(MeshAttributes, FacesAreFlatAndPolygonsKeepTheirs) {
  const std::string file = ply("", {}, floats("red green blue"), {".1 .2 .3", ".4 .5 .6"});
  expect_color(reflectance(file, "face_color", 0, Vec2(0.2, 0.7)), {0.1, 0.2, 0.3});
  expect_color(reflectance(file, "face_color", 1, Vec2(0.2, 0.7)), {0.4, 0.5, 0.6});
  expect_color(reflectance(file, "face_color", 2, Vec2(0.2, 0.7)), {0.4, 0.5, 0.6});
}

TEST_F(MeshAttributes, FacesWithoutAreaTakeTheirsWithThem) {
  TriangleMeshData data;
  data.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  data.triangles = {{0, 1, 1}, {0, 1, 2}, {2, 2, 0}, {1, 3, 2}};
  data.attributes = {{"face_n", 1, true, {1, 2, 3, 4}},
                     {"face_color", 3, true, {1, 1, 1, 2, 3, 4, 5, 5, 5, 6, 7, 8}}};
  const auto mesh = make_mesh(data);
  const MeshAttribute& color = *mesh->find_attribute("face_color");
  EXPECT_EQ(mesh->attribute(mesh->surface_point(0, Vec2(0.2)), color), RGB(2, 3, 4));
  EXPECT_EQ(mesh->attribute(mesh->surface_point(1, Vec2(0.2)), color), RGB(6, 7, 8));
  const MeshAttribute& a = *mesh->find_attribute("face_n");
  EXPECT_EQ(mesh->attribute(mesh->surface_point(0, Vec2(0.2)), a), RGB(2));
  EXPECT_EQ(mesh->attribute(mesh->surface_point(1, Vec2(0.2)), a), RGB(4));
  data.attributes[0].values.pop_back();
  EXPECT_THROW(make_mesh(data), std::domain_error);
}

TEST_F(MeshAttributes, LampsShineByThem) {
  const std::string file = ply(floats("r g b"), {"1 0 0", "4 0 0", "7 0 0", "0 0 0"});
  const auto scene =
      folder_.load(shape(file, R"(<string name="name" value="vertex_color"/>)", true));
  const Surface& s = scene.surfaces.at(0);
  EmitterPoint x;
  x.surface = s.shape->surface_point(0, Vec2(0.25, 0.5));
  x.surface.shape = s.shape.get();
  expect_color(s.emitter->L_e(x, x.surface.n_g), {4.75, 0, 0});
  const auto sampled = s.emitter->sample_position(Vec3(0.3, 0.6, 0));
  EXPECT_EQ(sampled->surface.shape, s.shape.get());
}

TEST_F(MeshAttributes, ErrorsTellWhatThereIs) {
  const std::string file = ply(floats("r g b w_0"), {"0 0 0 0", "1 0 0 1", "0 2 0 0", "0 0 0 0"});
  EXPECT_NE(error(file, "vertex_colour").find("no attribute \"vertex_colour\""), std::string::npos);
  EXPECT_NE(error(file, "vertex_colour").find("it has \"vertex_color\" and \"vertex_w\""),
            std::string::npos);
  EXPECT_GT(folder_.where.line, 0);
  EXPECT_NE(error(ply("", {}), "face_color").find("it has none at all"), std::string::npos);
  EXPECT_NE(error(file, "color").find("must begin with \"vertex_\""), std::string::npos);
  EXPECT_NE(error(file, "vertex_color").find("from 0.000000 to 2.000000"), std::string::npos);
  const std::string negative = ply(floats("r g b"), {"0 0 0", "-1 0 0", "0 0 0", "0 0 0"});
  EXPECT_NE(error(negative, "vertex_color", true).find("from -1.000000"), std::string::npos);
  EXPECT_NE(folder_
                .error(R"(<shape type="sphere"><bsdf type="diffuse"><texture
      type="mesh_attribute" name="reflectance"><string name="name" value="face_n"/></texture></bsdf>
      </shape>)")
                .find("it has none at all"),
            std::string::npos);
  EXPECT_NE(error(file, "vertex_nan").find("vertex_nan"), std::string::npos);
  const std::string broken = ply(floats("r g b"), {"0 0 0", "nan 0 0", "0 0 0", "0 0 0"});
  EXPECT_NE(error(broken, "vertex_color").find("finite"), std::string::npos);
}

/// What holds a texture that holds an attribute must be content with it, too.
TEST_F(MeshAttributes, AreCheckedInsideOtherTextures) {
  const std::string file = ply(floats("r g b"), {"0 0 0", "1.5 0 0", "0 0 0", "0 0 0"});
  folder_.write("a.ply", file);
  const std::string board = R"(<shape type="ply"><string name="filename" value="a.ply"/>
      <bsdf type="diffuse"><texture type="checkerboard" name="reflectance">
      <texture type="mesh_attribute" name="color0"><string name="name" value="vertex_color"/>
      </texture></texture></bsdf></shape>)";
  EXPECT_NE(folder_.error(board).find("from 0.000000 to 1.500000"), std::string::npos);
  folder_.write("a.ply", ply(floats("r g b"), kColors));
  EXPECT_NO_THROW(folder_.load(board));
  // The scale counts: half of what is too bright is not, twice of what is right may be.
  const auto scaled = [&](const char* values, const std::string& scale) {
    return shape(ply(floats("r g b"), {"0 0 0", values, "0 0 0", "0 0 0"}),
                 R"(<string name="name" value="vertex_color"/><float name="scale" value=")" +
                     scale + "\"/>");
  };
  EXPECT_NO_THROW(folder_.load(scaled("1.5 0 0", "0.5")));
  EXPECT_NE(folder_.error(scaled("0.75 0 0", "2")).find("from 0.000000 to 1.500000"),
            std::string::npos);
  EXPECT_NE(folder_
                .error(R"(<emitter type="projector"><texture type="mesh_attribute"
      name="irradiance"><string name="name" value="vertex_color"/></texture></emitter>)")
                .find("only on a mesh"),
            std::string::npos);
  EXPECT_NE(folder_
                .error(R"(<shape type="ply"><string name="filename" value="a.ply"/>
      <bsdf type="bumpmap"><texture type="mesh_attribute"><string name="name"
      value="vertex_color"/></texture><bsdf type="diffuse"/></bsdf></shape>)")
                .find("cannot be made of a mesh attribute"),
            std::string::npos);
}

}  // namespace
}  // namespace fogbow
