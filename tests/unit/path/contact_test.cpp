// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces at one and the same place: walls at which fog ends, a floor under glass, volumes that
// share a face. What rays meet and come through is compared with closed forms.
#include "core/scene/contact.h"

#include <gtest/gtest.h>

#include "core/scene/covered_border.h"
#include "mlt/render.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/path/volume_scenes.h"

namespace fogbow {
namespace {

using namespace testing;

constexpr int kRays = 4000;

std::shared_ptr<const Bsdf> wall() { return make_twosided(make_diffuse(RGB(0.5))); }

/// As it stands, and where no coordinate is a round number.
class Contact : public ::testing::TestWithParam<bool> {
 protected:
  Contact() {
    if (GetParam())
      place_ = Transform::translate({3.1, -2.3, 0.7}) * Transform::rotate({1, 2, 3}, 77) *
               Transform::scale(Vec3(1.3));
  }
  Vec3 world(const Vec3& p) const { return place_.point(p); }
  double unit() const { return GetParam() ? 1.3 : 1; }

  /// The six walls of [−1,1]³, of which one may be left out.
  std::vector<Surface> room(int without = -1) const {
    std::vector<Surface> walls;
    for (int i = 0; i < 6; ++i) {
      if (i == without) continue;
      const Vec3 axis(i % 3 == 0, i % 3 == 1, i % 3 == 2);
      const Transform turn =
          i % 3 == 2 ? Transform()
                     : Transform::rotate(i % 3 == 0 ? Vec3(0, 1, 0) : Vec3(1, 0, 0), 90);
      const Transform at = Transform::translate((i < 3 ? 1.0 : -1.0) * axis);
      walls.push_back(surface(make_rectangle(place_ * at * turn), wall()));
    }
    return walls;
  }

  void expect_one_interface(const Scene& scene, const Medium* below, const Medium* above, bool up,
                            Rng& rng) const;

