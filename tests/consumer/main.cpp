// SPDX-License-Identifier: GPL-3.0-or-later
// An isothermal cavity, described in code: a closed room whose walls emit (1 − ρ) B, around a cloud
// that emits σ_a B per unit length, looks exactly B in every direction, for every estimator.
#include <fogbow/fogbow.h>

#include <cmath>
#include <cstdio>

#include "core/image/image_io.h"

namespace {

constexpr double kRadiance = 2.5;  // B
constexpr double kReflectance = 0.5, kSigmaT = 0.8, kAlbedo = 0.6;
constexpr int kSize = 16;

fogbow::SceneDescription isothermal_cavity() {
  using namespace fogbow;
  const double sigma_a = kSigmaT * (1 - kAlbedo);
  const auto fog = make_homogeneous_medium(RGB(kSigmaT), RGB(kAlbedo), make_henyey_greenstein(0.5),
                                           RGB(sigma_a * kRadiance), "fog");
  Surface room;
  room.shape = make_cube(Transform(), /*flip_normals=*/true);
  room.bsdf = make_diffuse(RGB(kReflectance));
  room.emitter = make_area_emitter(room.shape, RGB((1 - kReflectance) * kRadiance));
  room.id = "room";

  Surface cloud;
  cloud.shape = make_cube(Transform::scale(Vec3(0.8)));
  cloud.bsdf = make_null();
  cloud.medium_boundary = true;
  cloud.interior = fog;
  cloud.id = "cloud";

  SceneDescription description;
  description.surfaces = {room, cloud};
  description.film.width = description.film.height = kSize;
  description.film.filter = make_box_filter();
  PerspectiveSettings camera;
  camera.to_world = Transform::look_at(Vec3(0.3, -0.2, -0.6), Vec3(0.1, 0.2, 1), Vec3(0, 1, 0));
  camera.fov_x_degrees = 60;
  camera.width = camera.height = kSize;
  camera.near_clip = 1e-3;
  description.sensor = make_perspective_sensor(camera);
  description.sensor_medium = fog;
  description.sensor_medium_declared = true;
  description.title = "isothermal cavity";
  return description;
}

/// Mean luminance of the pixels, in double precision.
double mean_luminance(const fogbow::Image& image) {
  double sum = 0;
  const int r = image.channel("R"), g = image.channel("G"), b = image.channel("B");
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      sum += fogbow::luminance(
          {image.at(column, row, r), image.at(column, row, g), image.at(column, row, b)});
  return sum / (image.width * image.height);
}

bool agrees(const fogbow::Scene& scene, const char* integrator, double samples_per_pixel) {
  fogbow::RenderOptions options;
  options.integrator = integrator;
  options.samples_per_pixel = samples_per_pixel;
  options.seed = 1;
  const fogbow::RenderResult result = fogbow::render(scene, options);
  const double mean = mean_luminance(result.image);
  std::printf("%-7s mean %.5f, b %.5f +- %.5f, expected %.5f\n", integrator, mean, result.b,
              result.b_stderr, kRadiance);
  const bool precise = result.b_stderr > 0 && result.b_stderr < 0.01 * kRadiance;
  return precise && std::abs(mean - kRadiance) < 4.5 * result.b_stderr;
}

/// What was written is what is read back.
bool survives_a_file(const fogbow::Image& image) {
  const std::string path = "consumer.exr";
  fogbow::write_exr(path, image);
  return fogbow::read_image(path).pixels == image.pixels;
}

}  // namespace

int main() {
  const fogbow::Scene scene(isothermal_cavity(), /*strict=*/true);
  bool good = agrees(scene, "path", 256);
  good = agrees(scene, "pssmlt", 256) && good;
  good = agrees(scene, "mlt", 256) && good;
  fogbow::Image gradient(4, 2, {"R", "G", "B"});
  for (std::size_t i = 0; i < gradient.pixels.size(); ++i) gradient.pixels[i] = 0.125f * i;
  good = survives_a_file(gradient) && good;
  return good ? 0 : 1;
}
