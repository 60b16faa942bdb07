// SPDX-License-Identifier: GPL-3.0-or-later
// The whole way from a scene's droplets to a picture: the fogbow and the glory of
// scenes/fogbow.xml, pixel by pixel against a quadrature over the camera rays with Mie's series
// itself, neither tabulated nor sampled.
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "core/scene_io/load.h"
#include "media/mie.h"
#include "media/registry.h"
#include "mlt/render.h"
#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"
#include "tests/helpers/statistics.h"

namespace fogbow::testing {
namespace {

constexpr double kFov = 70, kSigmaT = 0.7, kIntensity = 40000;
constexpr int kWidth = 35;
const Vec3 kLight(0, 0, -200);
constexpr double kRadius = 10, kSpread = 0.1;

std::unique_ptr<Scene> load() {
  std::vector<std::string> warnings;
  auto scene = std::make_unique<Scene>(
      load_mitsuba_xml("tests/statistical/scenes/fogbow.xml", builtin_media(), {}, warnings));
  EXPECT_TRUE(warnings.empty());
  return scene;
}

/// From PixelGrid's camera to the world, by Mitsuba's lookat: right is the cross product of up and
/// forward, mirrored.
Vec3 to_world(const Vec3& camera) {
  const Vec3 forward = normalize(Vec3(-0.5, 0, std::sqrt(0.75)));
  const Vec3 left = normalize(cross(Vec3(0, 1, 0), forward));
  return camera.z * forward - camera.x * left - camera.y * Vec3(0, 1, 0);
}

/// What one node of the quadratures adds to a pixel.
struct Node {
  int pixel;
  double one_minus_cos, weight;
};

/// Over one pixel, and along its rays.
void add_nodes(int pixel, int columns, int rows, std::vector<Node>& nodes) {
  const PixelGrid grid{kFov, kWidth, 1};
  const QuadratureRule across = gauss_legendre(columns, 0, 1), down = gauss_legendre(rows, 0, 1),
                       along = gauss_legendre(3, 0, 1);
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j)
      for (int k = 0; k < 3; ++k) {
        const Vec3 w = to_world(grid.direction(pixel + across.nodes[i], down.nodes[j]));
        const Vec3 p = along.nodes[k] * w, way = kLight - p;
        const Vec3 to_light = normalize(way);
        const double b = dot(p, to_light);
        const double inside = -b + std::sqrt(b * b + 1 - dot(p, p));
        const double radiance =
            kSigmaT * kIntensity / dot(way, way) * std::exp(-kSigmaT * (along.nodes[k] + inside));
        nodes.push_back({pixel, 0.5 * length_squared(w - to_light),
                         across.weights[i] * down.weights[j] * along.weights[k] * radiance});
      }
}

std::vector<RGB> compute_expected() {
  std::vector<Node> nodes;
  constexpr int kGlory = 6;  // pixels with rings in them
  for (int pixel = 0; pixel < kWidth; ++pixel)
    pixel < kGlory ? add_nodes(pixel, 20, 16, nodes) : add_nodes(pixel, 6, 2, nodes);
  std::vector<double> angles;
  for (const Node& n : nodes) angles.push_back(n.one_minus_cos);
  const auto f_p = Droplets(water_droplets(kRadius, kSpread)).f_p(angles);
  std::vector<RGB> pixels(kWidth, RGB(0));
  for (std::size_t i = 0; i < nodes.size(); ++i) pixels[nodes[i].pixel] += nodes[i].weight * f_p[i];
  return pixels;
}

const std::vector<RGB>& expected() {
  static const std::vector<RGB> pixels = compute_expected();
  return pixels;
}

struct Effort {
  const char* integrator;
  double samples_per_pixel;
  double standard_error;  ///< of a channel of a pixel, relative, at most
};

class FogbowPicture : public ::testing::TestWithParam<Effort> {};

TEST_P(FogbowPicture, StandsWhereMiesSeriesPutsIt) {
  const auto scene = load();
  const std::vector<RGB> truth = expected();
  constexpr int kReplicates = 16;
  std::vector<std::vector<double>> values(3 * kWidth);
  for (int r = 0; r < kReplicates; ++r) {
    RenderOptions options;
    options.integrator = GetParam().integrator;
    options.samples_per_pixel = GetParam().samples_per_pixel;
    options.seed = suite_seed() + 0x9E3779B97F4A7C15 * static_cast<std::uint64_t>(r + 1);
    const RenderResult result = render(*scene, options);
    EXPECT_EQ(result.non_finite, 0u);
    for (int i = 0; i < kWidth; ++i)
      for (int c = 0; c < 3; ++c)
        values[3 * i + c].push_back(
            static_cast<double>(result.image.pixels[i * result.image.channels.size() + c]) /
            truth[i][c]);
  }
  const double level = sidak(kSuiteFalseAlarm, 3 * kWidth * 3);
  double worst = 0;
  for (int i = 0; i < 3 * kWidth; ++i) {
    const Estimate e = estimate(values[i]);
    EXPECT_GT(compare(e, 1), level) << "pixel " << i / 3 << " channel " << i % 3 << ": " << e.mean
                                    << " +- " << e.standard_error;
    worst = std::max(worst, e.standard_error);
  }
  EXPECT_LT(worst, GetParam().standard_error);
  std::printf("%s: standard error of a pixel's channel at most %.4f\n", GetParam().integrator,
              worst);
}

INSTANTIATE_TEST_SUITE_P(Integrators, FogbowPicture,
                         ::testing::Values(Effort{"path", 4096, 0.01}, Effort{"bdpt", 1024, 0.02},
                                           Effort{"mlt", 16384, 0.02}),
                         [](const auto& info) { return std::string(info.param.integrator); });

/// What the pictures are compared with has a bow and a glory: bright in the fourth decade of
/// degrees from the antisolar point (Airy's theory: 142.3° of scattering), dark inside it, bright
/// at the antisolar point again.
TEST(Fogbow, IsInWhatIsExpected) {
  const std::vector<RGB> pixels = expected();
  const PixelGrid grid{kFov, kWidth, 1};
  const auto degrees = [&](int pixel) {
    return std::acos(dot(to_world(grid.direction(pixel + 0.5, 0.5)), Vec3(0, 0, 1))) * 180 / kPi;
  };
  int antisolar = 0;
  for (int i = 0; i < kWidth; ++i)
    if (degrees(i) < degrees(antisolar)) antisolar = i;
  EXPECT_LT(degrees(antisolar), 2);
  int brightest = -1;
  double darkest = kInfinity;
  for (int i = 0; i < kWidth; ++i) {
    if (degrees(i) > 30 && degrees(i) < 50 && (brightest < 0 || pixels[i].y > pixels[brightest].y))
      brightest = i;
    if (degrees(i) > 15 && degrees(i) < 30) darkest = std::min(darkest, pixels[i].y);
  }
  EXPECT_NEAR(180 - degrees(brightest), 142.3, 2);
  EXPECT_GT(pixels[brightest].y, 2 * darkest);
  EXPECT_GT(pixels[brightest].y, 2 * pixels[kWidth - 1].y);
  EXPECT_GT(pixels[antisolar].y, 2 * darkest);
}

}  // namespace
}  // namespace fogbow::testing
