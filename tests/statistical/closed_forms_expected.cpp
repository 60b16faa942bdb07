// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/statistical/closed_forms_expected.h"

#include "tests/helpers/quadrature.h"
#include "tests/helpers/radiative_transfer.h"

namespace fogbow::testing {

namespace {

ExpectedPixels pixel_means(const PixelGrid& grid, const std::function<double(const Vec3&, int)>& L,
                           int channels, int nodes = 5) {
  ExpectedPixels pixels;
  for (int y = 0; y < grid.height; ++y)
    for (int x = 0; x < grid.width; ++x) {
      RGB mean(0);
      for (int c = 0; c < channels; ++c)
        mean[c] = grid.pixel_mean(
            x, y, [&](const Vec3& d) { return L(d, c); }, nodes);
      pixels.push_back(channels == 1 ? RGB(mean[0]) : mean);
    }
  return pixels;
}

bool meets(const Ball& ball, const Vec3& origin, const Vec3& direction) {
  const Vec3 to_center = ball.center - origin;
  const double along = dot(to_center, direction);
  return along > 0 && length(to_center - along * direction) < ball.radius;
}

/// plane-mirror.xml; intensity 1, 2, 3.
struct MirrorRoom {
  View view{Vec3(0.1, 0, 2), Vec3(0.1, 0, 0), Vec3(0, 1, 0), 40};
  Vec3 light{0.2, 0.3, 0.7};
  PixelGrid grid;

  MirrorRoom(int width, int height) : grid{view.fov_x_degrees, width, height} {}

  ExpectedPixels floor(bool mirrored) const {
    const Vec3 up(0, 0, 1), image = mirror_image(light, Vec3(1, 0, 0), Vec3(-1, 0, 0));
    const auto L = [&](const Vec3& d, int c) {
      const Vec3 w = view.to_world(d);
      const Vec3 p = view.origin - w * (view.origin.z / w.z);
      double E = point_irradiance(p, up, light, 1);
      if (mirrored) E += point_irradiance(p, up, image, 1);
      return (c + 1) * 0.5 / kPi * E;
    };
    return pixel_means(grid, L, 3);
  }
};

}  // namespace

ExpectedPixels constant_pixels(int width, int height, const RGB& value) {
  return ExpectedPixels(static_cast<std::size_t>(width) * height, value);
}

Vec3 View::to_world(const Vec3& d) const {
  const Vec3 forward = normalize(target - origin);
  const Vec3 right = normalize(cross(forward, up));
  return d.x * right + d.y * cross(forward, right) + d.z * forward;
}

Vec3 View::to_camera(const Vec3& d) const {
  return {dot(d, to_world({1, 0, 0})), dot(d, to_world({0, 1, 0})), dot(d, to_world({0, 0, 1}))};
}

ExpectedPixels View::pixels_beside(int width, int height, const RGB& value,
                                   const std::vector<Ball>& balls) const {
  constexpr int kScan = 33;
  const PixelGrid grid{fov_x_degrees, width, height};
  ExpectedPixels pixels = constant_pixels(width, height, value);
  for (int y = 0; y < height * kScan; ++y)
    for (int x = 0; x < width * kScan; ++x) {
      const double step = 1.0 / (kScan - 1);  // edges and corners of the pixel included
      const int column = x / kScan, row = y / kScan;
      const Vec3 w = to_world(grid.direction(column + x % kScan * step, row + y % kScan * step));
      for (const Ball& ball : balls)
        if (meets(ball, origin, w)) pixels[row * width + column].reset();
    }
  return pixels;
}

ExpectedPixels half_space_pixels(int width, int height, double fov, double albedo) {
  const ChandrasekharH h(albedo);
  return pixel_means(
      {fov, width, height}, [&](const Vec3& d, int) { return h.plane_albedo(d.z); }, 1);
}

ExpectedPixels slab_pixels(int width, int height, double fov, SlabSide side) {
  const PixelGrid grid{fov, width, height};
  const double least = grid.direction(0, 0).z;
  const std::vector<double> mu = ChebyshevInterpolant::nodes(16, least, 1);
  const PlaneLayer layer(0.9, 0.75, 2, mu);
  std::vector<double> values;
  for (int i = 0; i < static_cast<int>(mu.size()); ++i)
    values.push_back(side == SlabSide::Lit ? layer.reflected(i) : layer.transmitted(i));
  const ChebyshevInterpolant radiance(least, 1, values);
  return pixel_means(
      grid, [&](const Vec3& d, int) { return radiance(d.z); }, 1);
}

ExpectedPixels airlight_pixels(int width, int height, double near) {
  const View view{Vec3(0), Vec3(0, 0, 1), Vec3(0, 1, 0), 60};
  const RGB sigma_t(0.4, 0.8, 0.2), albedo(0.9, 0.5, 1), intensity(1, 2, 3);
  const auto L = [&](const Vec3& d, int c) {
    const Airlight air{sigma_t[c], sigma_t[c] * albedo[c], 0.6, Vec3(1.8, 0.3, 2), intensity[c]};
    return air.radiance({view.origin, view.to_world(d)}, near / d.z, kInfinity);
  };
  return pixel_means({view.fov_x_degrees, width, height}, L, 3);
}

ExpectedPixels fresnel_plate_pixels(int width, int height) {
  const RGB sigma_a(0.4, 0.05, 1);
  const auto L = [&](const Vec3& d, int c) {
    const SlabTransport plate = fresnel_plate(d.z, 1.5, 0.5 * sigma_a[c]);
    return plate.reflected + 3 * plate.transmitted;
  };
  return pixel_means({100, width, height}, L, 3);
}

ExpectedPixels plane_mirror_pixels(int width, int height, bool mirrored) {
  return MirrorRoom(width, height).floor(mirrored);
}

ExpectedPixels ball_caustic_pixels(int width, int height, bool caustic) {
  constexpr double kReflectance = 0.001, kFloor = 0.9;
  constexpr int kRings = 4000, kAzimuths = 1000;
  constexpr int kShadowNodes = 96;  // the shadow's edge crosses pixels
  const BallCaustic ball{0.4, 1.5, 1, kFloor, 3000};
  const View view{Vec3(0, -1.6, -0.3), Vec3(0, 0, -kFloor), Vec3(0, 0, 1), 30};
  const PixelGrid grid{view.fov_x_degrees, width, height};
  ExpectedPixels pixels = pixel_means(
      grid,
      [&](const Vec3& d, int) {
        const Vec3 w = view.to_world(d);
        const Vec3 p = view.origin + w * ((-kFloor - view.origin.z) / w.z);
        return kReflectance / kPi * ball.direct_irradiance(std::hypot(p.x, p.y));
      },
      1, kShadowNodes);
  if (!caustic) return pixels;
  for (const int order : {BallCaustic::kOutside, 0})
    ball.visit_landings(order, kRings, kAzimuths, [&](double px, double py, double flux) {
      const Vec3 to = Vec3(px, py, -kFloor) - view.origin;
      const Vec3 d = view.to_camera(to);
      if (!(d.z > 0)) return;
      const Vec2 raster = grid.raster(d);
      if (!(raster.x >= 0 && raster.x < width && raster.y >= 0 && raster.y < height)) return;
      const double distance = length(to);
      const double L = kReflectance / kPi * flux * (-to.z / distance) / sqr(distance);
      *pixels[static_cast<std::size_t>(raster.y) * width + static_cast<std::size_t>(raster.x)] +=
          RGB(L * grid.importance(d));
    });
  return pixels;
}

}  // namespace fogbow::testing
