// SPDX-License-Identifier: GPL-3.0-or-later
// The integrators on the scenes built in code: each is compared with bdpt on exactly the paths
// that both can make (validation 2 and "Power" of the design).
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "core/estimators/sampling.h"
#include "core/geometry/shapes.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
#include "tests/helpers/test_scenes.h"
#include "tests/statistical/agreement_sampling.h"

namespace fogbow {
namespace {

using namespace testing;

constexpr int kLongest = 7;      // vertices
constexpr int kReplicates = 64;  // of independent samples
/// Of chains.
const int kRuns = std::getenv("FOGBOW_LONG") ? 48 : 32;
/// Mutations of a pilot run. A short one knows little of the errors of a long one: what chains
/// seldom visit is then all in b.
const std::uint64_t kPilotMutations = std::getenv("FOGBOW_LONG") ? 1 << 20 : 1 << 16;
constexpr std::uint64_t kMutationsPerPrimarySample = 8;  // in time
/// An upper bound on the tests of this file together; counted below.
constexpr int kTests = 3250, kTestsOfOneScene = 130, kTestsOfTwoStages = 60;
const double kLevel = sidak(kSuiteFalseAlarm, kTests);

/// In the long suite what validation asks for. In the fast one as much as seconds allow: less
/// where much light reaches the eye only by paths that run into the lamp through glass, and where
/// the cloud has many classes of little light each.
Precision precision(const std::string& scene) {
  if (std::getenv("FOGBOW_LONG")) return {0.01, 0.05};
  const std::set<std::string> costly{"water", "smoke-in-glass", "glass-sphere-fog"};
  return costly.contains(scene) ? Precision{0.25, 1} : Precision{0.2, 0.8};
}

std::string test_name(const ::testing::TestParamInfo<TestScene>& info) {
  std::string name = info.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

class Agreement : public ::testing::TestWithParam<TestScene> {
 protected:
  Agreement() : scene_(GetParam().make()), wanted_(precision(GetParam().name)) {}

  Sampling independent(const Estimator& estimator, bool classified, std::uint64_t stream) const {
    return sample_until(
        [&](std::uint64_t samples, std::uint64_t s) {
          return sample(scene_, estimator, classified, kLongest, kReplicates, samples, s);
        },
        512, wanted_, kLevel, suite_seed() + stream);
  }
  Sampling chains(const std::string& integrator, bool two_stage, std::uint64_t stream) const {
    const std::uint64_t pilot =
        integrator == "mlt" ? kPilotMutations : kPilotMutations / kMutationsPerPrimarySample;
    return sample_until(
        [&](std::uint64_t mutations, std::uint64_t s) {
          return render_chains(scene_, {integrator, kLongest, two_stage}, kRuns, mutations, s);
        },
        pilot, wanted_, kLevel, suite_seed() + stream);
  }
  int expect(const std::string& title, const Sampling& a, const Sampling& b,
             Restriction which = Restriction::All) const {
    const auto at = [&](const Sampling& s) -> const Replicates& {
      return s[s.size() == 1 ? 0 : static_cast<std::size_t>(which)];
    };
    return expect_agreement(GetParam().name + ": " + title, at(a), at(b), wanted_, kLevel);
  }

  const Scene scene_;
  const Precision wanted_;
  const EstimatorSettings settings_{.max_depth = kLongest - 1};
};

TEST_P(Agreement, EachIntegratorEqualsBdptOnWhatBothCanMake) {
  if (!std::getenv("FOGBOW_LONG") && GetParam().name == "droplets")
    GTEST_SKIP() << "in the long suite: chains take minutes for its rare classes";
  const Sampling bdpt = independent(*make_bdpt(scene_, settings_), true, 10);
  const Sampling path = independent(*make_path_tracer(scene_, settings_), false, 20);
  const Sampling light = independent(*make_light_tracer(scene_, settings_), true, 30);

  int tests = expect("bdpt, path", bdpt, path, Restriction::ByPath);
  tests += expect("bdpt, light", bdpt, light, Restriction::ByLight);
  // Chains take a minute or more on each scene: a sample of them, all in the long suite. In the
  // fast one class_shares_test compares chains with bdpt on every scene.
  const std::set<std::string> sampled{"surfaces", "flame"};
  if (!std::getenv("FOGBOW_LONG") && !sampled.contains(GetParam().name)) return;
  // Chains that share their time as the light is shared know the mean best.
  tests += expect("bdpt, pssmlt", bdpt, chains("pssmlt", false, 40));
  tests += expect("bdpt, mlt", bdpt, chains("mlt", false, 50));
  EXPECT_LE(tests, kTestsOfOneScene);
  const auto part = [&](Restriction which) {
    const auto mean = [&](Restriction r) { return bdpt[static_cast<std::size_t>(r)].mean().mean; };
    return 100 * mean(which) / mean(Restriction::All);
  };
  std::printf("%-44s path can make %.1f%%, light %.1f%% (beyond the lens) of the light\n",
              GetParam().name.c_str(), part(Restriction::ByPath), part(Restriction::ByLight));
}

TEST_P(Agreement, TwoStagesMakeTheSamePicture) {
  const std::set<std::string> few{"surfaces"};
  if (!std::getenv("FOGBOW_LONG") && !few.contains(GetParam().name))
    GTEST_SKIP() << "in the long suite";
  const Sampling bdpt = independent(*make_bdpt(scene_, settings_), false, 70);
  int tests = expect("bdpt, pssmlt in two stages", bdpt, chains("pssmlt", true, 80));
  tests += expect("bdpt, mlt in two stages", bdpt, chains("mlt", true, 90));
  EXPECT_LE(tests, kTestsOfTwoStages);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, ::testing::ValuesIn(test_scenes()), test_name);

/// Balls of few triangles with interpolated normals, which stand far off the geometric ones: the
/// adjoint factor of light paths is large.
std::shared_ptr<const Shape> coarse_ball(const Vec3& center, double radius) {
  constexpr std::uint32_t kRings = 8, kSectors = 12;
  TriangleMeshData mesh;
  for (std::uint32_t j = 0; j <= kRings; ++j)
    for (std::uint32_t i = 0; i < kSectors; ++i) {
      const double theta = kPi * j / kRings, phi = 2 * kPi * i / kSectors;
      const Vec3 n(std::sin(theta) * std::cos(phi), std::cos(theta),
                   std::sin(theta) * std::sin(phi));
      mesh.positions.push_back(center + radius * n);
      mesh.normals.push_back(n);
    }
  const auto vertex = [&](std::uint32_t j, std::uint32_t i) { return j * kSectors + i % kSectors; };
  for (std::uint32_t j = 0; j < kRings; ++j)
    for (std::uint32_t i = 0; i < kSectors; ++i) {
      if (j > 0) mesh.triangles.push_back({vertex(j, i), vertex(j, i + 1), vertex(j + 1, i + 1)});
      if (j + 1 < kRings)
        mesh.triangles.push_back({vertex(j, i), vertex(j + 1, i + 1), vertex(j + 1, i)});
    }
  return make_mesh(std::move(mesh));
}

SceneDescription shading_normals_scene() {
  SceneDescription d = make_test_scene("surfaces");
  d.surfaces.resize(2);  // floor and lamp
  const auto add = [&](std::shared_ptr<const Shape> shape, std::shared_ptr<const Bsdf> bsdf) {
    Surface s;
    s.shape = std::move(shape);
    s.bsdf = std::move(bsdf);
    s.id = "ball " + std::to_string(d.surfaces.size());
    d.surfaces.push_back(std::move(s));
  };
  add(coarse_ball(Vec3(-0.6, -0.4, 0), 0.55), make_twosided(make_diffuse(RGB(0.9, 0.7, 0.5))));
  add(coarse_ball(Vec3(0.6, -0.4, 0), 0.55),
      make_rough_dielectric({MicrofacetKind::Beckmann, 0.5, 0.5}, 1.5));
  return d;
}

TEST(ShadingNormals, PathTracingEqualsLightTracing) {
  const Scene scene(shading_normals_scene());
  const EstimatorSettings settings{.max_depth = kLongest - 1};
  const Precision wanted = precision("shading normals");
  const auto run = [&](const Estimator& estimator, std::uint64_t stream) {
    return sample_until(
        [&](std::uint64_t samples, std::uint64_t s) {
          return sample(scene, estimator, false, kLongest, kReplicates, samples, s);
        },
        512, wanted, kLevel, suite_seed() + stream);
  };
  const int tests = expect_agreement(
      "shading normals: path, light", run(*make_path_tracer(scene, settings), 50)[0],
      run(*make_light_tracer(scene, settings), 60)[0], wanted, kLevel);
  EXPECT_LE(tests + static_cast<int>(test_scenes().size()) * (kTestsOfOneScene + kTestsOfTwoStages),
            kTests);
}

/// That both agree tells nothing of what they agree on: radiance sees the shading cosine at the
/// light's side [Veach1997, eq. 5.17].
TEST(ShadingNormals, CosineTowardsTheLightIsThatOfTheShadingNormal) {
  const Scene scene(shading_normals_scene());
  const RGB albedo(0.9, 0.7, 0.5);
  Subpath eye;
  int scattered = 0, apart = 0;
  for (int i = 0; i < 20000; ++i) {
    Rng rng(suite_seed(), RngDomain::Test, 91, i);
    RandomStream stream(rng);
    Vec2 raster;
    trace_eye_subpath(scene, stream, 2, eye, raster);
    if (eye.size() < 2 || eye[1].x.id.shape != 2) continue;  // the diffuse ball
    const Vertex& x = eye[1].x;
    const auto direction = [&] {
      const double z = 2 * rng.uniform() - 1, phi = 2 * kPi * rng.uniform(),
                   r = std::sqrt(1 - z * z);
      return Vec3(r * std::cos(phi), r * std::sin(phi), z);
    };
    const Vec3 w_light = direction(), w_eye = direction();
    const double s_light = dot(x.point.shading.n, w_light), s_eye = dot(x.point.shading.n, w_eye);
    const double g_light = dot(x.point.n_g, w_light), g_eye = dot(x.point.n_g, w_eye);
    const bool seen = s_light * g_light > 0 && s_eye * g_eye > 0 && s_light * s_eye > 0;
    const RGB value = f_hat(scene, x, w_light, w_eye, false) * std::abs(g_light);
    for (int c = 0; c < 3; ++c)
      ASSERT_NEAR(value[c], seen ? albedo[c] / kPi * std::abs(s_light) : 0, 1e-12);
    scattered += seen;
    apart += seen && std::abs(s_light / g_light - 1) > 0.1;
  }
  EXPECT_GT(scattered, 200);
  EXPECT_GT(apart, 20);
}

/// Images of one path length each, from the same samples, add up to the whole.
TEST(Lengths, ImagesOfOneLengthSumToTheWhole) {
  constexpr int kRounds = 20, kExponent = -40;
  for (const TestScene& s : test_scenes()) {
    const Scene scene(s.make());
    const EstimatorSettings settings{.max_depth = kLongest - 1};
    for (const auto& estimator :
         {make_path_tracer(scene, settings).release(), make_light_tracer(scene, settings).release(),
          make_bdpt(scene, settings).release()}) {
      const std::unique_ptr<Estimator> owner(estimator);
      const auto render = [&](int only_length) {
        IndependentSampling sampling(*estimator, scene.film(), 3, kExponent, only_length);
        for (int i = 0; i < kRounds; ++i) sampling.run_round();
        return sampling.develop();
      };
      const Image whole = render(0);
      std::vector<double> sum(whole.pixels.size());
      int lit = 0;
      for (int k = 2; k <= kLongest; ++k) {
        const Image part = render(k);
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += part.pixels[i];
        lit += *std::max_element(part.pixels.begin(), part.pixels.end()) > 0;
      }
      EXPECT_GT(lit, 2) << s.name << ", " << estimator->name();
      for (std::size_t i = 0; i < sum.size(); ++i)
        if (i % whole.channels.size() < 3) {
          ASSERT_NEAR(sum[i], whole.pixels[i], 1e-6 * whole.pixels[i])
              << s.name << ", " << estimator->name();
        }
    }
  }
}

}  // namespace
}  // namespace fogbow
