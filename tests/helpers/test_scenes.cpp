// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/test_scenes.h"

#include <stdexcept>

#include "core/geometry/shapes.h"
#include "core/image/image.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
#include "core/scene/textures.h"
#include "media/media.h"
#include "media/mie.h"

namespace fogbow::testing {

namespace {

using MediumPtr = std::shared_ptr<const Medium>;
using BsdfPtr = std::shared_ptr<const Bsdf>;

constexpr int kSize = 16;

/// Collects the parts of a description.
class Builder {
 public:
  Builder() {
    d_.film = {kSize, kSize, 0, 0, 0, 0, make_box_filter()};
    camera(Vec3(0, 0.3, 3), Vec3(0, 0, 0), 45);
  }

  Builder& camera(const Vec3& origin, const Vec3& target, double fov, double aperture = 0) {
    PerspectiveSettings s;
    s.to_world = Transform::look_at(origin, target, Vec3(0, 1, 0));
    s.fov_x_degrees = fov;
    s.width = s.height = kSize;
    d_.sensor = aperture > 0 ? make_thinlens_sensor(s, aperture, length(target - origin))
                             : make_perspective_sensor(s);
    return *this;
  }
  /// Sees `width` across.
  Builder& parallel_camera(const Vec3& origin, const Vec3& target, double width) {
    PerspectiveSettings s;
    s.to_world = Transform::look_at(origin, target, Vec3(0, 1, 0)) *
                 Transform::scale(Vec3(width / 2, width / 2, 1));
    s.width = s.height = kSize;
    d_.sensor = make_orthographic_sensor(s);
    return *this;
  }
  Builder& camera_medium(MediumPtr m) {
    d_.sensor_medium = std::move(m);
    d_.sensor_medium_declared = true;
    return *this;
  }
  Surface& add(std::shared_ptr<const Shape> shape, BsdfPtr bsdf) {
    Surface s;
    s.shape = std::move(shape);
    s.bsdf = std::move(bsdf);
    s.id = "surface " + std::to_string(d_.surfaces.size());
    return d_.surfaces.emplace_back(std::move(s));
  }
  Builder& bounds(std::shared_ptr<const Shape> shape, BsdfPtr bsdf, MediumPtr interior,
                  MediumPtr exterior, int priority = 0) {
    Surface& s = add(std::move(shape), std::move(bsdf));
    s.medium_boundary = true;
    s.priority = priority;
    s.interior = std::move(interior);
    s.exterior = std::move(exterior);
    return *this;
  }
  Builder& light(std::shared_ptr<const Shape> shape, const RGB& radiance) {
    Surface& s = add(shape, make_diffuse(RGB(0)));
    s.emitter = make_area_emitter(std::move(shape), radiance);
    return *this;
  }
  Builder& emitter(std::shared_ptr<Emitter> e) {
    d_.emitters.push_back(std::move(e));
    return *this;
  }
  Builder& floor(BsdfPtr bsdf) {
    add(make_rectangle(Transform::translate(Vec3(0, -1, 0)) *
                       Transform::rotate(Vec3(1, 0, 0), -90) * Transform::scale(Vec3(2.5))),
        std::move(bsdf));
    return *this;
  }
  Builder& ceiling_light(double half_size, const RGB& radiance) {
    return light(
        make_rectangle(Transform::translate(Vec3(0.3, 1.4, 0.2)) *
                       Transform::rotate(Vec3(1, 0, 0), 90) * Transform::scale(Vec3(half_size))),
        radiance);
  }
  SceneDescription done() { return std::move(d_); }

 private:
  SceneDescription d_;
};

BsdfPtr gray() { return make_twosided(make_diffuse(RGB(0.6, 0.5, 0.4))); }

MediumPtr fog(const RGB& sigma_t, const RGB& albedo, double g = 0, const RGB& emission = RGB(0)) {
  return make_homogeneous_medium(
      sigma_t, albedo, g == 0 ? make_isotropic_phase() : make_henyey_greenstein(g), emission);
}

std::shared_ptr<const Shape> sphere(const Vec3& center, double radius) {
  return make_sphere(center, radius);
}

/// A wavy height field with smooth normals over [−1.5, 1.5]², facing up; the walls of a basin begin
/// at 1.4.
std::shared_ptr<const Shape> water_surface() {
  constexpr int n = 40;
  TriangleMeshData mesh;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = 3.0 * i / n - 1.5, z = 3.0 * j / n - 1.5;
      mesh.positions.emplace_back(x, 0.05 * std::sin(4 * x) * std::cos(3 * z), z);
    }
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
      mesh.triangles.push_back({a, c, b});
      mesh.triangles.push_back({b, c, d});
    }
  mesh.normals = vertex_normals(mesh);
  return make_mesh(std::move(mesh));
}

