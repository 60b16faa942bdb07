// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "core/estimators/sampling.h"
#include "core/geometry/shapes.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/texture.h"
#include "media/media.h"
#include "mlt/render_settings.h"
#include "mlt/seen_light_picture.h"
#include "tests/helpers/statistics.h"
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

/// All light on one pixel, where the importance is least, and of a colour of little luminance.
TEST(Render, ChainsMayAllEndOnOneBluePixel) {
  SceneDescription description = testing::make_test_scene("surfaces");
  std::erase_if(description.surfaces, [](const Surface& s) { return !s.emitter; });
  Surface spot;
  spot.shape = make_sphere(Vec3(0), 0.02);
  spot.bsdf = make_diffuse(RGB(0, 0, 0.8));
  description.surfaces.push_back(std::move(spot));
  const Scene scene(std::move(description));
  RenderOptions options = options_of("mlt", 1);
  options.samples_per_pixel = 2048;
  const RenderResult result = render(scene, options);
  EXPECT_GT(result.b, 0);
  EXPECT_EQ(result.non_finite, 0u);
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

/// Values add up, and independent errors by their squares.
TEST(SeenLightPicture, AddsToWhatChainsHaveMade) {
  const Scene scene(testing::make_test_scene("sky-lens"));
  RenderSettings settings;
  settings.max_depth = 4;
  SeenLightPicture seen(scene, settings, 1, 0.1);
  seen.keep_up(1);
  const auto [width, height] = rendered_size(scene.film());
  Image black(width, height, {"R", "G", "B", "Error.R", "Error.G", "Error.B"}), grey = black;
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 6; ++c) grey.pixels[6 * i + c] = c < 3 ? 2.0f : 0.03f;
  const Image alone = seen.add_to(black), sum = seen.add_to(grey);
  int lit = 0;
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = alone.pixels[6 * i + c], error = alone.pixels[6 * i + 3 + c];
      EXPECT_FLOAT_EQ(sum.pixels[6 * i + c], 2 + value);
      EXPECT_FLOAT_EQ(sum.pixels[6 * i + 3 + c], std::hypot(0.03f, error));
      lit += error > 0.01f;
    }
  EXPECT_GT(lit, 100);
}

/// Two skies, of one colour each.
TEST(Render, AllThatShinesFromInfinityIsSeen) {
  SceneDescription d = testing::make_test_scene("surfaces");
  d.surfaces.clear();
  d.emitters = {make_constant_emitter(RGB(1, 0, 0)), make_constant_emitter(RGB(0, 3, 0))};
  const Scene scene(std::move(d));
  for (const char* integrator : {"path", "bdpt", "pssmlt", "mlt"}) {
    const RenderResult result = render(scene, options_of(integrator, 1));
    EXPECT_NEAR(result.b, luminance(RGB(1, 3, 0)), 0.05) << integrator;
    RGB mean(0);
    const int pixels = result.image.width * result.image.height;
    for (int y = 0; y < result.image.height; ++y)
      for (int x = 0; x < result.image.width; ++x)
        mean += RGB(result.image.at(x, y, 0), result.image.at(x, y, 1), result.image.at(x, y, 2)) /
                double(pixels);
    EXPECT_LT(length(mean - RGB(1, 3, 0)), 0.05) << integrator;
  }
}

/// By every way to make the picture; of chains, seen light is sampled beside them.
TEST(Render, HiddenEmittersAreNotSeen) {
  const Scene scene(testing::make_test_scene("sky-lens"));
  for (const char* integrator : {"path", "light", "bdpt", "pssmlt", "mlt"}) {
    RenderOptions options = options_of(integrator, 1);
    options.samples_per_pixel = 2;
    EXPECT_EQ(render(scene, options).lengths.front().k, 2) << integrator;
    options.overrides.emplace_back("hide_emitters", "true");
    EXPECT_EQ(render(scene, options).lengths.front().k, 3) << integrator;
  }
}

/// Chains whose number does not divide that of the mutations make them all the same.
TEST(Render, ChainsMakeAsManyMutationsAsAskedFor) {
  const Scene scene(testing::make_test_scene("surfaces"));
  const auto [width, height] = rendered_size(scene.film());
  RenderOptions options = options_of("pssmlt", 1);
  options.overrides[0].second = "7";
  options.samples_per_pixel = 2;
  ASSERT_NE(2 * width * height % (7 * Film::kGroups), 0);
  EXPECT_EQ(render(scene, options).samples, static_cast<std::uint64_t>(2 * width * height));
}

/// In a room that hardly absorbs, the paths where the program's own limit cuts carry light.
TEST(Render, TellsWhatTheLongestPathsCarry) {
  SceneDescription d = testing::make_test_scene("surfaces");
  d.surfaces.clear();
  Surface& room = d.surfaces.emplace_back();
  room.shape = make_cube(Transform::scale(Vec3(4)), true);
  room.bsdf = make_diffuse(RGB(0.999));
  Surface& lamp = d.surfaces.emplace_back();
  lamp.shape = make_sphere(Vec3(2), 0.5);
  lamp.bsdf = make_diffuse(RGB(0.5));
  lamp.emitter = make_area_emitter(lamp.shape, RGB(3));
  const Scene scene(std::move(d));
  RenderOptions options = options_of("path", 1);
  options.samples_per_pixel = 1;
  const RenderResult result = render(scene, options);
  ASSERT_EQ(result.lengths.back().k, 257);
  std::ostringstream carried;
  carried << "carry " << 100 * result.lengths.back().value / result.b << "%";
  EXPECT_TRUE(std::ranges::any_of(result.notes, [&](const std::string& note) {
    return note.find(carried.str()) != std::string::npos;
  })) << carried.str();
}

