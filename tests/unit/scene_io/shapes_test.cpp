// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/random.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow {
namespace {

using testing::SceneFolder;

Surface load_shape(SceneFolder& folder, const std::string& type, const std::string& properties) {
  auto scene = folder.load("<shape type=\"" + type + "\">" + properties + "</shape>");
  EXPECT_TRUE(folder.warnings.empty()) << folder.warnings.front();
  return scene.surfaces.at(0);
}

/// What a ray from `o` towards `d` meets first, if anything.
std::optional<SurfacePoint> first_point(const Shape& shape, const Vec3& o, const Vec3& d) {
  std::optional<SurfacePoint> best;
  double nearest = kInfinity;
  for (std::uint32_t i = 0; i < shape.primitive_count(); ++i)
    if (const auto hit = shape.intersect(i, Ray{o, d, 0, nearest}, false)) {
      nearest = hit->t;
      best = shape.surface_point(i, hit->local);
    }
  return best;
}

SurfacePoint meet(const Shape& shape, const Vec3& o, const Vec3& d) {
  const auto best = first_point(shape, o, d);
  EXPECT_TRUE(best);
  return best.value_or(SurfacePoint{});
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-12) {
  EXPECT_NEAR(length(a - b), 0, tolerance * (1 + length(b)));
}

const char* kMirror = R"(<transform name="to_world"><scale x="-1"/></transform>)";
const char* kFlip = R"(<boolean name="flip_normals" value="true"/>)";

/// Normals as Mitsuba 3.9.1 gives them for rays from (0, 0, 5) down; where its geometric and
/// shading normals disagree (mirrored rectangles and cubes) the latter, which decides what the
/// material shows.
TEST(Shapes, NormalsUnderMirrorsAndFlips) {
  SceneFolder folder;
  struct Case {
    const char* type;
    std::string properties;
    double z, n;
  };
  const std::string negative = R"(<transform name="to_world"><scale value="-2"/></transform>)";
  const Case cases[] = {
      {"rectangle", "", 0, 1},     {"rectangle", kFlip, 0, -1}, {"rectangle", kMirror, 0, 1},
      {"cube", "", 1, 1},          {"cube", kFlip, 1, -1},      {"cube", kMirror, 1, 1},
      {"sphere", "", 1, 1},        {"sphere", kFlip, 1, -1},    {"sphere", kMirror, 1, -1},
      {"sphere", negative, 2, -1}, {"disk", "", 0, 1},          {"disk", kFlip, 0, -1},
      {"disk", kMirror, 0, 1},     {"disk", negative, 0, -1},
  };
  for (const Case& c : cases) {
    const Surface s = load_shape(folder, c.type, c.properties);
    const SurfacePoint x = meet(*s.shape, Vec3(0, 0, 5), Vec3(0, 0, -1));
    expect_near(x.position, Vec3(0, 0, c.z));
    expect_near(x.n_g, Vec3(0, 0, c.n));
    expect_near(x.shading.n, Vec3(0, 0, c.n));
  }
}

TEST(Sphere, CenterRadiusAndTransform) {
  SceneFolder folder;
  const Surface s = load_shape(folder, "sphere", R"(<point name="center" x="1" y="0" z="0"/>
      <float name="radius" value="2"/><transform name="to_world"><scale value="2"/>
      <rotate z="1" angle="90"/><translate x="1" y="2" z="3"/></transform>)");
  expect_near(s.shape->bounds().center(), Vec3(1, 4, 3));
  EXPECT_NEAR(s.shape->area(), 4 * kPi * 16, 1e-9);
  EXPECT_NE(
      folder
          .error(
              R"(<shape type="sphere"><transform name="to_world"><scale x="2"/></transform></shape>)")
          .find("2:22: a sphere's \"to_world\" must scale alike"),
      std::string::npos);
  // Askew, though it keeps the lengths of all axes.
  EXPECT_NE(folder
                .error(R"(<shape type="sphere"><transform name="to_world">
                       <matrix value="1 0.6 0  0 0.8 0  0 0 1"/></transform></shape>)")
                .find("must scale alike"),
            std::string::npos);
}

TEST(Cylinder, EndsRadiusAndTransform) {
  SceneFolder folder;
  const Surface s = load_shape(folder, "cylinder", R"(<point name="p0" x="0" y="1" z="0"/>
      <point name="p1" x="0" y="4" z="0"/><float name="radius" value="0.5"/>
      <transform name="to_world"><scale value="2"/></transform>)");
  EXPECT_NEAR(s.shape->area(), 2 * kPi * 6, 1e-12);
  const SurfacePoint x = meet(*s.shape, Vec3(9, 3, 0), Vec3(-1, 0, 0));
  expect_near(x.position, Vec3(1, 3, 0));
  expect_near(x.n_g, Vec3(1, 0, 0));
  EXPECT_NEAR(x.uv.y, 1.0 / 6, 1e-12);
  const Surface standard = load_shape(folder, "cylinder", kMirror);
  expect_near(meet(*standard.shape, Vec3(9, 0, 0.5), Vec3(-1, 0, 0)).n_g, Vec3(1, 0, 0));
  EXPECT_NEAR(standard.shape->area(), 2 * kPi, 1e-12);
  const auto complains = [&](const std::string& inside, const char* message) {
    const std::string text = folder.error("<shape type=\"cylinder\">" + inside + "</shape>");
    EXPECT_NE(text.find(message), std::string::npos) << text;
  };
  complains(R"(<transform name="to_world"><scale x="2"/></transform>)",
            "stretch it along its axis");
  complains(R"(<point name="p1" x="0" y="0" z="0"/>)", "two different finite ends");
  complains(R"(<float name="radius" value="0"/>)", "must be greater than zero");
}

/// The columns of a rectangle's transform, read off its corners.
Mat4 transform_of(SceneFolder& folder, const std::string& steps) {
  const Surface s =
      load_shape(folder, "rectangle", "<transform name=\"to_world\">" + steps + "</transform>");
  const auto at = [&](double x, double y) {
    return s.shape->sample(Vec2((x + 1) / 2, (y + 1) / 2)).position;
  };
  Mat4 m(1.0);
  m[3] = Vec4(at(0, 0), 1);
  m[0] = Vec4(at(0.5, 0) - at(-0.5, 0), 0);
  m[1] = Vec4(at(0, 0.5) - at(0, -0.5), 0);
  return m;
}

/// Matrices as Mitsuba 3.9.1 prints them: images of the origin, x and y.
TEST(Transforms, EveryStepInEverySpelling) {
  SceneFolder folder;
  struct Case {
    const char* steps;
    Vec3 origin, x, y;
  };
  const Vec3 o(0), ex(1, 0, 0), ey(0, 1, 0);
  const Case cases[] = {
      {"", o, ex, ey},
      {R"(<translate x="1" y="2" z="3"/>)", {1, 2, 3}, ex, ey},
      {R"(<translate value="1, 2, 3"/>)", {1, 2, 3}, ex, ey},
      {R"(<translate value="1 2 3"/>)", {1, 2, 3}, ex, ey},
      {R"(<translate value="2"/>)", {2, 2, 2}, ex, ey},
      {R"(<translate y="2"/>)", {0, 2, 0}, ex, ey},
      {R"(<scale value="2"/>)", o, {2, 0, 0}, {0, 2, 0}},
      {R"(<scale value="1, 2, 3"/>)", o, ex, {0, 2, 0}},
      {R"(<scale x="2"/>)", o, {2, 0, 0}, ey},
      {R"(<rotate x="1" angle="90"/>)", o, ex, {0, 0, 1}},
      {R"(<rotate value="1, 0, 0" angle="90"/>)", o, ex, {0, 0, 1}},
      {R"(<rotate z="2" angle="90"/>)", o, {0, 1, 0}, {-1, 0, 0}},
      {R"(<matrix value="1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1"/>)", {5, 6, 7}, ex, ey},
      {R"(<matrix value="1 2 0 0 1 0 0 0 1"/>)", o, ex, {2, 1, 0}},
      {R"(<lookat origin="0,0,5" target="0,0,0" up="0,1,0"/>)", {0, 0, 5}, {-1, 0, 0}, ey},
      {R"(<lookat origin="0,0,5" target="0,0,0"/>)", {0, 0, 5}, {0, 1, 0}, {1, 0, 0}},
      {R"(<scale value="2"/><translate x="1" y="0" z="0"/>)", {1, 0, 0}, {2, 0, 0}, {0, 2, 0}},
      {R"(<translate x="1" y="0" z="0"/><scale value="2"/>)", {2, 0, 0}, {2, 0, 0}, {0, 2, 0}},
      {R"(<scale x="2"/><rotate z="1" angle="90"/><translate y="3"/>)",
       {0, 3, 0},
       {0, 2, 0},
       {-1, 0, 0}},
  };
  for (const Case& c : cases) {
    const Mat4 m = transform_of(folder, c.steps);
    SCOPED_TRACE(c.steps);
    expect_near(Vec3(m[3]), c.origin);
    expect_near(Vec3(m[0]), c.x);
    expect_near(Vec3(m[1]), c.y);
  }
}

TEST(Transforms, FailWithTheStep) {
  SceneFolder folder;
  const std::pair<const char*, const char*> cases[] = {
      {R"(<scale x="0"/>)", "3:1: transform is singular"},
      {R"(<rotate x="1"/>)", "3:1: <rotate> needs the attribute \"angle\""},
      {R"(<rotate angle="90"/>)", "3:1: rotation axis is zero"},
      {R"(<matrix value="1 2"/>)", "3:9: expected the 9 or 16 numbers of a matrix, found 2"},
      {R"(<matrix value="1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1"/>)", "3:1: transform is not affine"},
      {R"(<lookat origin="0,0,1" target="0,0,1" up="0,1,0"/>)",
       "3:1: lookat origin and target coincide"},
      {R"(<lookat origin="0,0,1" target="0,0,0" up="0,0,1"/>)", "3:1: lookat up is parallel"},
      {R"(<lookat target="0,0,0" up="0,0,1"/>)", "3:1: <lookat> needs the attribute \"origin\""},
      {R"(<translate value="1,2"/>)", "3:12: expected one or three numbers"},
      {R"(<scale value="2" x="3"/>)", "3:18: give either \"value\""},
      {R"(<scale value="1e200"/><scale value="1e200"/>)", "3:1: transform is singular"},
      {R"(<rotat x="1" angle="5"/>)",
       "3:1: expected a step of a transform (\"translate\", \"rotate\", \"scale\", "
       "\"matrix\" or \"lookat\"), found <rotat> (did you mean \"rotate\"?)"},
      {R"(<float name="a" value="1"/>)", "3:1: expected a step of a transform"},
  };
  for (const auto& [step, message] : cases)
    EXPECT_EQ(folder
                  .error("<shape type=\"cube\"><transform name=\"to_world\">\n" +
                         std::string(step) + "</transform></shape>")
                  .find("scene.xml:" + std::string(message)),
              0u)
        << step;
}

// Mitsuba 3.9.1, a square at z = 0 seen from (0.3, 0.1, 5): geometric and shading normal.
struct MeshCase {
  const char* file;
  const char* properties;
  Vec3 n_g, n_s;
};

TEST(Meshes, NormalsAsMitsubaShowsThem) {
  SceneFolder folder;
  const std::string v = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
  folder.write("plain.obj", v + "f 1 2 3 4\n");
  folder.write("normals.obj", v + "vn 0 0.6 0.8\nf 1//1 2//1 3//1 4//1\n");
  folder.write("mixed.obj", v + "vn 0 0 2\nf 1//1 2//1 3 4\n");
  // A file whose normals contradict its winding: they decide.
  folder.write("against.obj", v + "vn 0 0.6 -0.8\nf 1//1 2//1 3//1 4//1\n");
  const char* face = R"(<boolean name="face_normals" value="true"/>)";
  const Vec3 up(0, 0, 1), down(0, 0, -1), tilted(0, 0.6, 0.8), below(0, 0.6, -0.8);
  const MeshCase cases[] = {
      {"plain.obj", "", up, up},
      {"plain.obj", face, up, up},
      {"plain.obj", kFlip, down, down},
      {"plain.obj", kMirror, down, down},
      {"normals.obj", "", up, tilted},
      {"normals.obj", face, up, up},
      {"normals.obj", kFlip, down, -tilted},
      {"normals.obj", kMirror, up, tilted},
      {"mixed.obj", "", up, up},
      {"against.obj", "", down, below},
      {"against.obj", face, up, up},
  };
  for (const MeshCase& c : cases) {
    SCOPED_TRACE(std::string(c.file) + " " + c.properties);
    const Surface s = load_shape(
        folder, "obj",
        "<string name=\"filename\" value=\"" + std::string(c.file) + "\"/>" + c.properties);
    const SurfacePoint x = meet(*s.shape, Vec3(0.3, 0.1, 5), Vec3(0, 0, -1));
    expect_near(x.n_g, c.n_g);
    expect_near(x.shading.n, c.n_s, 0x1p-24);  // meshes keep their normals in single precision
  }
}

/// They stay across what is stretched: a triangle of the plane x + y = 0 becomes one of
/// x/3 + y = 0.
TEST(Meshes, NormalsStayAcrossStretchedSurfaces) {
  SceneFolder folder;
  folder.write("slope.obj", "v 0 0 0\nv -1 1 0\nv 0 0 1\nvn 1 1 0\nf 1//1 2//1 3//1\n");
  const Surface s = load_shape(folder, "obj",
                               R"(<string name="filename" value="slope.obj"/>
      <transform name="to_world"><scale x="3"/></transform>)");
  const SurfacePoint x = s.shape->surface_point(0, Vec2(0.3));
  expect_near(x.n_g, normalize(Vec3(1, 3, 0)), 1e-7);
  expect_near(x.shading.n, normalize(Vec3(1, 3, 0)), 0x1p-23);
}

/// Vertices that have none get that of the faces around them, the others keep the file's.
TEST(Meshes, MissingNormalsAreFilledInAlone) {
  SceneFolder folder;
  folder.write("some.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.6 0.8\nf 1//1 2//1 3\n");
  const Surface s = load_shape(folder, "obj", R"(<string name="filename" value="some.obj"/>)");
  expect_near(s.shape->surface_point(0, Vec2(0)).shading.n, Vec3(0, 0.6, 0.8), 0x1p-23);
  expect_near(s.shape->surface_point(0, Vec2(1, 0)).shading.n, Vec3(0, 0.6, 0.8), 0x1p-23);
  expect_near(s.shape->surface_point(0, Vec2(0, 1)).shading.n, Vec3(0, 0, 1), 0x1p-23);
  // In between it counts as much as those of the file.
  expect_near(s.shape->surface_point(0, Vec2(0, 0.5)).shading.n,
              normalize(Vec3(0, 0.6, 0.8) + Vec3(0, 0, 1)), 0x1p-22);
}

TEST(Meshes, AreSmoothUnlessFaceNormals) {
  SceneFolder folder;
  const std::string tent =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float "
      "z\n"
      "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "-1 -1 -1\n1 -1 -1\n0 0 0\n0 1 -1\n3 0 1 2\n3 1 3 2\n";
  folder.write("tent.ply", tent);
  const std::string file = R"(<string name="filename" value="tent.ply"/>)";
  const Vec3 o(0, -0.3, 5);
  const auto smooth = meet(*load_shape(folder, "ply", file).shape, o, Vec3(0, 0, -1));
  const auto faceted = meet(
      *load_shape(folder, "ply", file + R"(<boolean name="face_normals" value="true"/>)").shape, o,
      Vec3(0, 0, -1));
  expect_near(smooth.n_g, faceted.n_g);
  expect_near(faceted.shading.n, faceted.n_g);
  EXPECT_GT(length(smooth.shading.n - smooth.n_g), 0.01);
}

TEST(Meshes, TextureCoordinatesFlipInObjAlone) {
  SceneFolder folder;
  folder.write("uv.obj", "v -1 -1 0\nv 1 -1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
  folder.write("uv.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float "
               "y\nproperty float z\n"
               "property float u\nproperty float v\nelement face 1\nproperty list uchar int "
               "vertex_indices\nend_header\n"
               "-1 -1 0 0 0\n1 -1 0 1 0\n-1 1 0 0 1\n3 0 1 2\n");
  const auto uv = [&](const std::string& type, const std::string& extra) {
    const Surface s =
        load_shape(folder, type, "<string name=\"filename\" value=\"uv." + type + "\"/>" + extra);
    return meet(*s.shape, Vec3(-0.5, -0.8, 5), Vec3(0, 0, -1)).uv;
  };
  const Vec2 straight(0.25, 0.1), flipped(0.25, 0.9);
  EXPECT_NEAR(length(uv("obj", "") - flipped), 0, 1e-12);
  EXPECT_NEAR(length(uv("ply", "") - straight), 0, 1e-12);
  EXPECT_NEAR(length(uv("obj", R"(<boolean name="flip_tex_coords" value="false"/>)") - straight), 0,
              1e-12);
}

TEST(Surfaces, RememberWhereTheyStand) {
  SceneFolder folder;
  const auto scene = folder.load("<shape type=\"sphere\"/>\n  <shape id=\"box\" type=\"cube\"/>");
  EXPECT_EQ(scene.surfaces[1].id, "box");
  EXPECT_EQ(to_string(scene.surfaces[1].where), folder.path("scene.xml").string() + ":3:3");
  EXPECT_EQ(scene.title, folder.path("scene.xml").string());
}

const std::string kGroup = R"(<shape type="shapegroup" id="g">
  <shape type="sphere"><float name="radius" value="2"/><bsdf type="diffuse" id="b"/>
    <transform name="to_world"><translate x="1"/></transform></shape>
  <shape type="disk"><ref id="b"/></shape></shape>)";

std::string instance_of(const std::string& id, const std::string& steps) {
  return "<shape type=\"instance\"><ref id=\"" + id + "\"/><transform name=\"to_world\">" + steps +
         "</transform></shape>";
}

TEST(Instance, IsItsGroupInAnotherPlace) {
  SceneFolder folder;
  const std::string turn = R"(<scale value="3"/><rotate z="1" angle="90"/><translate z="5"/>)";
  const auto scene =
      folder.load(kGroup + instance_of("g", turn) + instance_of("g", "<translate y=\"9\"/>"));
  EXPECT_TRUE(folder.warnings.empty());
  ASSERT_EQ(scene.surfaces.size(), 4u);
  expect_near(scene.surfaces[0].shape->bounds().center(), Vec3(0, 3, 5));
  EXPECT_NEAR(scene.surfaces[0].shape->area(), 4 * kPi * 36, 1e-9);
  EXPECT_NEAR(scene.surfaces[1].shape->area(), 9 * kPi, 1e-12);
  expect_near(scene.surfaces[2].shape->bounds().center(), Vec3(1, 9, 0));
  for (const Surface& s : scene.surfaces) EXPECT_EQ(s.bsdf, scene.surfaces[0].bsdf);
  const auto once = folder.load(kGroup + instance_of("g", turn));
  EXPECT_NE(once.content_hash, scene.content_hash);
  EXPECT_NE(folder.load(kGroup + instance_of("g", "")).content_hash, once.content_hash);
  EXPECT_TRUE(folder.load(kGroup).surfaces.empty());
}

/// As in Mitsuba 3.9.1, where the same mirroring of the shape itself turns a sphere, and a mesh
/// without normals, inside out.
TEST(Instance, ThatIsMirroredKeepsItsOutside) {
  SceneFolder folder;
  folder.write("tent.obj",
               "v -1 -1 -1\nv 1 -1 -1\nv 0 1 -1\nv 0 0 1\n"
               "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const std::string mesh = R"(<string name="filename" value="tent.obj"/>)";
  const std::string flat = mesh + R"(<boolean name="face_normals" value="true"/>)";
  const std::pair<const char*, std::string> cases[] = {
      {"sphere", ""}, {"obj", mesh}, {"obj", flat}, {"cube", ""}};
  for (const auto& [type, properties] : cases)
    for (const char* turn : {"<scale x=\"-1\"/>", "<scale value=\"-1\"/>", "<scale value=\"2\"/>"})
      for (const bool flip : {false, true}) {
        const auto scene = folder.load(
            std::string("<shape type=\"shapegroup\" id=\"g\"><shape type=\"") + type + "\">" +
            properties + (flip ? kFlip : "") + "</shape></shape>" + instance_of("g", turn));
        const SurfacePoint x =
            meet(*scene.surfaces.at(0).shape, Vec3(0.1, 0.05, 9), Vec3(0, 0, -1));
        EXPECT_GT((flip ? -1 : 1) * x.n_g.z, 0) << type << ' ' << turn << ' ' << flip;
        EXPECT_GT(dot(x.n_g, x.shading.n), 0) << type << ' ' << turn << ' ' << flip;
      }
}

/// A ray that is moved along meets the same point of an instance, from the same side, with the same
/// texture coordinates and media: of every type, with a place of its own within the group, and of
/// instances that are turned, mirrored and scaled.
TEST(Instance, IsMetWhereRaysMovedBackMeetItsGroup) {
  SceneFolder folder;
  folder.write("patch.obj",
               "v -1 -1 0.2\nv 1 -1 0\nv 1 1 0.4\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
               "vn 0.2 0 1\nvn 0 0.3 1\nf 1/1/1 2/2/2 3/3/1 4/4/2\n");
  folder.write("plain.obj",
               "v -1 -1 0.2\nv 1 -1 0\nv 1 1 0.4\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\n");
  const std::string own = R"(<transform name="to_world"><scale value="0.8"/>
      <rotate x="1" y="0.5" angle="30"/><translate x="0.2" y="-0.1"/></transform>)";
  const std::string media = R"(<medium type="homogeneous" name="interior" id="in"/>
      <medium type="homogeneous" name="exterior" id="out"/>)";
  const std::pair<const char*, std::string> types[] = {
      {"sphere", ""},
      {"rectangle", ""},
      {"cube", ""},
      {"disk", ""},
      {"cylinder", ""},
      {"obj", R"(<string name="filename" value="patch.obj"/>)"},
      {"obj", R"(<string name="filename" value="plain.obj"/>)"}};
  const Transform rest =
      Transform::translate(Vec3(3, 1, -2)) * Transform::rotate(Vec3(0, 1, 1), 70);
  const std::pair<std::string, Transform> turns[] = {
      {R"(<scale value="2"/>)", rest * Transform::scale(Vec3(2))},
      {R"(<scale x="-2" y="2" z="2"/>)", rest * Transform::scale(Vec3(-2, 2, 2))}};
  for (const auto& [type, properties] : types) {
    const std::string shape =
        std::string("<shape type=\"") + type + "\">" + properties + own + media + "</shape>";
    const Surface alone = folder.load(shape).surfaces.at(0);
    for (const auto& [step, T] : turns) {
      SCOPED_TRACE(std::string(type) + properties + step);
      const Surface s = folder
                            .load("<shape type=\"shapegroup\" id=\"g\">" + shape + "</shape>" +
                                  instance_of("g", step + R"(<rotate y="1" z="1" angle="70"/>
                                              <translate x="3" y="1" z="-2"/>)"))
                            .surfaces.at(0);
      EXPECT_EQ(s.interior->id(), "in");
      EXPECT_EQ(s.exterior->id(), "out");
      EXPECT_NEAR(s.shape->area(), 4 * alone.shape->area(), 1e-6 * alone.shape->area());
      int met = 0;
      for (int i = 0; i < 200; ++i) {
        Rng rng(1, RngDomain::Test, static_cast<std::uint64_t>(i), 0);
        const Vec3 o = 5.0 * normalize(uniform3(rng) - 0.5);
        const Vec3 d = normalize(1.5 * (uniform3(rng) - 0.5) - o);
        const auto x = first_point(*alone.shape, o, d);
        const auto y = first_point(*s.shape, T.point(o), normalize(T.vector(d)));
        ASSERT_EQ(x.has_value(), y.has_value());
        if (!x) continue;
        ++met;
        expect_near(y->position, T.point(x->position), 1e-6);
        expect_near(y->n_g, normalize(T.normal(x->n_g)), 1e-6);
        expect_near(y->shading.n, normalize(T.normal(x->shading.n)), 1e-6);
        EXPECT_NEAR(length(Vec3(y->uv - x->uv, 0)), 0, 1e-6);
        for (const int axis : {0, 1})
          expect_near(s.shape->uv_tangents(*y)[axis], T.vector(alone.shape->uv_tangents(*x)[axis]),
                      1e-5);
      }
      EXPECT_GT(met, 20);
    }
  }
}

TEST(Instance, ComplainsOfWhatCannotBeInstanced) {
  SceneFolder folder;
  const auto complains = [&](const std::string& body, const char* message) {
    const std::string text = folder.error(body);
    EXPECT_NE(text.find(message), std::string::npos) << text;
  };
  complains("<shape type=\"instance\"/>", "2:1: an instance needs a shape of type \"shapegroup\"");
  complains("<shape type=\"sphere\" id=\"s\"/>" + instance_of("s", ""), "needs a shape of type");
  complains(R"(<shape type="shapegroup" id="g"><shape type="sphere"><emitter type="area"/></shape>
            </shape>)" +
                instance_of("g", ""),
            "2:54: shapes that emit light cannot be instanced");
  complains(kGroup + "<shape type=\"shapegroup\" id=\"h\">" + instance_of("g", "") + "</shape>" +
                instance_of("h", ""),
            "groups and instances do not stand in groups");
  complains(R"(<shape type="shapegroup" id="g"><shape type="instance"><ref id="g"/></shape>
            </shape>)" +
                instance_of("g", ""),
            "groups and instances do not stand in groups");
}

}  // namespace
}  // namespace fogbow