SceneDescription surfaces() {
  Builder b;
  b.floor(gray()).ceiling_light(0.4, RGB(8, 7, 6));
  b.add(sphere(Vec3(-0.5, -0.5, 0), 0.5),
        make_rough_conductor({MicrofacetKind::Ggx, 0.3, 0.3}, RGB(0.2, 0.9, 1.1),
                             RGB(3.9, 2.4, 2.2)));
  b.add(make_cube(Transform::translate(Vec3(0.6, -0.6, 0.2)) * Transform::scale(Vec3(0.4))),
        gray());
  return b.done();
}

SceneDescription floor_fog() {
  Builder b;
  b.camera_medium(fog(RGB(0.4), RGB(0.9))).floor(gray()).ceiling_light(0.3, RGB(10));
  return b.done();
}

SceneDescription glass_sphere_fog() {
  Builder b;
  const auto m = fog(RGB(0.3), RGB(0.9));
  b.camera_medium(m).floor(gray()).ceiling_light(0.3, RGB(10));
  b.bounds(sphere(Vec3(0, -0.2, 0), 0.5), make_dielectric(1.5), nullptr, m);
  return b.done();
}

SceneDescription fog_in_glass() {
  Builder b;
  b.floor(gray()).ceiling_light(0.4, RGB(10));
  b.bounds(sphere(Vec3(0, -0.2, 0), 0.6), make_dielectric(1.4), fog(RGB(2, 1.5, 1), RGB(0.8), 0.4),
           nullptr);
  return b.done();
}

SceneDescription nested_media() {
  Builder b;
  const auto outer = fog(RGB(0.5, 0.8, 1.1), RGB(0.9, 0.8, 0.7), 0.3);
  const auto inner = fog(RGB(3, 2, 1), RGB(0.5, 0.7, 0.9), -0.2);
  b.floor(gray()).ceiling_light(0.4, RGB(10));
  b.bounds(make_cube(Transform::scale(Vec3(0.9))), make_null(), outer, nullptr);
  b.bounds(sphere(Vec3(0.1, 0, 0), 0.5), make_null(), inner, outer);
  return b.done();
}

SceneDescription mirror_fog() {
  Builder b;
  b.camera_medium(fog(RGB(0.3), RGB(0.8), 0.5)).floor(gray());
  b.add(
      make_rectangle(Transform::translate(Vec3(-1.2, 0, 0)) * Transform::rotate(Vec3(0, 1, 0), 70)),
      make_twosided(make_conductor(RGB(0), RGB(1), RGB(0.9, 0.8, 0.7))));
  b.emitter(make_point_emitter(Vec3(0.6, 0.9, 0.4), RGB(5)));
  return b.done();
}

SceneDescription water() {
  Builder b;
  b.camera(Vec3(0, 2, 2.2), Vec3(0, -0.3, 0), 45);
  b.floor(gray()).ceiling_light(0.3, RGB(20));
  // A basin with thick walls, in which the open water surface ends: no way leads around its edge.
  for (int side = 0; side < 4; ++side)
    b.add(make_cube(Transform::rotate(Vec3(0, 1, 0), 90.0 * side) *
                    Transform::translate(Vec3(0, -0.4, -1.5)) *
                    Transform::scale(Vec3(1.6, 0.7, 0.1))),
          gray());
  b.bounds(water_surface(), make_dielectric(1.33), fog(RGB(0.9, 0.6, 0.5), RGB(0.4, 0.7, 0.8)),
           nullptr);
  return b.done();
}

