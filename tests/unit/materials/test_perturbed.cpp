// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <random>
#include <stdexcept>

#include "core/geometry/accel.h"
#include "core/geometry/shapes.h"
#include "core/scene/textures.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/materials/bsdf_cases.h"
#include "tests/unit/materials/mitsuba_values_perturbed.h"

namespace fogbow {
namespace {

using testing::check_triple;
using testing::direction;
using testing::sphere_chart;

std::shared_ptr<const Texture> picture(int channels, std::vector<int> values) {
  Image image(
      3, 2,
      channels == 3 ? std::vector<std::string>{"R", "G", "B"} : std::vector<std::string>{"Y"});
  image.integers = true;
  for (std::size_t i = 0; i < values.size(); ++i)
    image.pixels[i] = static_cast<float>(values[i]) / 255;
  return make_bitmap_texture(image, {TextureFilter::Bilinear, TextureWrap::Repeat, true, {}});
}
std::shared_ptr<const Texture> normals() {
  return picture(
      3, {128, 128, 255, 200, 128, 200, 90, 60, 220, 128, 200, 200, 150, 100, 240, 60, 128, 190});
}
std::shared_ptr<const Texture> heights() { return picture(1, {0, 60, 120, 200, 90, 30}); }

std::shared_ptr<const Bsdf> nested(int which) {
  if (which == 0) return make_diffuse({0.2, 0.5, 0.8});
  return make_rough_conductor({MicrofacetKind::Ggx, 0.3, 0.3}, {0.2, 0.9, 1.1}, {3.9, 2.4, 2.2});
}

std::shared_ptr<const Bsdf> perturbed(int kind, bool flags, std::shared_ptr<const Bsdf> inside) {
  const PerturbationSettings settings{flags, flags};
  return kind == 0 ? make_normal_map(std::move(inside), normals(), settings)
                   : make_bump_map(std::move(inside), heights(), 0.7, settings);
}

std::shared_ptr<const Shape> shape(int which) {
  if (which == 0)
    return make_rectangle(Transform::rotate({0, 0, 1}, 30) * Transform::scale({2, 1, 1}));
  return make_sphere(Vec3(0), 1, false, Mat3(Transform::rotate({1, 0, 0}, 40).inverse_matrix()));
}

/// The point under (x, y, 5).
SurfacePoint point_below(const Shape& shape, const Vec2& xy) {
  const Shape* shapes[] = {&shape};
  const Accel accel(shapes);
  const auto hit = accel.intersect(Ray{Vec3(xy, 5), Vec3(0, 0, -1), 0, kInfinity});
  SurfacePoint x = shape.surface_point(hit->id.primitive, hit->local);
  x.shape = &shape;
  return x;
}

TEST(PerturbedValues, AreMitsubas) {
  int positive = 0;
  for (const auto& row : testing::mitsuba_perturbed_rows()) {
    const auto bsdf = perturbed(row.kind, row.flags, nested(row.nested));
    const auto on = shape(row.shape);
    const SurfacePoint x = point_below(*on, row.xy);
    const Vec3 eye = x.shading.to_local(row.eye), light = x.shading.to_local(row.light);
    const RGB f = bsdf->f_s(x, light, eye) * std::fabs(light.z);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(f[i], row.eval[i], 2e-3 * row.eval[i] + 1e-5);
    EXPECT_NEAR(bsdf->pdf_sigma(x, eye, light), row.pdf, 2e-3 * row.pdf + 1e-5);
    positive += row.pdf > 0;
  }
  EXPECT_GT(positive, 40);
}

TEST(PerturbedTriples, SamplePdfAndInvert) {
  for (const int kind : {0, 1})
    for (const int which : {0, 1})
      for (const double theta : {0.2, 0.9, 1.4}) {
        const auto bsdf = perturbed(kind, true, nested(which));
        const auto on = shape(1);
        const SurfacePoint x = point_below(*on, {0.2, -0.3});
        const Vec3 from = direction(theta, 2);
        const testing::Triple triple{3,
                                     [&](const Vec3& u) -> std::optional<Vec3> {
                                       const auto s = bsdf->sample(x, from, u);
                                       if (!s) return std::nullopt;
                                       return s->w;
                                     },
                                     [&](const Vec3& to) { return bsdf->pdf_sigma(x, from, to); },
                                     [&](const Vec3& to, const Vec3& auxiliary) {
                                       return bsdf->invert(x, from, to, false, auxiliary);
                                     }};
        EXPECT_EQ(check_triple("kind " + std::to_string(kind) + " nested " + std::to_string(which) +
                                   " from " + std::to_string(theta),
                               triple, sphere_chart(), {.mass = {}}),
                  "");
      }
}

/// Seen from a point and lit along its mirror image at the tilted normal, as a tilted surface is.
TEST(Perturbed, FlatMapsChangeNothing) {
  Image flat(1, 1, {"R", "G", "B"});
  flat.pixels = {0.5f, 0.5f, 1.0f};
  const auto bsdf = make_normal_map(nested(1), make_bitmap_texture(flat));
  const auto level = make_bump_map(nested(1), picture(1, {90, 90, 90, 90, 90, 90}));
  const auto on = shape(1);
  const SurfacePoint x = point_below(*on, {0.2, -0.3});
  const Vec3 a = direction(0.7, 1), b = direction(0.6, 4);
  const RGB f = nested(1)->f_s(x, a, b);
  EXPECT_NEAR(length(bsdf->f_s(x, a, b) - f), 0, 1e-6 * f.x);
  EXPECT_NEAR(length(level->f_s(x, a, b) - f), 0, 1e-12 * f.x);
  EXPECT_EQ(bsdf->roughness(), 1) << "facets are not those of the shading normal: nothing to hold";
}

/// Nor a flat height where the shading normal leans away from the surface: it is what bumps turn.
TEST(Perturbed, LevelHeightsKeepInterpolatedNormals) {
  TriangleMeshData leaning;
  leaning.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  leaning.triangles = {{0, 1, 2}};
  leaning.normals = {{0.3, -0.2, 1}, {0.4, 0.1, 1}, {-0.1, 0.3, 1}};
  const auto level = make_bump_map(nested(1), picture(1, {90, 90, 90, 90, 90, 90}));
  const auto on = make_mesh(leaning);
  SurfacePoint x = on->surface_point(0, {0.3, 0.2});
  x.shape = on.get();
  const Vec3 a = direction(0.7, 1), b = direction(0.6, 4);
  const RGB f = nested(1)->f_s(x, a, b);
  EXPECT_NEAR(length(level->f_s(x, a, b) - f), 0, 1e-12 * f.x);
}

/// A surface that is alike on both sides looks from behind as through a reflection at the point,
/// if its normals are turned to the viewer there as well.
TEST(Perturbed, LooksAlikeFromBehind) {
  const auto bsdf = perturbed(0, true, make_twosided(nested(1)));
  const auto on = shape(0);
  int turned = 0;
  for (const Vec2 xy : {Vec2(0.2, -0.3), Vec2(-0.5, 0.1), Vec2(0.6, 0.3)}) {
    const SurfacePoint x = point_below(*on, xy);
    for (const double theta : {0.3, 0.9, 1.5})
      for (const double phi : {0.5, 2.5, 4.5}) {
        const Vec3 light = direction(0.6, phi + 2.8), eye = direction(theta, phi);
        const RGB f = bsdf->f_s(x, light, eye);
        EXPECT_EQ(bsdf->f_s(x, -light, -eye), f);
        EXPECT_EQ(bsdf->pdf_sigma(x, -eye, -light), bsdf->pdf_sigma(x, eye, light));
        turned += !is_black(f);
      }
  }
  EXPECT_GT(turned, 20);
}

/// ∂p/∂u and ∂p/∂v against differences of what the shapes say themselves.
TEST(UvTangents, AreDerivatives) {
  TriangleMeshData mesh;
  mesh.positions = {{0, 0, 0}, {2, 0.5, 0.1}, {-0.3, 1, 0.4}};
  mesh.uvs = {{0.1, 0.2}, {0.7, 0.4}, {0.3, 0.9}};
  mesh.triangles = {{0, 1, 2}};
  for (const auto& on : {shape(0), shape(1), make_mesh(mesh),
                         make_cube(Transform::rotate({1, 2, 3}, 50) * Transform::scale({1, 2, 3}))})
    for (const Vec2 local : {Vec2(0.3, 0.2), Vec2(0.1, 0.45)}) {
      const SurfacePoint x = on->surface_point(0, local);
      const auto [u, v] = on->uv_tangents(x);
      constexpr double h = 1e-6;
      for (const Vec2 step : {Vec2(h, 0), Vec2(0, h)}) {
        const SurfacePoint a = on->surface_point(0, local - step),
                           b = on->surface_point(0, local + step);
        const Vec2 duv = b.uv - a.uv;
        EXPECT_NEAR(length(u * duv.x + v * duv.y - (b.position - a.position)), 0, 1e-9);
      }
    }
}

TEST(Perturbed, RefusesWhatItCannotDo) {
  EXPECT_THROW(make_normal_map(make_plastic(1.5), normals()), std::domain_error);
  EXPECT_THROW(make_bump_map(make_dielectric(1.5), heights()), std::domain_error);
  EXPECT_THROW(make_bump_map(nullptr, heights()), std::domain_error);
  EXPECT_THROW(make_bump_map(nested(0), nullptr), std::domain_error);
  EXPECT_THROW(make_bump_map(nested(0), heights(), kInfinity), std::domain_error);
  EXPECT_NO_THROW(make_twosided(make_bump_map(nested(0), heights())));
  EXPECT_THROW(make_twosided(make_bump_map(make_rough_dielectric({}, 1.5), heights())),
               std::domain_error);
}

}  // namespace
}  // namespace fogbow
