// SPDX-License-Identifier: GPL-3.0-or-later
// Rays of Mitsuba 3.9.1 (scalar_rgb): perspective and thinlens of fov 50 (x), film 200x120, near
// 0.5, far 100, look_at (1,2,3) to (4,1,-2) up (0.1,1,0.2); crop 100x60 at (30,20); lens radius
// 0.3, focus 4; from sensor.sample_ray(0, 0.5, raster, aperture) with aperture (0.5,0.5) and
// (0.8,0.3). Its rays start on the near plane.
#include <gtest/gtest.h>

#include "core/scene/sensors.h"

namespace fogbow {
namespace {

struct MitsubaRay {
  bool lens, crop;
  Vec2 principal_point_offset, raster;
  Vec3 o, d;
  double maxt;
};

constexpr double kNear = 0.5, kFar = 100, kAperture = 0.3, kFocus = 4;

// clang-format off
const MitsubaRay kRays[] = {
    {false, false, {0, 0}, {0.25, 0.7},
     {1.14340377, 1.88339424, 2.51775551}, {0.277671784, -0.225782886, -0.933766723}, 102.773705},
    {false, false, {0, 0}, {0.9, 0.1},
     {1.4353658, 1.98848021, 2.67191553}, {0.79844588, -0.0211267918, -0.601695895}, 108.508026},
    {false, false, {0.1, -0.05}, {0.25, 0.7},
     {1.18536389, 1.88811123, 2.54198813}, {0.365890771, -0.220857799, -0.904071808}, 100.815399},
    {false, false, {0.1, -0.05}, {0.9, 0.1},
     {1.47732592, 1.9931972, 2.69614816}, {0.843521178, -0.0120217074, -0.536961198}, 112.608734},
    {false, true, {0, 0}, {0.25, 0.7},
     {1.16583419, 1.93080771, 2.52173114}, {0.324585438, -0.135429397, -0.936110616}, 101.671242},
    {false, true, {0, 0}, {0.9, 0.1},
     {1.31181514, 1.98335063, 2.59881091}, {0.613340735, -0.0327492394, -0.789139152}, 101.169243},
    {false, true, {0.1, -0.05}, {0.25, 0.7},
     {1.20779431, 1.93552458, 2.54596376}, {0.412722349, -0.128061354, -0.901809633}, 100.191017},
    {false, true, {0.1, -0.05}, {0.9, 0.1},
     {1.35377526, 1.98806763, 2.62304378}, {0.684148788, -0.0230754036, -0.728977382}, 102.903473},
    {true, false, {0, 0}, {0.25, 0.7},
     {1.14340377, 1.88339424, 2.51775551}, {0.277671784, -0.225782886, -0.933766723}, 102.773705},
    {true, false, {0, 0}, {0.25, 0.7},
     {1.01121616, 1.83300304, 2.44852114}, {0.317403585, -0.213979006, -0.923833251}, 101.748268},
    {true, false, {0, 0}, {0.9, 0.1},
     {1.4353658, 1.98848021, 2.67191553}, {0.79844588, -0.0211267918, -0.601695895}, 108.508026},
    {true, false, {0, 0}, {0.9, 0.1},
     {1.30317807, 1.93808901, 2.60268116}, {0.819021285, -0.00779081136, -0.573710084}, 110.370369},
    {true, true, {0, 0}, {0.25, 0.7},
     {1.16583419, 1.93080771, 2.52173114}, {0.324585438, -0.135429397, -0.936110616}, 101.671242},
    {true, true, {0, 0}, {0.25, 0.7},
     {1.03364658, 1.88041639, 2.45249677}, {0.364127904, -0.122205615, -0.923296571}, 100.950546},
    {true, true, {0, 0}, {0.9, 0.1},
     {1.31181514, 1.98335063, 2.59881091}, {0.613340735, -0.0327492394, -0.789139152}, 101.169243},
    {true, true, {0, 0}, {0.9, 0.1},
     {1.17962754, 1.93295944, 2.52957678}, {0.645377934, -0.0184433404, -0.763640761}, 101.96991},
};
// clang-format on

PerspectiveSettings settings_of(const MitsubaRay& ray) {
  PerspectiveSettings s;
  s.to_world = Transform::look_at(Vec3(1, 2, 3), Vec3(4, 1, -2), Vec3(0.1, 1, 0.2));
  s.fov_x_degrees = 50;
  s.width = 200;
  s.height = 120;
  if (ray.crop) {
    s.crop_x = 30;
    s.crop_y = 20;
    s.crop_width = 100;
    s.crop_height = 60;
  }
  s.principal_point_offset = ray.principal_point_offset;
  s.near_clip = kNear;
  s.far_clip = kFar;
  return s;
}

std::shared_ptr<const Sensor> sensor_of(const MitsubaRay& ray) {
  const PerspectiveSettings s = settings_of(ray);
  return ray.lens ? make_thinlens_sensor(s, kAperture, kFocus) : make_perspective_sensor(s);
}

TEST(SensorMitsuba, RaysAreMitsubas) {
  constexpr double kSinglePrecision = 3e-6;
  for (const MitsubaRay& ray : kRays) {
    const auto sensor = sensor_of(ray);
    const Vec3 axis = normalize(Vec3(3, -1, -5));
    const Vec3 position = ray.o - kNear / dot(ray.d, axis) * ray.d;  // on pinhole or lens
    EXPECT_LT(length(position - Vec3(1, 2, 3)), ray.lens ? kAperture : kSinglePrecision);
    const Vec3 w = sensor->sample_direction(position, ray.raster).w;
    EXPECT_LT(length(w - ray.d), kSinglePrecision);
    EXPECT_LT(length(position + sensor->near_distance(w) * w - ray.o), kSinglePrecision);
    EXPECT_NEAR(sensor->far_distance(w) - sensor->near_distance(w), ray.maxt, 1e-5 * ray.maxt);
    const auto raster = sensor->raster(position, normalize(ray.d));
    ASSERT_TRUE(raster);
    EXPECT_LT(glm::length(*raster - ray.raster), 2 * kSinglePrecision);
  }
}

/// orthographic, with to_world scaled by (3, 2, 4) first; the last sees an identity sheared by
/// x += 0.3 y.
struct ParallelRay {
  Vec3 scale;
  bool crop;
  Vec2 raster;
  Vec3 o;
};
constexpr double kParallelMaxt = 99.5;  // whatever the scale

// clang-format off
const ParallelRay kParallelRays[] = {
    {{1, 1, 1}, false, {0.25, 0.7}, {0.78114378, 1.77784884, 2.32150865}},
    {{1, 1, 1}, false, {0.9, 0.1}, {2.03337264, 2.22856426, 2.98270273}},
    {{1, 1, 1}, true, {0.25, 0.7}, {0.87734795, 1.98120534, 2.33855963}},
    {{1, 1, 1}, true, {0.9, 0.1}, {1.50346231, 2.20656323, 2.66915679}},
    {{3, 2, 4}, false, {0.25, 0.7}, {0.65693343, 1.48118556, 0.53149092}},
    {{3, 2, 4}, false, {0.9, 0.1}, {4.23375177, 2.13686705, 2.54644585}},
    {{3, 2, 4}, true, {0.25, 0.7}, {0.89058644, 1.87844718, 0.59223044}},
    {{3, 2, 4}, true, {0.9, 0.1}, {2.67899561, 2.20628786, 1.59970796}},
};
// clang-format on

TEST(SensorMitsuba, ParallelRaysAreMitsubas) {
  constexpr double kSinglePrecision = 3e-6;
  const Vec3 axis = normalize(Vec3(3, -1, -5));
  for (const ParallelRay& ray : kParallelRays) {
    PerspectiveSettings s = settings_of({false, ray.crop, {0, 0}, {}, {}, {}, 0});
    s.to_world = s.to_world * Transform::scale(ray.scale);
    const auto sensor = make_orthographic_sensor(s);
    const SensorRay ours = sensor->sample_direction(Vec3(0), ray.raster);
    EXPECT_LT(length(ours.w - axis), kSinglePrecision);
    EXPECT_LT(length(ours.origin + sensor->near_distance(axis) * axis - ray.o), kSinglePrecision);
    EXPECT_NEAR(sensor->far_distance(axis) - sensor->near_distance(axis), kParallelMaxt, 1e-9);
    const auto raster = sensor->raster(ray.o, axis);
    ASSERT_TRUE(raster);
    EXPECT_LT(glm::length(*raster - ray.raster), 2 * kSinglePrecision);
  }
  Mat4 shear(1.0);
  shear[1][0] = 0.3;
  PerspectiveSettings s = settings_of({});
  s.to_world = Transform(shear);
  const auto sensor = make_orthographic_sensor(s);
  EXPECT_LT(
      length(sensor->sample_direction(Vec3(0), Vec2(0.25, 0.7)).origin - Vec3(0.428, -0.24, 0)),
      kSinglePrecision);
}

}  // namespace
}  // namespace fogbow