  Transform place_;
};
INSTANTIATE_TEST_SUITE_P(Turned, Contact, ::testing::Bool());

Vec3 inside(Rng& rng) { return 1.98 * uniform3(rng) - 0.99; }

Vec3 direction(Rng& rng) {
  const double z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(), r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// From p in [−1,1]³ along d to its boundary.
double to_wall(const Vec3& p, const Vec3& d) {
  double t = kInfinity;
  for (int i = 0; i < 3; ++i) t = std::min(t, ((d[i] > 0 ? 1 : -1) - p[i]) / d[i]);
  return t;
}

TEST_P(Contact, FogThatEndsAtWallsFillsTheRoom) {
  const MediumPointer haze = fog(RGB(0.3, 0.7, 1.1), "haze");
  std::vector<Surface> surfaces = room();
  surfaces.push_back(boundary(make_cube(place_), haze, nullptr));
  const Scene scene(describe_scene(std::move(surfaces), world({0.3, 0.2, 0.9})));
  Rng rng(suite_seed(), RngDomain::Test, 50, 0);
  for (int i = 0; i < kRays; ++i) {
    const Vec3 p = inside(rng), d = direction(rng);
    const Vec3 w = normalize(world(p + d) - world(p));
    Vertex x, y;
    Edge edge;
    ASSERT_EQ(extend_to_surface(scene, point_at(world(p), haze.get()), w, x, edge),
              ExtendResult::Reached);
    const double t = to_wall(p, d);
    ASSERT_NEAR(edge.length, unit() * t, 1e-9);
    ASSERT_TRUE(scene.surface(x.id.shape).bsdf->has_smooth());
    ASSERT_LT(max_component(glm::abs(edge.tau - glm::exp(-unit() * t * RGB(0.3, 0.7, 1.1)))), 1e-9);
    // And back from the wall to another.
    const Vec3 q = p + t * d;
    const Vec3 back = normalize(inside(rng) - q);
    ASSERT_EQ(extend_to_surface(scene, x, normalize(world(q + back) - world(q)), y, edge),
              ExtendResult::Reached);
    const double far = to_wall(p + (t - 1e-9) * d, back);
    ASSERT_NEAR(edge.length, unit() * far, 1e-6);
    ASSERT_LT(max_component(glm::abs(edge.tau - glm::exp(-unit() * far * RGB(0.3, 0.7, 1.1)))),
              1e-6);
    const auto seen = connect(scene, x, y), from_y = connect(scene, y, x);
    ASSERT_TRUE(seen && from_y);
    ASSERT_LT(max_component(glm::abs(seen->tau - edge.tau)), 1e-9);
    ASSERT_LT(max_component(glm::abs(from_y->tau - edge.tau)), 1e-9);
  }
}

/// Light that leaves a lamp in the ceiling is in the fog below it.
TEST_P(Contact, LampsFlushWithFogShineIntoIt) {
  const MediumPointer haze = fog(RGB(0.5), "haze");
  std::vector<Surface> surfaces = room();
  Surface lamp =
      surface(make_rectangle(place_ * Transform::translate({0.2, 1, 0.1}) *
                             Transform::rotate({1, 0, 0}, 90) * Transform::scale({0.2, 0.2, 1})),
              make_diffuse(RGB(0)));
  lamp.emitter = make_area_emitter(lamp.shape, RGB(1));
  surfaces.erase(surfaces.begin() + 1);  // the ceiling
  surfaces.push_back(lamp);
  surfaces.push_back(boundary(make_cube(place_), haze, nullptr));
  const Scene scene(describe_scene(std::move(surfaces), world({0.3, 0.2, 0.9})));
  const SurfacePoint x = lamp.shape->sample(Vec2(0.3, 0.6));
  EXPECT_EQ(scene.medium_around_emitter(0, x.position, {5, x.primitive}), haze.get());
}

/// A lamp as high as the ceiling is seen where it is, and so is light that comes back to it.
TEST_P(Contact, LampsFlushWithWallsAreSeen) {
  std::vector<Surface> surfaces = room();
  const Transform ceiling = place_ * Transform::translate({0.2, 1, 0.1}) *
                            Transform::rotate({1, 0, 0}, 90) * Transform::scale({0.3, 0.2, 1});
  Surface lamp = surface(make_rectangle(ceiling), make_diffuse(RGB(0)));
  lamp.emitter = make_area_emitter(lamp.shape, RGB(1));
  surfaces.push_back(lamp);
  const Scene scene(describe_scene(std::move(surfaces), world({0.3, 0.2, 0.9})));
  Rng rng(suite_seed(), RngDomain::Test, 55, 0);
  int seen = 0;
  for (int i = 0; i < kRays; ++i) {
    Vec3 p = inside(rng), q = inside(rng);
    q.y = 1;
    Vertex x;
    Edge edge;
    ASSERT_EQ(extend_to_surface(scene, point_at(world(p)), normalize(world(q) - world(p)), x, edge),
              ExtendResult::Reached);
    ASSERT_NEAR(edge.length, unit() * length(q - p), 1e-6);
    const bool at_lamp = std::abs(q.x - 0.2) < 0.3 && std::abs(q.z - 0.1) < 0.2;
    ASSERT_EQ(scene.emitter_of_surface(x.id.shape) >= 0, at_lamp) << q.x << ", " << q.z;
    seen += at_lamp;
  }
  EXPECT_GT(seen, kRays / 50);
}

/// Glass on a floor: from within, down is the floor, everywhere.
TEST_P(Contact, FloorsAreSeenFromWithinTheGlassOnThem) {
  const auto glass = make_dielectric(1.5);
  std::vector<Surface> surfaces{
      surface(make_rectangle(place_ * Transform::scale({4, 4, 1})), wall())};
  surfaces.push_back(surface(make_cube(place_ * Transform::translate({0, 0, 1})), glass));
  surfaces.push_back(surface(make_cylinder({3, 0, 0}, {3, 0, 1}, 0.5, place_), glass));
  for (const double z : {0.0, 1.0})
    surfaces.push_back(surface(
        make_disk(place_ * Transform::translate({3, 0, z}) * Transform::scale(Vec3(0.5)), z == 0),
        glass));
  const Scene scene(describe_scene(std::move(surfaces), world({0.3, 0.2, 9})));
  Rng rng(suite_seed(), RngDomain::Test, 51, 0);
  for (int i = 0; i < kRays; ++i) {
    const bool in_cube = i % 2 == 0;
    const Vec2 u(2 * rng.uniform() - 1, 2 * rng.uniform() - 1);
    const Vec3 foot = in_cube ? Vec3(0.99 * u, 0) : Vec3(3 + 0.35 * u.x, 0.35 * u.y, 0);
    const Vec3 p = foot + Vec3(0, 0, 0.1 + 0.8 * rng.uniform());
    Vertex x, up;
    Edge edge;
    ASSERT_EQ(
        extend_to_surface(scene, point_at(world(p)), normalize(world(foot) - world(p)), x, edge),
        ExtendResult::Reached);
    ASSERT_EQ(x.id.shape, 0u) << "at " << foot.x << ", " << foot.y;
    ASSERT_EQ(extend_to_surface(scene, x, normalize(world(p) - world(foot)), up, edge),
              ExtendResult::Reached);
    ASSERT_NEAR(edge.length, unit() * (in_cube ? 2 : 1), 1e-6);
    ASSERT_NE(up.id.shape, 0u);
  }
}

/// Optical depth on the way from p to q through what is −h ≤ x, y ≤ h and z0 ≤ z ≤ z1.
double in_box(const Vec3& p, const Vec3& q, double h, double z0, double z1) {
  const Transform box =
      Transform::translate({0, 0, 0.5 * (z0 + z1)}) * Transform::scale({h, h, 0.5 * (z1 - z0)});
  const Mat4 back = box.inverse_matrix();
  const Vec3 a(back * Vec4(p, 1)), b(back * Vec4(q, 1));
  return length(q - p) * size(in_cube(a, b - a));
}

/// Volumes that share a face: light is in the one on its side of it, whatever way it goes.
TEST_P(Contact, VolumesThatShareAFaceFillTheirSides) {
  const RGB of_a(0.7, 1.1, 1.9), of_b(2.3, 0.4, 0.9);
  const MediumPointer a = fog(of_a, "a"), b = fog(of_b, "b");
  const auto box = [&](double h, double z0, double z1) {
    return make_cube(place_ * Transform::translate({0, 0, 0.5 * (z0 + z1)}) *
                     Transform::scale({h, h, 0.5 * (z1 - z0)}));
  };
  // b stands on a, and is narrower; within a lies, on a's bottom, another of b.
  const Scene scene(
      describe_scene({boundary(box(1, -1, 0), a, nullptr), boundary(box(0.6, 0, 1), b, nullptr),
                      boundary(box(0.5, -1, -0.6), b, a)},
                     world({0.3, 0.2, 9})));
  EXPECT_TRUE(scene.warnings().empty());
  Rng rng(suite_seed(), RngDomain::Test, 53, 0);
  double worst = 0;
  for (int i = 0; i < kRays; ++i) {
    const auto outside = [&] { return 3.0 * normalize(direction(rng)); };
    const Vec3 p = outside(), q = outside();
    const double low = in_box(p, q, 0.5, -1, -0.6);
    const RGB depth =
        (in_box(p, q, 1, -1, 0) - low) * of_a + (low + in_box(p, q, 0.6, 0, 1)) * of_b;
    const auto there = connect(scene, point_at(world(p)), point_at(world(q))),
               back = connect(scene, point_at(world(q)), point_at(world(p)));
    ASSERT_TRUE(there && back);
    const RGB expected = glm::exp(-unit() * depth);
    worst = std::max(worst, max_component(glm::abs(there->tau - expected)));
    worst = std::max(worst, max_component(glm::abs(back->tau - expected)));
  }
  EXPECT_LT(worst, 1e-6);
}

/// Nearer to an edge than surfaces touch a wedge is thinner than that.
TEST_P(Contact, WedgesThatShareAFaceHoldAtTheirEdge) {
  TriangleMeshData wedge;
  for (const double y : {-1.0, 1.0})
    for (const Vec2& xz : {Vec2(0, 0), Vec2(2, 0), Vec2(2, 0.2)})
      wedge.positions.push_back(world({xz.x, y, xz.y}));
  wedge.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1},
                     {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}};
  const MediumPointer a = fog(RGB(0.5), "a"), b = fog(RGB(0.8), "b");
  const auto below =
      make_cube(place_ * Transform::translate({0, 0, -1}) * Transform::scale({3, 3, 1}));
  const Scene scene(describe_scene(
      {boundary(make_mesh(wedge), a, nullptr), boundary(below, b, nullptr)}, world({0.3, 0.2, 9})));
  EXPECT_TRUE(scene.warnings().empty());
  for (int i = -20; i < kRays; ++i) {
    const double x = i < 0 ? 0.5 : 1e-9 * (i + 0.5);  // at 0 a ray lies in the edge
    const auto edge =
        connect(scene, point_at(world({x, 0.1, 1})), point_at(world({x, 0.1, -0.5}), b.get()));
    ASSERT_TRUE(edge);
    ASSERT_NEAR(edge->tau.x, std::exp(-unit() * (0.5 * 0.8 + 0.1 * x * 0.5)), 1e-5) << x;
  }
}

/// Between n = 1.5 below z = 0 and 1.2 above it.
void Contact::expect_one_interface(const Scene& scene, const Medium* below, const Medium* above,
                                   bool up, Rng& rng) const {
  Vec3 p = inside(rng), q = inside(rng);
  p.z = up ? -1 : 1;
  q.z = 0;
  Vertex x, y;
  Edge edge;
  const Vec3 w = normalize(world(q) - world(p));
  ASSERT_EQ(extend_to_surface(scene, point_at(world(p), up ? below : above), w, x, edge),
            ExtendResult::Reached);
  ASSERT_NEAR(edge.length, unit() * length(q - p), 1e-5);
  const bool outwards = dot(w, x.point.n_g) > 0;
  ASSERT_NEAR(std::log(scene.surface(x.id.shape).bsdf->eta()),
              std::log(up == outwards ? 1.5 / 1.2 : 1.2 / 1.5), 1e-12);
  ASSERT_EQ(medium_toward(scene, x, w), up ? above : below);
  ASSERT_EQ(extend_to_surface(scene, x, w, y, edge), ExtendResult::Reached);
  ASSERT_GT(edge.length, 1e-3 * unit());  // to another side, not to a second face here
}

/// Glass on glass, of which one may name no media, and where files round a little apart or a little
/// into it: one interface between the two, whichever way light comes.
TEST_P(Contact, GlassOnGlassRefractsOnce) {
  const MediumPointer a = fog(RGB(0.1), "a"), named = fog(RGB(0.2), "b");
  for (const MediumPointer& b : {named, MediumPointer()})
    for (const double apart : {0.0, 1e-7, -1e-7}) {
      const auto above = make_cube(place_ * Transform::translate({0, 0, 1 + apart}));
      const auto glass = make_dielectric(1.2);
      const Scene scene(
          describe_scene({boundary(make_cube(place_ * Transform::translate({0, 0, -1})), a, nullptr,
                                   0, make_dielectric(1.5)),
                          b ? boundary(above, b, nullptr, 0, glass) : surface(above, glass)},
                         world({0.3, 0.2, 9})));
      SCOPED_TRACE(apart);
      Rng rng(suite_seed(), RngDomain::Test, 54, 0);
      for (int i = 0; i < kRays; ++i)
        expect_one_interface(scene, a.get(), b.get(), i % 2 == 0, rng);
    }
}

TEST_P(Contact, SurfacesApartAreLeftAlone) {
  std::vector<Surface> surfaces = room();
  surfaces.push_back(boundary(make_cube(place_ * Transform::scale(Vec3(1 - 1e-5))),
                              fog(RGB(0.5), "haze"), nullptr));
  const Scene scene(describe_scene(std::move(surfaces), world({0.3, 0.2, 0.9})));
  Rng rng(suite_seed(), RngDomain::Test, 52, 0);
  for (int i = 0; i < 100; ++i) {
    const Vec3 p = inside(rng), d = direction(rng);
    const auto hit =
        scene.accel().intersect({world(p), normalize(world(p + d) - world(p)), 0, kInfinity});
    ASSERT_TRUE(hit);
    ASSERT_EQ(hit->id.shape, 6u);  // the boundary, not the wall behind it
  }
}

/// A lamp so small in the side of a box of fog that points spread over the side miss it.
TEST_P(Contact, SmallLampsInLargeFacesAreSeen) {
  const MediumPointer haze = fog(RGB(0.5), "haze");
  const double half = 1e-3;
  Surface lamp =
      surface(make_rectangle(place_ * Transform::translate({0.2345, -1, 0.3456}) *
                             Transform::rotate({1, 0, 0}, -90) * Transform::scale({half, half, 1})),
              make_diffuse(RGB(0)));
  lamp.emitter = make_area_emitter(lamp.shape, RGB(1));
  const Scene scene(
      describe_scene({boundary(make_cube(place_), haze, nullptr), lamp}, world({0.3, 0.2, 9})));
  Rng rng(suite_seed(), RngDomain::Test, 56, 0);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = inside(rng);
    const Vec2 u = 1.98 * uniform2(rng) - 0.99;
    const Vec3 q = Vec3(0.2345, -1, 0.3456) + half * Vec3(u.x, 0, u.y);
    Vertex x;
    Edge edge;
    ASSERT_EQ(extend_to_surface(scene, point_at(world(p), haze.get()),
                                normalize(world(q) - world(p)), x, edge),
              ExtendResult::Reached);
    ASSERT_GE(scene.emitter_of_surface(x.id.shape), 0);
    ASSERT_EQ(medium_toward(scene, x, normalize(world(p) - world(q))), haze.get());
  }
}