SceneDescription flame() {
  Builder b;
  b.floor(gray()).ceiling_light(0.2, RGB(4));
  b.bounds(make_cube(Transform::scale(Vec3(0.5))), make_null(),
           fog(RGB(1.5, 1, 0.8), RGB(0.4), 0, RGB(2, 1, 0.3)), nullptr);
  return b.done();
}

/// Voxels with three channels: nothing in one part, some channels alone in others.
VoxelData patches(double r, double g, double b) {
  constexpr int n = 20;
  VoxelData data{{n, n, n}, 3, {}};
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const double wave = 1 + std::sin(1.1 * x + 0.7 * y) * std::cos(0.9 * z - 0.4 * y);
        const bool empty = x + y < 8 || z > 15;
        for (const double v : {empty ? 0 : r, empty || y > 12 ? 0 : g, empty || x > 12 ? 0 : b})
          data.values.push_back(static_cast<float>(v * wave));
      }
  return data;
}

/// Heterogeneous, chromatic and emissive, in a turned box of voxels.
SceneDescription patchy_flame() {
  Builder b;
  b.floor(gray()).ceiling_light(0.2, RGB(4));
  const Transform box = Transform::rotate(Vec3(1, 3, 0), 20) * Transform::scale(Vec3(1.2)) *
                        Transform::translate(Vec3(-0.5));
  const auto volume = [&](const VoxelData& data) {
    return std::make_shared<Volume>(data, VolumeSettings{box});
  };
  HeterogeneousSettings s;
  s.sigma_t = volume(patches(1, 0.7, 1.4));
  s.scale = 1.5;
  s.albedo = volume(patches(0.3, 0.4, 0.45));
  s.emission = volume(patches(1.5, 0.8, 0.4));
  b.bounds(make_cube(Transform::rotate(Vec3(1, 3, 0), 20) * Transform::scale(Vec3(0.6))),
           make_null(), make_heterogeneous_medium(s, make_isotropic_phase()), nullptr);
  return b.done();
}

/// Smoke behind glass: specular chains that end in it, and free space all around it.
SceneDescription smoke_in_glass() {
  Builder b;
  b.floor(gray()).ceiling_light(0.4, RGB(10));
  VoxelData data{{24, 24, 24}, 1, {}};
  for (int z = 0; z < 24; ++z)
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x) {
        const Vec3 p = Vec3(x, y, z) / 23.0 - 0.5;
        const double swirl = 1 + std::sin(14 * p.x + 9 * p.y) * std::cos(11 * p.z);
        data.values.push_back(static_cast<float>(std::max(0.0, 1 - 6 * dot(p, p)) * swirl));
      }
  HeterogeneousSettings s;
  s.sigma_t = std::make_shared<Volume>(
      data,
      VolumeSettings{Transform::translate(Vec3(-0.6, -0.8, -0.6)) * Transform::scale(Vec3(1.2))});
  s.scale = 4;
  s.albedo = std::make_shared<Volume>(RGB(0.8, 0.7, 0.9));
  b.bounds(sphere(Vec3(0, -0.2, 0), 0.6), make_dielectric(1.4),
           make_heterogeneous_medium(s, make_henyey_greenstein(0.4)), nullptr);
  b.add(sphere(Vec3(0.15, -0.45, 0.1), 0.15), gray());
  return b.done();
}

/// Every kind of phase function besides Henyey and Greenstein's: a cloud in clear air.
SceneDescription droplets() {
  Builder b;
  const auto air = make_homogeneous_medium(RGB(0.1, 0.15, 0.25), RGB(0.95), make_rayleigh_phase());
  const auto mist = make_table_phase(Droplets(water_droplets(0.5, 0.2)).table());
  const auto dust =
      make_blend_phase(make_tabulated_phase({0.5, 0.2, 0, 0.4, 2}), make_draine(-0.3, 2), 0.3);
  const auto cloud = make_homogeneous_medium(RGB(2, 1.8, 1.5), RGB(0.95, 0.9, 0.85),
                                             make_blend_phase(mist, dust, 0.4));
  b.camera_medium(air).floor(gray()).ceiling_light(0.3, RGB(10));
  b.bounds(make_cube(Transform::scale(Vec3(0.7))), make_null(), cloud, air);
  return b.done();
}

