// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/light_census.h"

#include <gtest/gtest.h>

#include "core/estimators/sampling.h"
#include "core/geometry/shapes.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
#include "media/media.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

using testing::make_test_scene;

constexpr std::uint64_t kSamples = 1 << 17;
constexpr EstimatorSettings kSettings{.max_depth = 12};

void expect_same(const ReplicateMean& a, const testing::Estimate& b) {
  EXPECT_GT(testing::welch({a.mean, a.standard_error, Film::kGroups}, b), 1e-5)
      << a.mean << " ± " << a.standard_error << " against " << b.mean << " ± " << b.standard_error;
}

/// Mean luminance of the contributions that `counts` wants, in independent replicates.
template <class Counts>
testing::Estimate mean_of(const Estimator& estimator, const Counts& counts) {
  constexpr int kReplicates = 32;
  std::vector<double> means(kReplicates);
  Workspace w;
  for (int r = 0; r < kReplicates; ++r)
    for (std::uint64_t i = 0; i < kSamples / kReplicates; ++i) {
      Rng rng(7, RngDomain::Test, static_cast<std::uint64_t>(r), i);
      RandomStream stream(rng);
      estimator.sample(stream, stream, w);
      for (const Contribution& c : w.contributions)
        if (counts(w, c)) means[r] += luminance(c.value) * kReplicates / kSamples;
    }
  return testing::estimate(means);
}

/// Light tracing tells caustics by what its subpath met first.
auto caustic(bool in_medium) {
  return [in_medium](const Workspace& w, const Contribution& c) {
    std::size_t i = 1;
    while (i < static_cast<std::size_t>(c.s) && w.light[i].x.degenerate) ++i;
    return i > 1 && i < static_cast<std::size_t>(c.s) && w.light[i].x.in_medium() == in_medium;
  };
}

TEST(LightCensus, FindsWhatOtherEstimatorsFind) {
  for (const char* name : {"surfaces", "glass-sphere-fog", "water", "two-kinds-of-glass"}) {
    SCOPED_TRACE(name);
    const Scene scene(make_test_scene(name));
    const LightCensus census = take_light_census(scene, kSettings, kSamples, 1);
    const auto light = make_light_tracer(scene, kSettings);
    testing::Estimate seen_by_lens = mean_of(*light, caustic(false));
    const testing::Estimate in_media = mean_of(*light, caustic(true));
    seen_by_lens.mean += in_media.mean;
    seen_by_lens.standard_error = std::hypot(seen_by_lens.standard_error, in_media.standard_error);
    ReplicateMean direct{
        census.surface_caustic.mean + census.volume_caustic.mean - census.caustic_seen_through.mean,
        std::hypot(census.surface_caustic.standard_error, census.volume_caustic.standard_error,
                   census.caustic_seen_through.standard_error)};
    if (seen_by_lens.mean > 0)
      expect_same(direct, seen_by_lens);
    else
      EXPECT_EQ(direct.mean, 0);
    const auto seen = make_seen_light(scene, kSettings);
    expect_same(census.seen_light,
                mean_of(*seen, [](const auto&, const Contribution& c) { return !c.glow; }));
    const testing::Estimate glow =
        mean_of(*seen, [](const auto&, const Contribution& c) { return c.glow; });
    if (glow.mean > 0)
      expect_same(census.seen_glow, glow);
    else
      EXPECT_EQ(census.seen_glow.mean, 0);
    EXPECT_NEAR(census.seen_light.mean + census.seen_glow.mean + census.by_next_event.mean +
                    census.surface_caustic.mean + census.volume_caustic.mean,
                census.luminance.mean, 1e-9 * census.luminance.mean);
  }
}

/// Where nothing is specular, what glows is seen by paths of two vertices, and next-event
/// estimation makes the rest.
TEST(LightCensus, TellsGlowThatIsSeenFromGlowThatLights) {
  for (const char* name : {"flame", "patchy-flame"}) {
    SCOPED_TRACE(name);
    const Scene scene(make_test_scene(name));
    const LightCensus census = take_light_census(scene, kSettings, kSamples, 1);
    const auto path = make_path_tracer(scene, kSettings);
    const auto all = [](const auto&, const auto&) { return true; };
    const auto straight = [](const auto&, const Contribution& c) { return c.k == 2; };
    const auto scattered = [](const auto&, const Contribution& c) { return c.k > 2; };
    ReplicateMean seen{
        census.seen_light.mean + census.seen_glow.mean,
        std::hypot(census.seen_light.standard_error, census.seen_glow.standard_error)};
    EXPECT_GT(census.seen_glow.mean, 0);
    expect_same(seen, mean_of(*path, straight));
    expect_same(seen, mean_of(*make_seen_light(scene, kSettings), all));
    expect_same(census.by_next_event, mean_of(*path, scattered));
  }
}