/// A sheet that glows and lets light through in part is no wall, nor does a wall hide it.
TEST(Contacts, LeaveWhatShinesAndLetsLightThrough) {
  Surface lamp = surface(make_rectangle(Transform()), make_mask(make_diffuse(RGB(0.5)), 0.5));
  lamp.emitter = make_area_emitter(lamp.shape, RGB(1));
  for (const auto& other : {wall(), make_null()}) {
    const std::vector<Surface> surfaces{
        lamp, surface(make_rectangle(Transform::scale({3, 3, 1})), other)};
    EXPECT_TRUE(Contacts(surfaces, {surfaces[0].shape, surfaces[1].shape}).covered().empty());
  }
}

TEST(Contacts, KnowWhatIsOpaque) {
  PrincipledSettings clear;
  clear.spec_trans = 1.0;
  const std::pair<std::shared_ptr<const Bsdf>, bool> all[] = {
      {make_diffuse(RGB(0.5)), true},
      {wall(), true},
      {make_conductor(RGB(0), RGB(1)), true},
      {make_dielectric(1.5), false},
      {make_rough_dielectric({MicrofacetKind::Ggx, 0.2, 0.2}, 1.5), false},
      {make_thin_dielectric(1.5), false},
      {make_mask(make_diffuse(RGB(0.5)), 0.5), false},
      {make_null(), false},
      {make_principled(clear), false}};
  for (const auto& [bsdf, opaque] : all)
    EXPECT_EQ(is_opaque(surface(make_rectangle(Transform()), bsdf)), opaque) << bsdf->name();
}

