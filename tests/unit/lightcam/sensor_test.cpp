// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/math/random.h"
#include "core/scene/sensors.h"
#include "tests/helpers/quadrature.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/triples.h"

namespace fogbow {
namespace {

using testing::Chart;
using testing::check_triple;

const Vec3 kOrigin(1, 2, 3), kTarget(4, 1, -2), kUp(0.1, 1, 0.2);
constexpr double kAperture = 0.7, kFocus = 4;

struct Camera {
  std::string name;
  PerspectiveSettings settings;
};

/// Where the film lies, from the definitions of field of view, crop and principal point alone.
struct FilmGeometry {
  Vec3 view, right, down;
  Vec2 lo, size;  ///< in tangents to the right and down

  explicit FilmGeometry(const PerspectiveSettings& s)
      : view(normalize(kTarget - kOrigin)),
        right(-normalize(cross(kUp, view))),
        down(cross(view, right)) {
    const double half = std::tan(0.5 * s.fov_x_degrees * kPi / 180);
    const Vec2 extent(half, half * s.height / s.width), whole(s.width, s.height);
    const bool all = s.crop_width == 0;
    const Vec2 crop = all ? whole : Vec2(s.crop_width, s.crop_height);
    lo = (2.0 * (Vec2(s.crop_x, s.crop_y) / whole + s.principal_point_offset) - 1.0) * extent;
    size = 2.0 * (crop / whole) * extent;
  }
  /// Unit direction to a tangent seen from a lens position; the lens moves it back by lens/focus.
  Vec3 direction(const Vec2& tangent) const {
    return normalize(view + tangent.x * right + tangent.y * down);
  }
};

std::vector<Camera> cameras() {
  PerspectiveSettings s;
  s.to_world = Transform::look_at(kOrigin, kTarget, kUp);
  s.fov_x_degrees = 50;
  s.width = 200;
  s.height = 120;
  PerspectiveSettings crop = s;
  crop.crop_x = 30;
  crop.crop_y = 20;
  crop.crop_width = 100;
  crop.crop_height = 60;
  PerspectiveSettings shifted = crop;
  shifted.principal_point_offset = Vec2(0.1, -0.05);
  PerspectiveSettings wide = s;
  wide.fov_x_degrees = 130;
  return {{"whole", s}, {"cropped", crop}, {"shifted", shifted}, {"wide", wide}};
}

/// Directions of the front half space: the film is the middle half of the chart in both
/// coordinates.
Chart film_chart(const FilmGeometry& film, const Vec2& shift) {
  Chart chart;
  chart.point = [=](const Vec2& c) {
    return film.direction(film.lo + (2.0 * c - 0.5) * film.size - shift);
  };
  chart.coordinates = [=](const Vec3& w) {
    const Vec2 tangent = Vec2(dot(w, film.right), dot(w, film.down)) / dot(w, film.view);
    return (tangent + shift - film.lo) / film.size * 0.5 + 0.25;
  };
  chart.jacobian = [=](const Vec2& c) {
    return 4 * film.size.x * film.size.y * std::pow(dot(chart.point(c), film.view), 3);
  };
  return chart;
}

testing::Triple direction_triple(const Sensor& sensor, const Vec3& position) {
  return {2,
          [&sensor, position](const Vec3& u) -> std::optional<Vec3> {
            const SensorRay ray = sensor.sample_direction(position, Vec2(u));
            EXPECT_NEAR(ray.pdf_sigma, sensor.pdf_sigma(position, ray.w), 1e-9 * ray.pdf_sigma);
            return ray.w;
          },
          [&sensor, position](const Vec3& w) { return sensor.pdf_sigma(position, w); },
          [&sensor, position](const Vec3& w, const Vec3&) -> std::optional<Vec3> {
            const auto raster = sensor.raster(position, w);
            if (!raster) return std::nullopt;
            return Vec3(*raster, 0);
          }};
}

TEST(Sensor, PinholeDirectionsAreATriple) {
  for (const Camera& c : cameras()) {
    const auto sensor = make_perspective_sensor(c.settings);
    const Vec3 position = sensor->sample_position(Vec2(0.3, 0.9));
    EXPECT_EQ(position, kOrigin);
    EXPECT_EQ(check_triple("pinhole " + c.name, direction_triple(*sensor, position),
                           film_chart(FilmGeometry(c.settings), Vec2(0))),
              "");
  }
}

TEST(Sensor, ThinLensDirectionsAreATriple) {
  for (const Camera& c : cameras())
    for (const Vec2& u : {Vec2(0.5), Vec2(0.93, 0.2), Vec2(0.1, 0.7)}) {
      const auto sensor = make_thinlens_sensor(c.settings, kAperture, kFocus);
      const Vec3 position = sensor->sample_position(u);
      const FilmGeometry film(c.settings);
      const Vec3 offset = position - kOrigin;
      const Vec2 shift = Vec2(dot(offset, film.right), dot(offset, film.down)) / kFocus;
      EXPECT_EQ(check_triple("thin lens " + c.name, direction_triple(*sensor, position),
                             film_chart(film, shift)),
                "");
    }
}

TEST(Sensor, ThinLensPositionsAreATriple) {
  const Camera c = cameras()[0];
  const auto sensor = make_thinlens_sensor(c.settings, kAperture, kFocus);
  const FilmGeometry film(c.settings);
  Chart chart;  // a disk of twice the aperture's area: c.x ∝ r²
  chart.point = [&](const Vec2& p) {
    const double r = kAperture * std::sqrt(2 * p.x), phi = 2 * kPi * p.y;
    return kOrigin + r * (std::cos(phi) * film.right + std::sin(phi) * film.down);
  };
  chart.coordinates = [&](const Vec3& x) {
    const double a = dot(x - kOrigin, film.right), b = dot(x - kOrigin, film.down);
    const double turn = std::atan2(b, a) / (2 * kPi);
    return Vec2((a * a + b * b) / (2 * sqr(kAperture)), turn < 0 ? turn + 1 : turn);
  };
  chart.jacobian = [](const Vec2&) { return 2 * kPi * sqr(kAperture); };
  const testing::Triple triple{2,
                               [&](const Vec3& u) -> std::optional<Vec3> {
                                 const Vec3 x = sensor->sample_position(Vec2(u));
                                 EXPECT_NEAR(dot(x - kOrigin, film.view), 0, 1e-14);
                                 return x;
                               },
                               [&](const Vec3& x) { return sensor->pdf_A(x); },
                               [&](const Vec3& x, const Vec3& aux) -> std::optional<Vec3> {
                                 if (sensor->pdf_A(x) == 0) return std::nullopt;
                                 return Vec3(sensor->invert_position(x, Vec2(aux)), 0);
                               }};
  EXPECT_EQ(check_triple("thin lens position", triple, chart), "");
}

TEST(Sensor, PinholeIsDirac) {
  const auto sensor = make_perspective_sensor(cameras()[0].settings);
  EXPECT_TRUE(sensor->dirac_position());
  EXPECT_EQ(sensor->pdf_A(kOrigin), 1);
  EXPECT_EQ(sensor->invert_position(kOrigin, Vec2(0.25, 0.75)), Vec2(0.25, 0.75));
  EXPECT_EQ(sensor->D(normalize(Vec3(1, 2, 3))), 1);
}

/// ∫∫ W_e D dσ dA = 1 with the lens in polar and directions in tangent coordinates.
TEST(Sensor, ThinLensImportanceIntegratesToOne) {
  for (const Camera& c : cameras()) {
    const auto sensor = make_thinlens_sensor(c.settings, kAperture, kFocus);
    const FilmGeometry film(c.settings);
    const auto r2 = testing::gauss_legendre(6, 0, sqr(kAperture));
    const auto unit = testing::gauss_legendre(24, 0, 1);
    constexpr int kAzimuths = 12;
    double integral = 0;
    for (std::size_t i = 0; i < r2.nodes.size(); ++i)
      for (int k = 0; k < kAzimuths; ++k) {
        const double r = std::sqrt(r2.nodes[i]), phi = 2 * kPi * (k + 0.5) / kAzimuths;
        const Vec2 lens(r * std::cos(phi), r * std::sin(phi));
        const Vec3 position = kOrigin + lens.x * film.right + lens.y * film.down;
        for (std::size_t a = 0; a < unit.nodes.size(); ++a)
          for (std::size_t b = 0; b < unit.nodes.size(); ++b) {
            const Vec2 raster(unit.nodes[a], unit.nodes[b]);
            const Vec3 w = film.direction(film.lo + raster * film.size - lens / kFocus);
            const double cosine = dot(w, film.view);
            EXPECT_NEAR(sensor->D(w), cosine, 1e-14);
            integral += r2.weights[i] * kPi / kAzimuths * unit.weights[a] * unit.weights[b] *
                        film.size.x * film.size.y * std::pow(cosine, 3) * sensor->W_e(position, w) *
                        cosine;
          }
      }
    EXPECT_NEAR(integral, 1, 1e-9) << c.name;
  }
}

TEST(Sensor, RaysOfOneRasterPositionMeetInFocus) {
  const Camera c = cameras()[2];
  const auto lens = make_thinlens_sensor(c.settings, kAperture, kFocus);
  const auto pinhole = make_perspective_sensor(c.settings);
  const Vec3 axis = FilmGeometry(c.settings).view;
  Rng rng(testing::suite_seed(), RngDomain::Test, 700, 0);
  for (int i = 0; i < 1000; ++i) {
    const Vec2 raster = uniform2(rng);
    const Vec3 chief = pinhole->sample_direction(kOrigin, raster).w;
    const Vec3 focus = kOrigin + kFocus / dot(chief, axis) * chief;
    const Vec3 position = lens->sample_position(uniform2(rng));
    const Vec3 w = lens->sample_direction(position, raster).w;
    EXPECT_LT(length(cross(focus - position, w)), 1e-13);
    EXPECT_GT(dot(focus - position, w), 0);
  }
}

TEST(Sensor, SeesNothingBehindOrBesideIt) {
  for (const Camera& c : cameras())
    for (const bool lens : {false, true}) {
      const auto sensor = lens ? make_thinlens_sensor(c.settings, kAperture, kFocus)
                               : make_perspective_sensor(c.settings);
      Rng rng(testing::suite_seed(), RngDomain::Test, 701, 0);
      for (int i = 0; i < 500; ++i) {
        const Vec3 position = sensor->sample_position(uniform2(rng));
        const Vec3 w = -sensor->sample_direction(position, uniform2(rng)).w;
        EXPECT_FALSE(sensor->raster(position, w));
        EXPECT_EQ(sensor->W_e(position, w), 0);
        EXPECT_EQ(sensor->pdf_sigma(position, w), 0);
      }
      const Vec3 across = normalize(cross(kTarget - kOrigin, kUp));
      EXPECT_EQ(sensor->W_e(kOrigin, across), 0);
    }
}

TEST(Sensor, NothingEntersBesideTheLens) {
  const Camera c = cameras()[0];
  const auto sensor = make_thinlens_sensor(c.settings, kAperture, kFocus);
  const FilmGeometry film(c.settings);
  EXPECT_GT(sensor->W_e(kOrigin + 0.999 * kAperture * film.down, film.view), 0);
  EXPECT_EQ(sensor->W_e(kOrigin + 1.001 * kAperture * film.down, film.view), 0);
}

/// Positions on the film; half as much again around it is beside it. Oblique to the rays where the
/// matrix shears.
TEST(Sensor, OrthographicPositionsAreATriple) {
  for (const Camera& c : cameras())
    for (const double shear : {0.0, 0.7}) {
      PerspectiveSettings s = c.settings;
      Mat4 stretch(1.0);
      stretch[0] = {3, 0, shear, 0};
      stretch[1] = {0.4 * shear, 2, -shear, 0};
      stretch[2] = {0, 0, 5, 0};  // along the rays: of no effect
      s.to_world = s.to_world * Transform(stretch);
      const auto sensor = make_orthographic_sensor(s);
      const Vec3 view = normalize(kTarget - kOrigin);
      const Vec3 a(s.to_world.matrix()[0]), b(s.to_world.matrix()[1]);
      const Vec2 whole(s.width, s.height);
      const Vec2 crop = s.crop_width == 0 ? whole : Vec2(s.crop_width, s.crop_height);
      const double aspect = whole.y / whole.x;
      const auto on_plane = [&](const Vec2& raster) {
        const Vec2 U =
            (Vec2(s.crop_x, s.crop_y) + raster * crop) / whole + s.principal_point_offset;
        return kOrigin + (1 - 2 * U.x) * a + (1 - 2 * U.y) * aspect * b;
      };
      Chart chart;
      chart.point = [&](const Vec2& p) { return on_plane(1.5 * p - 0.25); };
      chart.coordinates = [&](const Vec3& x) {
        const Vec3 o = on_plane(Vec2(0)), e = on_plane(Vec2(1, 0)) - o,
                   f = on_plane(Vec2(0, 1)) - o;
        const Vec3 n = cross(e, f);
        return (Vec2(dot(cross(x - o, f), n), dot(cross(e, x - o), n)) / dot(n, n) + 0.25) / 1.5;
      };
      // Area across the rays.
      chart.jacobian = [&](const Vec2&) {
        const Vec3 o = on_plane(Vec2(0));
        return 2.25 *
               std::fabs(dot(cross(on_plane(Vec2(1, 0)) - o, on_plane(Vec2(0, 1)) - o), view));
      };
      const testing::Triple triple{
          2,
          [&](const Vec3& u) -> std::optional<Vec3> {
            const SensorRay ray = sensor->sample_direction(Vec3(0), Vec2(u));
            EXPECT_LT(length(ray.w - view), 1e-14);
            EXPECT_NEAR(ray.pdf_sigma, sensor->pdf_sigma(ray.origin, view), 1e-12 * ray.pdf_sigma);
            return ray.origin;
          },
          [&](const Vec3& x) { return sensor->pdf_sigma(x, view); },
          [&](const Vec3& x, const Vec3&) -> std::optional<Vec3> {
            const auto raster = sensor->raster(x, view);
            if (!raster) return std::nullopt;
            return Vec3(*raster, 0);
          }};
      EXPECT_EQ(check_triple("orthographic " + c.name, triple, chart), "");
    }
}

TEST(Sensor, OrthographicSeesPointsFromTheFeetOfTheirRays) {
  PerspectiveSettings s = cameras()[1].settings;
  Mat4 stretch(1.0);
  stretch[0] = {3, 0, 0.5, 0};
  s.to_world = s.to_world * Transform(stretch);
  const auto sensor = make_orthographic_sensor(s);
  EXPECT_TRUE(sensor->parallel());
  EXPECT_FALSE(sensor->dirac_position());
  const Vec3 view = normalize(kTarget - kOrigin);
  EXPECT_EQ(sensor->pdf_A(kOrigin), 1);
  EXPECT_EQ(sensor->D(view), 1);
  EXPECT_EQ(sensor->invert_position(kOrigin, Vec2(0.25, 0.75)), Vec2(0.25, 0.75));
  Rng rng(testing::suite_seed(), RngDomain::Test, 703, 0);
  for (int i = 0; i < 100; ++i) {
    const SensorRay ray = sensor->sample_direction(kOrigin, uniform2(rng));
    const Vec3 seen = ray.origin + 7 * rng.uniform() * ray.w;
    EXPECT_LT(length(sensor->position_seeing(seen) - ray.origin), 1e-13);
    EXPECT_EQ(sensor->W_e(seen, -view), 0);
    EXPECT_EQ(sensor->pdf_sigma(seen, -view), 0);
    EXPECT_FALSE(sensor->raster(seen, -view));
    // ∫ W_e dA = 1, for it is a constant.
    EXPECT_EQ(sensor->W_e(seen, view), sensor->pdf_sigma(seen, view));
  }
}

TEST(Sensor, ScalesWithTheScene) {
  PerspectiveSettings s = cameras()[2].settings;
  s.near_clip = 0.5;
  s.far_clip = 20;
  const auto small = make_thinlens_sensor(s, kAperture, kFocus);
  s.to_world = Transform::scale(Vec3(1000)) * s.to_world;
  const auto large = make_thinlens_sensor(s, kAperture, kFocus);
  Rng rng(testing::suite_seed(), RngDomain::Test, 702, 0);
  for (int i = 0; i < 100; ++i) {
    const Vec2 u = uniform2(rng), raster = uniform2(rng);
    const Vec3 a = small->sample_position(u), b = large->sample_position(u);
    EXPECT_LT(length(b - 1000.0 * a), 1e-11);
    const Vec3 w = small->sample_direction(a, raster).w;
    EXPECT_LT(length(large->sample_direction(b, raster).w - w), 1e-12);
    EXPECT_NEAR(large->near_distance(w), 1000 * small->near_distance(w), 1e-8);
    EXPECT_NEAR(large->far_distance(w), 1000 * small->far_distance(w), 1e-6);
    EXPECT_NEAR(large->W_e(b, w) / (1e-6 * small->W_e(a, w)), 1, 1e-9);
  }
}

TEST(Sensor, MirroredCamerasMirrorThePicture) {
  PerspectiveSettings s = cameras()[0].settings;
  const auto plain = make_perspective_sensor(s);
  s.to_world = s.to_world * Transform::scale(Vec3(-1, 1, 1));
  const auto mirrored = make_perspective_sensor(s);
  const Vec3 w = plain->sample_direction(kOrigin, Vec2(0.2, 0.7)).w;
  const auto raster = mirrored->raster(kOrigin, w);
  ASSERT_TRUE(raster);
  EXPECT_NEAR(raster->x, 0.8, 1e-14);
  EXPECT_NEAR(raster->y, 0.7, 1e-14);
}

TEST(Sensor, RefusesImpossibleSettings) {
  const auto broken = [](auto&& change) {
    PerspectiveSettings s = cameras()[1].settings;
    change(s);
    EXPECT_THROW(make_perspective_sensor(s), std::domain_error);
    EXPECT_THROW(make_thinlens_sensor(s, 0.1, 1), std::domain_error);
  };
  const auto broken_film = [&](auto&& change) {
    broken(change);
    PerspectiveSettings s = cameras()[1].settings;
    change(s);
    EXPECT_THROW(make_orthographic_sensor(s), std::domain_error);
  };
  broken([](auto& s) { s.fov_x_degrees = 0; });
  broken([](auto& s) { s.fov_x_degrees = 180; });
  broken([](auto& s) { s.fov_x_degrees = std::nan(""); });
  broken_film([](auto& s) { s.near_clip = 0; });
  broken_film([](auto& s) { s.far_clip = s.near_clip; });
  broken_film([](auto& s) { s.crop_x = 101; });
  broken_film([](auto& s) { s.crop_height = 0; });
  broken_film([](auto& s) { s.width = 0; });
  broken([](auto& s) { s.to_world = Transform::scale(Vec3(1, 1, 2)); });
  Mat4 shear(1.0);
  shear[1][0] = 0.2;
  broken([&](auto& s) { s.to_world = Transform(shear); });
  const PerspectiveSettings good = cameras()[0].settings;
  for (const double bad : {0.0, -1.0, std::nan(""), kInfinity}) {
    EXPECT_THROW(make_thinlens_sensor(good, bad, 1), std::domain_error);
    EXPECT_THROW(make_thinlens_sensor(good, 1, bad), std::domain_error);
  }
}

}  // namespace
}  // namespace fogbow
