// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render.h"

#include <gtest/gtest.h>

#include "core/geometry/shapes.h"
#include "core/scene/emitters.h"
#include "media/media.h"
#include "mlt/render_settings.h"
#include "mlt/seen_light_picture.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

RenderOptions options_of(const std::string& integrator, std::uint64_t seed) {
  RenderOptions options;
  options.integrator = integrator;
  options.samples_per_pixel = 32;
  options.threads = 1;
  options.seed = seed;
  options.overrides = {{"chains", "2"}, {"luminance_samples", "4096"}};
  return options;
}

/// The lamp stands in fog so thick that the first samples carry next to nothing, and a later one
/// that comes out near the surface ordinary light.
TEST(Render, FilmHoldsLightThatTheFirstSamplesDidNotSee) {
  SceneDescription description = testing::make_test_scene("flame");
  Surface& cloud = description.surfaces.back();
  cloud.shape = make_cube(Transform::scale(Vec3(1.6)));
  cloud.interior = make_homogeneous_medium(RGB(100, 120, 140), RGB(0.99), make_isotropic_phase());
  const Scene scene(std::move(description));
  for (std::uint64_t seed = 0; seed < 12; ++seed)
    EXPECT_NO_THROW(render(scene, options_of("light", seed))) << seed;
}

TEST(Render, PointLightsAreNotSeenByPinholes) {
  SceneDescription description = testing::make_test_scene("mirror-fog");
  description.emitters = {make_point_emitter(Vec3(0, 0.2, 0.5), RGB(5))};
  const Scene scene(std::move(description));
  for (const char* integrator : {"path", "light", "bdpt", "pssmlt", "mlt"}) {
    const RenderResult result = render(scene, options_of(integrator, 1));
    ASSERT_FALSE(result.lengths.empty());
    EXPECT_EQ(result.lengths.front().k, 3) << integrator;
  }
}

TEST(Render, DirectLightIsOfPathsOfTwoEdges) {
  SceneDescription description = testing::make_test_scene("surfaces");
  description.integrator.type = "direct";
  const Scene direct(SceneDescription{description});
  for (const char* integrator : {"path", "bdpt", "mlt"}) {
    const RenderResult result = render(direct, options_of(integrator, 1));
    ASSERT_FALSE(result.lengths.empty());
    EXPECT_EQ(result.lengths.back().k, 3) << integrator;
  }
  RenderOptions deeper = options_of("path", 1);
  deeper.overrides = {{"max_depth", "3"}};
  EXPECT_EQ(render(direct, deeper).lengths.back().k, 4);
}

/// Lamps are out of view, and the pilot met no light: the film of seen light has a unit all the
/// same.
TEST(Render, SeenLightNeedsNoLightToBeSeen) {
  SceneDescription description = testing::make_test_scene("surfaces");
  description.integrator.type = "mlt";
  const Scene scene(std::move(description));
  RenderSettings settings = read_render_settings(scene, options_of("mlt", 1));
  settings.hide_emitters = true;
  settings.max_depth = 1;  // lamps seen directly, which are hidden
  EXPECT_NO_THROW(SeenLightPicture(scene, settings, 1, 0));
}

TEST(Render, TellsWhichLightAnIntegratorDoesNotSample) {
  const auto note = [](const char* integrator, const char* name) {
    SceneDescription description = testing::make_test_scene(name);
    for (const std::string& text :
         render(Scene(std::move(description)), options_of(integrator, 1)).notes)
      if (text.find("not sampled by") != std::string::npos) return text;
    return std::string();
  };
  EXPECT_NE(note("path", "mirror-fog").find("point or directional"), std::string::npos);
  EXPECT_EQ(note("path", "mirror-fog").find("seen"), std::string::npos);
  EXPECT_NE(note("bdpt", "mirror-fog").find("seen"), std::string::npos);
  EXPECT_NE(note("light", "glass-sphere-fog").find("seen through specular surfaces"),
            std::string::npos);
  EXPECT_EQ(note("path", "glass-sphere-fog"), "");
  EXPECT_EQ(note("light", "floor-fog"), "");
}

}  // namespace
}  // namespace fogbow