/// b over many seeds: right even where chains are but two steps long, whose last states carry half
/// of the light, and spread as each run says of itself.
TEST(Render, BOfShortRunsIsRightAndItsErrorsAreTrue) {
  const Scene scene(testing::make_test_scene("surfaces"));
  const auto [width, height] = rendered_size(scene.film());
  const auto run = [&](const std::string& integrator, std::uint64_t seed, double samples) {
    RenderOptions options = options_of(integrator, seed);
    options.samples_per_pixel = samples;
    options.overrides.insert(options.overrides.end(), {{"max_depth", "4"}, {"two_stage", "false"}});
    return render(scene, options);
  };
  const double expected = run("bdpt", 77, 256).b;
  const double two_steps = 2.0 * 2 * Film::kGroups / (width * height);
  constexpr int kSeeds = 40;
  for (const auto& [integrator, samples] :
       {std::pair{"path", 8.0}, {"pssmlt", two_steps}, {"mlt", two_steps}}) {
    std::vector<double> b;
    double stated = 0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const RenderResult result = run(integrator, seed, samples);
      b.push_back(result.b);
      stated += sqr(result.b_stderr) / kSeeds;
    }
    const testing::Estimate found = testing::estimate(b);
    EXPECT_NEAR(found.mean, expected, 4.5 * found.standard_error + 0.01 * expected) << integrator;
    // The variance of so few runs is known to a quarter of itself, and has a tail.
    const double variance = kSeeds * sqr(found.standard_error);
    EXPECT_GT(stated, 0.3 * variance) << integrator;
    EXPECT_LT(stated, 3 * variance) << integrator;
  }
}

/// Of which one half is no number.
class HalfBroken final : public Texture {
 public:
  RGB color(const SurfacePoint& x) const override { return RGB(number(x)); }
  double number(const SurfacePoint& x) const override {
    return x.uv.x < 0.5 ? std::numeric_limits<double>::quiet_NaN() : 0.5;
  }
  Range range() const override { return {0.5, 0.5}; }
  RGB mean() const override { return RGB(0.5); }
};

/// A wall fills the picture.
SceneDescription wall_under(std::shared_ptr<const Bsdf> bsdf, std::shared_ptr<Emitter> emitter) {
  SceneDescription d = testing::make_test_scene("surfaces");
  d.surfaces.clear();
  Surface& wall = d.surfaces.emplace_back();
  wall.shape = make_rectangle(Transform::scale(Vec3(9, 9, 1)));
  wall.bsdf = std::move(bsdf);
  d.emitters = {std::move(emitter)};
  return d;
}

/// A wall fills the picture, and one half of it scatters what is not finite: with a path tracer, of
/// a point light's direct light exactly one half is refused. The rest is as it should be.
TEST(Render, CountsWhatIsNotFinite) {
  const std::shared_ptr<const Texture> half = std::make_shared<HalfBroken>();
  const Scene scene(wall_under(make_diffuse(half), make_point_emitter(Vec3(0, 0.3, 2.5), RGB(4))));
  for (const char* integrator : {"path", "light", "bdpt", "pssmlt", "mlt"}) {
    SCOPED_TRACE(integrator);
    RenderOptions options = options_of(integrator, 1);
    options.samples_per_pixel = 4;
    options.overrides.emplace_back("max_depth", "2");
    const RenderResult result = render(scene, options);
    EXPECT_GT(result.non_finite, 0u);
    if (integrator == std::string("path")) {
      EXPECT_EQ(result.non_finite, result.samples / 2);
    }
    EXPECT_TRUE(std::isfinite(result.b) && std::isfinite(result.b_stderr));
    for (const float value : result.image.pixels) ASSERT_TRUE(std::isfinite(value));
  }
}

/// A mirror of which one half reflects no number, under a sky: beside what chains refused.
TEST(SeenLightPicture, CountsWhatIsNotFinite) {
  const std::shared_ptr<const Texture> half = std::make_shared<HalfBroken>();
  const Scene scene(
      wall_under(make_conductor(RGB(0), RGB(1), half), make_constant_emitter(RGB(1))));
  for (const char* integrator : {"path", "bdpt"}) {
    const RenderResult result = render(scene, options_of(integrator, 1));
    EXPECT_GT(result.non_finite, result.samples / 3) << integrator;
    EXPECT_GT(result.b, 0) << integrator;
  }
  RenderSettings settings;
  settings.max_depth = 3;
  SeenLightPicture seen(scene, settings, 1, 0.1);
  seen.keep_up(1);
  const auto [width, height] = rendered_size(scene.film());
  RenderResult result;
  result.image = Image(width, height, {"R", "G", "B", "Error.R", "Error.G", "Error.B"});
  result.non_finite = 5;
  seen.add_to(result);
  EXPECT_GE(result.non_finite, 5u + static_cast<unsigned>(width * height / 2));
  EXPECT_GT(result.b, 0);
  for (const float value : result.image.pixels) ASSERT_TRUE(std::isfinite(value));
}

}  // namespace
}  // namespace fogbow