SceneDescription sky_lens() {
  Builder b;
  b.camera(Vec3(0, 0.3, 3), Vec3(0, 0, 0), 45, 0.15).floor(gray());
  b.add(sphere(Vec3(0.5, -0.5, 0), 0.5),
        make_rough_dielectric({MicrofacetKind::Beckmann, 0.25, 0.25}, 1.5));
  b.bounds(sphere(Vec3(-0.6, -0.4, 0), 0.5), make_null(), fog(RGB(1.5), RGB(0.95)), nullptr);
  b.emitter(make_constant_emitter(RGB(0.5, 0.7, 1)));
  return b.done();
}

SceneDescription two_kinds_of_glass() {
  Builder b;
  b.floor(gray()).ceiling_light(0.4, RGB(10));
  b.emitter(make_constant_emitter(RGB(0.15))).emitter(make_constant_emitter(RGB(0.02, 0.05, 0.1)));
  b.add(sphere(Vec3(0, 0.3, 0), 0.3), make_dielectric(1.9));
  b.add(sphere(Vec3(-0.5, -0.4, 0), 0.45), make_dielectric(1.5, RGB(1), RGB(0.9, 1, 0.9)));
  b.add(sphere(Vec3(0.5, -0.4, 0), 0.45),
        make_rough_dielectric({MicrofacetKind::Ggx, 0.2, 0.4}, 1.5));
  return b.done();
}

/// A coarse sky with a bright patch.
Image sky() {
  Image image(6, 4, {"R", "G", "B"});
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 6; ++column)
      for (int c = 0; c < 3; ++c)
        image.at(column, row, c) = 0.1f * static_cast<float>(1 + c + (row < 2 ? column : 0));
  image.at(2, 1, 0) = image.at(2, 1, 1) = 6;
  return image;
}

/// A can of glass under the sun, the sky and a spot light.
SceneDescription sun_and_can() {
  Builder b;
  b.floor(gray());
  const Transform place = Transform::translate(Vec3(-0.5, -0.35, 0)) *
                          Transform::rotate(Vec3(1, 0, 0.3), -75) * Transform::scale(Vec3(0.55));
  b.add(make_cylinder(Vec3(0, 0, -1), Vec3(0, 0, 1), 1, place), make_dielectric(1.5));
  b.add(make_disk(place * Transform::translate(Vec3(0, 0, 1))), make_dielectric(1.5));
  b.add(make_disk(place * Transform::translate(Vec3(0, 0, -1)), true), make_dielectric(1.5));
  b.bounds(sphere(Vec3(0.7, -0.4, 0), 0.5), make_null(), fog(RGB(1.5), RGB(0.9), 0.3), nullptr);
  b.emitter(make_environment_emitter(sky(), Transform::rotate(Vec3(0, 1, 0), 40)));
  b.emitter(make_directional_emitter(Vec3(0.4, -1, -0.3), RGB(1.2, 1.1, 0.9)));
  b.emitter(make_spot_emitter(Vec3(0.5, 1.2, 0.8), Vec3(-0.8, -1.6, -0.8), RGB(6, 5, 7), 35, 20));
  return b.done();
}

/// Vertices that scatter specularly or not, textures, and surfaces that light passes in part: a
/// pane, and a box of fog with holes in its walls.
SceneDescription coatings() {
  Builder b;
  const auto haze = fog(RGB(0.3), RGB(0.9));
  const auto board =
      make_checkerboard_texture(RGB(0.8, 0.6, 0.4), RGB(0.2), Transform::scale(Vec3(4, 4, 1)));
  b.camera_medium(haze).ceiling_light(0.3, RGB(10));
  b.floor(make_twosided(make_plastic(1.5, true, board)));
  b.add(sphere(Vec3(-0.6, -0.5, 0), 0.45),
        make_rough_plastic({MicrofacetKind::Ggx, 0.25, 0.25}, 1.5, false, RGB(0.6, 0.3, 0.2)));
  b.add(
      sphere(Vec3(0, 0.3, -0.3), 0.5),
      make_blend(make_conductor(RGB(0), RGB(1), RGB(0.9, 0.8, 0.7)), make_diffuse(RGB(0.5)), 0.25));
  b.bounds(make_cube(Transform::translate(Vec3(0.6, -0.5, 0.1)) * Transform::scale(Vec3(0.4))),
           make_mask(gray(), 0.5), fog(RGB(2, 1.5, 1), RGB(0.8)), haze);
  b.add(make_rectangle(Transform::translate(Vec3(-0.2, 0, 1)) *
                       Transform::rotate(Vec3(0, 1, 0), 20) * Transform::scale(Vec3(0.6))),
        make_thin_dielectric(1.5, RGB(1), RGB(0.9, 1, 0.8)));
  b.light(sphere(Vec3(-1.2, 0.4, -1.2), 0.3), RGB(4, 3, 2));  // seen through the pane in part
  return b.done();
}