TEST(LightCensus, KnowsThatEqualSamplesAreEasy) {
  SceneDescription sky = make_test_scene("surfaces");
  sky.surfaces.clear();
  sky.emitters = {make_constant_emitter(RGB(2))};
  const LightCensus census = take_light_census(Scene(std::move(sky)), kSettings, 4096, 1);
  expect_same(census.luminance, {2, 0, 1e9});
  EXPECT_DOUBLE_EQ(census.seen_light.mean, census.luminance.mean);
  // The technique that connects the sky to the pinhole makes them a little unequal.
  EXPECT_GT(census.half_in, 0.45);
  EXPECT_LE(census.half_in, 0.5);
  EXPECT_EQ(census.dirac_lit_through, 0);
  EXPECT_EQ(census.seen_through, 0);
}

TEST(LightCensus, SeesPointLightsShutUpInGlass) {
  SceneDescription d = make_test_scene("surfaces");
  for (Surface& s : d.surfaces) s.emitter = nullptr;
  Surface ball = d.surfaces.front();
  ball.shape = make_sphere(Vec3(0, 0.5, 0), 0.2);
  ball.bsdf = make_dielectric(1.5);
  d.surfaces.push_back(std::move(ball));
  d.emitters = {make_point_emitter(Vec3(0, 0.5, 0), RGB(1))};
  const LightCensus census = take_light_census(Scene(std::move(d)), kSettings, 1 << 14, 1);
  EXPECT_EQ(census.dirac_lit_through, 1);
  EXPECT_GT(census.seen_through, 0);
  EXPECT_EQ(census.by_next_event.mean, 0);
  EXPECT_GT(census.surface_caustic.mean, 0);
}

/// Glass in a box of fog under the lamp, of which the camera sees but the floor below: then light
/// tracing makes all there is, and tells caustics in fog from those on the floor, and what has been
/// in the fog at all.
TEST(LightCensus, TellsFogFromFloorWhereNothingIsSeenThrough) {
  SceneDescription d = make_test_scene("glass-sphere-fog");
  const auto fog = make_homogeneous_medium(RGB(2), RGB(0.95), make_isotropic_phase());
  const Vec3 middle(0.3, 0.8, 0.2);
  d.sensor_medium = nullptr;
  d.sensor_medium_declared = false;
  d.surfaces.back().exterior = fog;
  d.surfaces.back().shape = make_sphere(middle, 0.3);
  Surface box = d.surfaces.back();
  box.bsdf = make_null();
  box.interior = fog;
  box.exterior = nullptr;
  box.shape = make_cube(Transform::translate(middle) * Transform::scale(Vec3(0.5)));
  d.surfaces.push_back(std::move(box));
  PerspectiveSettings camera;
  camera.to_world = Transform::look_at(Vec3(0, -0.4, 3), Vec3(0.1, -0.95, 0), Vec3(0, 1, 0));
  camera.fov_x_degrees = 20;
  camera.width = camera.height = d.film.width;
  d.sensor = make_perspective_sensor(camera);
  const Scene scene(std::move(d));
  const LightCensus census = take_light_census(scene, kSettings, kSamples, 1);
  EXPECT_EQ(census.seen_through, 0);
  EXPECT_EQ(census.caustic_seen_through.mean, 0);
  EXPECT_GT(census.volume_caustic.mean, 0.1 * census.surface_caustic.mean);
  const auto light = make_light_tracer(scene, kSettings);
  expect_same(census.surface_caustic, mean_of(*light, caustic(false)));
  expect_same(census.volume_caustic, mean_of(*light, caustic(true)));
  expect_same(census.in_media, mean_of(*light, [](const Workspace& w, const Contribution& c) {
                return std::any_of(w.light.begin(), w.light.begin() + c.s,
                                   [](const SubpathVertex& v) { return v.x.in_medium(); });
              }));
}

}  // namespace
}  // namespace fogbow
