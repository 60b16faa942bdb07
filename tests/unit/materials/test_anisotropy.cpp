// SPDX-License-Identifier: GPL-3.0-or-later
// α_u belongs to the direction in which the texture coordinate u grows, however shape and scene are
// turned.
#include <gtest/gtest.h>

#include "core/geometry/shapes.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/textures.h"

namespace fogbow {
namespace {

std::shared_ptr<const Shape> quad(const Transform& to_world, bool with_uv_and_normals) {
  TriangleMeshData mesh;
  for (const Vec3& p : {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)})
    mesh.positions.push_back(to_world.point(p));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  if (with_uv_and_normals) {
    mesh.uvs = {{0.1, 0.2}, {0.8, 0.5}, {0.6, 0.9}, {0.0, 0.7}};
    for (const Vec3& n :
         {Vec3(-0.2, -0.1, 1), Vec3(0.3, -0.2, 1), Vec3(0.2, 0.3, 1), Vec3(-0.1, 0.2, 1)})
      mesh.normals.push_back(normalize(to_world.normal(n)));
  }
  return make_mesh(mesh);
}

/// As Mitsuba's shapes of these names stand when turned by `turn`.
std::shared_ptr<const Shape> shape(const std::string& name, const Transform& turn) {
  const Transform stretched = turn * Transform::scale({1, 1.5, 0.7});
  if (name == "sphere") return make_sphere(Vec3(0), 1, false, Mat3(turn.inverse_matrix()));
  if (name == "rectangle") return make_rectangle(stretched);
  if (name == "disk") return make_disk(turn);
  if (name == "cylinder") return make_cylinder(Vec3(0), Vec3(0, 0, 1), 1, turn);
  return quad(stretched, name == "mesh");
}

/// Where the ray from outside along −`towards` meets the shape.
SurfacePoint seen_point(const Shape& on, const Vec3& near, const Vec3& towards) {
  SurfacePoint best;
  double first = kInfinity;
  for (std::uint32_t i = 0; i < on.primitive_count(); ++i)
    if (const auto hit = on.intersect(i, Ray{near + 4.0 * towards, -towards, 0, kInfinity}, false);
        hit && hit->t < first) {
      first = hit->t;
      best = on.surface_point(i, hit->local);
    }
  EXPECT_LT(first, kInfinity);
  best.shape = &on;
  return best;
}

struct Value {
  const char* shape;
  Vec3 position, eye, light;
  double f;
};

/// Of Mitsuba 3.9.1's roughconductor (GGX, α_u = .5, α_v = .1, no material), in single precision,
/// on shapes turned by 77° about (0, .6, .8).
const std::vector<Value>& mitsuba_values() {
  static const std::vector<Value> values = {
      {"sphere", Vec3(-0.976546109, -0.174576104, -0.126019493),
       Vec3(-0.949820101, -0.0573559143, 0.30749312), Vec3(-0.518673444, 0.680309852, -0.517838164),
       0.122891},
      {"sphere", Vec3(-0.851136744, -0.265430659, -0.452894032),
       Vec3(-0.877821565, -0.476987183, -0.0437323451),
       Vec3(-0.354677651, 0.288736413, -0.889289069), 0.616592},
      {"rectangle", Vec3(-0.0093922969, 0.205853119, -0.0986033231),
       Vec3(-0.322565287, 0.801261783, 0.503915846), Vec3(0.874547734, -0.00448821903, 0.484918671),
       0.0782008},
      {"rectangle", Vec3(-0.0364123844, 0.534628153, -0.246339947),
       Vec3(0.553935647, 0.44269523, 0.705107212), Vec3(0.651448711, 0.373404664, 0.660441923),
       1.54266},
      {"disk", Vec3(-0.103186868, 0.235323995, -0.0377550684),
       Vec3(0.391356796, 0.900809884, -0.188099429), Vec3(-0.433153941, 0.20093174, 0.878637638),
       0.145433},
      {"disk", Vec3(0.0508276373, -0.424310416, 0.17772764),
       Vec3(-0.311213762, 0.834232509, 0.455194533), Vec3(0.748401413, 0.646137935, 0.149669948),
       0.25823},
      {"cylinder", Vec3(-0.480628431, -0.263738513, 0.872976184),
       Vec3(-0.860397458, -0.465894163, 0.206540123), Vec3(-0.725168011, -0.052649641, 0.686556168),
       0.0361375},
      {"cylinder", Vec3(0.138584867, -0.822104394, 0.58669579),
       Vec3(-0.401984721, -0.910515368, -0.0967990756),
       Vec3(0.404984126, -0.388159663, 0.827840524), 2.36858},
      {"mesh", Vec3(0.0935779139, 0.246462032, -0.203052625),
       Vec3(-0.0112173427, 0.0203185584, 0.999730647), Vec3(0.362104362, 0.874581223, 0.322471881),
       0.0807593},
      {"mesh", Vec3(-0.219747081, 0.0966914073, 0.128293738),
       Vec3(0.875569463, -0.34369275, 0.339489937), Vec3(-0.200583048, 0.963570426, 0.176913753),
       1.2848},
      {"bare", Vec3(0.0221629273, -0.175948068, 0.0728171617),
       Vec3(0.809309065, -0.495834976, 0.314907193), Vec3(-0.0323834843, 0.307944198, 0.950853133),
       0.0281604},
      {"bare", Vec3(0.699662805, -0.330723912, -0.39668268),
       Vec3(-0.0138439778, -0.216419891, 0.97620225), Vec3(0.951140008, 0.29716979, 0.0838021572),
       0.106975},
  };
  return values;
}

std::shared_ptr<const Bsdf> brushed_metal() {
  return make_rough_conductor({MicrofacetKind::Ggx, 0.5, 0.1}, RGB(0), RGB(1));
}

double value(const Bsdf& bsdf, const SurfacePoint& x, const Vec3& light, const Vec3& eye) {
  return bsdf.f_s(x, x.shading.to_local(light), x.shading.to_local(eye)).x;
}

TEST(Anisotropy, IsMitsubas) {
  const auto bsdf = brushed_metal();
  for (const Value& v : mitsuba_values()) {
    const auto on = shape(v.shape, Transform::rotate({0, 0.6, 0.8}, 77));
    const SurfacePoint x = seen_point(*on, v.position, v.eye);
    ASSERT_NEAR(length(x.position - v.position), 0, 1e-5) << v.shape;
    EXPECT_NEAR(value(*bsdf, x, v.light, v.eye), v.f, 1e-3 * v.f) << v.shape;
  }
}

/// Whatever the frame that directions are written in.
TEST(Anisotropy, TurnsWithTheShape) {
  PrincipledSettings settings;
  settings.anisotropic = 0.8;
  settings.metallic = 1.0;
  const Transform turn = Transform::rotate({1, 2, 3}, 130);
  for (const auto& bsdf :
       {brushed_metal(), make_rough_dielectric({MicrofacetKind::Beckmann, 0.5, 0.1}, 1.5),
        make_principled(settings)})
    for (const std::string name : {"sphere", "rectangle", "disk", "cylinder", "mesh"}) {
      const auto plain = shape(name, Transform()), turned = shape(name, turn);
      const Vec3 near(0.1, 0.2, 0.1), towards = normalize(Vec3(0.9, 0.7, 0.3));
      const SurfacePoint x = seen_point(*plain, near, towards);
      const SurfacePoint y = seen_point(*turned, turn.point(near), turn.vector(towards));
      ASSERT_NEAR(length(y.position - turn.point(x.position)), 0, 1e-6) << name;
      const Vec3 light = normalize(x.shading.to_world(Vec3(0.6, -0.3, 0.8))),
                 eye = normalize(x.shading.to_world(Vec3(-0.2, 0.5, 0.9)));
      const double expected = value(*bsdf, x, light, eye);
      EXPECT_GT(expected, 0);
      EXPECT_NEAR(value(*bsdf, y, turn.vector(light), turn.vector(eye)), expected, 1e-5 * expected)
          << bsdf->name() << " on " << name;
    }
}

/// The same metal within a normal map of (.6, .35, .9): its axes are the texture coordinates',
/// seen from the turned normal. Not on the mesh, whose normals stand off its faces: there Mitsuba's
/// axis is another.
TEST(Anisotropy, IsMitsubasWithinANormalMap) {
  const std::vector<Value> values = {
      {"sphere", Vec3(-0.470375508, 0.525511205, -0.708932221),
       Vec3(-0.0246721059, 0.625260413, -0.780026138),
       Vec3(-0.89839192, -0.380838294, -0.218755918), 4.71214},
      {"sphere", Vec3(-0.0137226731, -0.492753804, 0.870060623),
       Vec3(-0.121564798, -0.791553497, 0.59888649), Vec3(-0.228950339, -0.718356787, 0.656921052),
       1.42732},
      {"rectangle", Vec3(0.328388244, -0.288737506, -0.117292553),
       Vec3(0.941296518, -0.249494046, -0.227406234), Vec3(-0.300219421, 0.16473292, 0.939537846),
       0.689786},
      {"rectangle", Vec3(0.0315786861, 0.0923494697, -0.0732580796),
       Vec3(0.418051273, 0.214828521, 0.882656157), Vec3(0.456886962, -0.680756956, 0.572559404),
       0.339436},
      {"disk", Vec3(0.325511217, 0.0201000124, -0.274318367),
       Vec3(0.376970589, -0.177440748, 0.909069836), Vec3(-0.136161577, 0.310981802, 0.940611686),
       0.22681},
      {"disk", Vec3(0.188819587, -0.161463857, -0.0697932988),
       Vec3(0.338066459, 0.0238434691, 0.940820158), Vec3(0.8681197, -0.0505792794, 0.493771124),
       0.887379},
      {"cylinder", Vec3(-0.187309295, 1.00238907, -0.071282573),
       Vec3(-0.677047551, 0.398865163, -0.61847651), Vec3(0.459447188, 0.395266569, -0.795407205),
       0.03386},
      {"cylinder", Vec3(1.21143866, 0.0241114032, -0.0437979661),
       Vec3(0.584715903, -0.657181799, -0.475625187),
       Vec3(-0.0970088747, 0.288310201, -0.952610364), 0.0956331},
      {"bare", Vec3(0.0363413729, -0.290772438, 0.120569117),
       Vec3(0.387760282, -0.543673992, 0.74435246), Vec3(0.15500712, 0.965484944, -0.209312245),
       0.474779},
      {"bare", Vec3(0.50129503, -0.3356179, -0.233307168),
       Vec3(0.413119018, -0.665645778, 0.621488869), Vec3(0.518138972, -0.672146768, 0.52891467),
       0.0412459},
  };
  const auto bsdf = make_normal_map(brushed_metal(), make_constant_texture(RGB(0.6, 0.35, 0.9)),
                                    PerturbationSettings{});
  for (const Value& v : values) {
    const auto on = shape(v.shape, Transform::rotate({0, 0.6, 0.8}, 77));
    const SurfacePoint x = seen_point(*on, v.position, v.eye);
    ASSERT_NEAR(length(x.position - v.position), 0, 1e-5) << v.shape;
    EXPECT_NEAR(value(*bsdf, x, v.light, v.eye), v.f, 1e-3 * v.f) << v.shape;
  }
}

}  // namespace
}  // namespace fogbow