/// Parallel rays of the eye onto and through fog and glass, and of light.
SceneDescription parallel_rays() {
  Builder b;
  const auto haze = fog(RGB(0.6), RGB(0.9), 0.2);
  b.parallel_camera(Vec3(0.4, 1.2, 2.2), Vec3(0, -0.3, 0), 3.6);
  b.floor(gray()).ceiling_light(0.4, RGB(8, 7, 6));
  b.bounds(make_cube(Transform::translate(Vec3(0.3, -0.3, 0.2)) * Transform::scale(Vec3(0.65))),
           make_null(), haze, nullptr);
  b.bounds(sphere(Vec3(0.3, -0.3, 0.2), 0.45), make_dielectric(1.5), nullptr, haze);
  b.add(sphere(Vec3(-0.9, -0.5, 0), 0.4),
        make_rough_conductor({MicrofacetKind::Ggx, 0.4, 0.4}, RGB(0.2, 0.9, 1.1),
                             RGB(3.9, 2.4, 2.2)));
  b.emitter(make_environment_emitter(sky(), Transform::rotate(Vec3(0, 1, 0), 40)));
  b.emitter(make_directional_emitter(Vec3(0.4, -1, -0.3), RGB(1.2, 1.1, 0.9)));
  return b.done();
}

/// Volumes that overlap: a ball of glass half in a block of fog, and mist that reaches into both.
SceneDescription overlapping_volumes() {
  Builder b;
  b.floor(gray()).ceiling_light(0.4, RGB(10));
  b.bounds(make_cube(Transform::translate(Vec3(0, -0.6, 0)) * Transform::scale(Vec3(1, 0.35, 1))),
           make_null(), fog(RGB(0.9, 0.6, 0.5), RGB(0.6, 0.8, 0.9)), nullptr, 1);
  b.bounds(sphere(Vec3(-0.35, -0.3, 0.1), 0.4), make_dielectric(1.4), fog(RGB(0.8), RGB(0.95), 0.5),
           nullptr, 2);
  b.bounds(sphere(Vec3(0.3, -0.1, 0), 0.5), make_null(), fog(RGB(0.8, 1.1, 1.4), RGB(0.9)),
           nullptr);
  return b.done();
}

}  // namespace

const std::vector<TestScene>& test_scenes() {
  static const std::vector<TestScene> scenes = {{"surfaces", surfaces},
                                                {"floor-fog", floor_fog},
                                                {"glass-sphere-fog", glass_sphere_fog},
                                                {"fog-in-glass", fog_in_glass},
                                                {"nested-media", nested_media},
                                                {"mirror-fog", mirror_fog},
                                                {"water", water},
                                                {"flame", flame},
                                                {"patchy-flame", patchy_flame},
                                                {"smoke-in-glass", smoke_in_glass},
                                                {"droplets", droplets},
                                                {"sky-lens", sky_lens},
                                                {"two-kinds-of-glass", two_kinds_of_glass},
                                                {"sun-and-can", sun_and_can},
                                                {"coatings", coatings},
                                                {"parallel-rays", parallel_rays},
                                                {"overlapping-volumes", overlapping_volumes}};
  return scenes;
}

SceneDescription make_test_scene(const std::string& name) {
  for (const TestScene& s : test_scenes())
    if (s.name == name) return s.make();
  throw std::invalid_argument("no test scene " + name);
}

}  // namespace fogbow::testing