/// The border of a sheet along y at x = 0; walls stand beside it. Both of its sides have to be shut
/// off, and behind the corner of a room only a slanting way meets a wall.
TEST(Contacts, FindBordersCoveredWhereWallsShutOffBothSides) {
  const auto stands_at = [](double x, double y0, double y1, double z0, double z1) {
    const Vec3 middle(x, (y0 + y1) / 2, (z0 + z1) / 2);
    return surface(make_rectangle(Transform::translate(middle) * Transform::rotate({0, 1, 0}, 90) *
                                  Transform::scale({(z1 - z0) / 2, (y1 - y0) / 2, 1})),
                   wall());
  };
  const auto covered = [&](std::vector<Surface> walls, double length) {
    // Whatever is measured in parts of the scene's size.
    walls.push_back(surface(make_rectangle(Transform::translate({0, 0, 5})), wall()));
    walls.push_back(surface(make_rectangle(Transform::translate({0, 0, -5})), wall()));
    std::vector<const Shape*> shapes;
    for (const Surface& s : walls) shapes.push_back(s.shape.get());
    return is_covered({0, {0, 0, 0}, {0, length, 0}, {1, 0, 0}, {0, 0, 1}}, walls, Accel(shapes));
  };
  EXPECT_TRUE(covered({stands_at(0.05, -1, 1, -1, 1)}, 0.3));
  EXPECT_FALSE(covered({}, 0.3));
  EXPECT_FALSE(covered({stands_at(2, -1, 1, -1, 1)}, 0.3));
  EXPECT_FALSE(covered({stands_at(0.05, -1, 1, -1, 0)}, 0.3));
  EXPECT_FALSE(covered({stands_at(0.05, -1, 1, 0, 1)}, 0.3));
  EXPECT_TRUE(covered({stands_at(0.05, -1, 1, -1, 0), stands_at(0.06, -1, 1, 0, 1)}, 0.3));
  EXPECT_FALSE(covered({stands_at(0.05, 0.12, 1, -1, 1)}, 0.3));
  EXPECT_TRUE(covered({stands_at(0.05, 0.05, 1, -1, 1)}, 0.2));
}

}  // namespace
}  // namespace fogbow
