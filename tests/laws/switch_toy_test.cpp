// SPDX-License-Identifier: GPL-3.0-or-later
// Surface against volume where both are known by quadrature: a point light, a pinhole, a diffuse
// floor, isotropic fog, and one vertex that is free. Chains that only flip and perturb must share
// their time between floor and fog as light does, and stay where it falls.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/geometry/shapes.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/emitters.h"
#include "core/scene/sensors.h"
#include "media/media.h"
#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"
#include "tests/helpers/statistics.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

constexpr int kChains = 64;
const int kSteps = std::getenv("FOGBOW_LONG") ? 1 << 17 : 1 << 13;
constexpr double kSigmaT = 0.6, kAlbedo = 0.7, kReflectance = 0.5, kFov = 40, kWater = 1.33;

/// A ray of the camera where it enters the fog, and what of the light along it the camera sees.
struct ViewRay {
  Vec3 o, w;
  double seen;
};

struct Toy {
  std::string name;
  Vec3 camera, target, light;
  int k;           ///< vertices of a path
  int degenerate;  ///< which of them is specular; −1 for none
  std::function<void(SceneDescription&)> add;
  /// Of power I = 1: flux through an area across the light's way at p, and the way there.
  struct Arrival {
    double across;
    Vec3 w;
  };
  std::function<Arrival(const Vec3& p)> arrival;
  std::function<ViewRay(const Vec3& o, const Vec3& w)> view;
};

// ---- the scenes ---------------------------------------------------------------------------------

std::shared_ptr<const Medium> fog() {
  static const auto medium =
      make_homogeneous_medium(RGB(kSigmaT), RGB(kAlbedo), make_isotropic_phase(), RGB(0));
  return medium;
}

void add_surface(SceneDescription& d, std::shared_ptr<const Shape> shape,
                 std::shared_ptr<const Bsdf> bsdf) {
  Surface& s = d.surfaces.emplace_back();
  s.shape = std::move(shape);
  s.bsdf = std::move(bsdf);
  s.id = "surface " + std::to_string(d.surfaces.size());
}

SceneDescription describe(const Toy& toy) {
  SceneDescription d;
  d.film = {16, 16, 0, 0, 0, 0, make_box_filter()};
  PerspectiveSettings s;
  s.to_world = Transform::look_at(toy.camera, toy.target, Vec3(0, 1, 0));
  s.fov_x_degrees = kFov;
  s.width = s.height = 16;
  s.near_clip = 1e-6;  // fog is seen from the pinhole on
  d.sensor = make_perspective_sensor(s);
  add_surface(d, make_rectangle(Transform::rotate(Vec3(1, 0, 0), -90) * Transform::scale(Vec3(8))),
              make_diffuse(RGB(kReflectance)));
  d.emitters.push_back(make_point_emitter(toy.light, RGB(1)));
  toy.add(d);
  return d;
}

void in_fog(SceneDescription& d) {
  d.sensor_medium = fog();
  d.sensor_medium_declared = true;
}

/// Fog in water up to y = `level`.
void add_water(SceneDescription& d, double level) {
  add_surface(
      d, make_cube(Transform::translate(Vec3(0, level - 2, 0)) * Transform::scale(Vec3(9, 2, 9))),
      make_dielectric(kWater));
  Surface& s = d.surfaces.back();
  s.medium_boundary = true;
  s.interior = fog();
}

Toy::Arrival direct(const Vec3& from, const Vec3& p) {
  const double r = length(p - from);
  return {std::exp(-kSigmaT * r) / sqr(r), (p - from) / r};
}

ViewRay straight(const Vec3& o, const Vec3& w) { return {o, w, 1}; }

const Vec3 kUp(0, 1, 0);

Toy no_specular_surface() {
  Toy t{"no_specular_surface",
        Vec3(-0.4, 1.2, 0),
        Vec3(0.5, 0, 0.1),
        Vec3(0.9, 0.9, 0.5),
        3,
        -1,
        in_fog,
        {},
        straight};
  t.arrival = [light = t.light](const Vec3& p) { return direct(light, p); };
  return t;
}

Toy refraction_of_light() {
  constexpr double level = 1.6;
  Toy t{"refraction_of_light",
        Vec3(-0.4, 1.2, 0),
        Vec3(0.5, 0, 0.1),
        Vec3(1.3, 2.2, 0.5),
        4,
        1,
        [](SceneDescription& d) {
          add_water(d, level);
          in_fog(d);
        },
        {},
        straight};
  t.arrival = [light = t.light](const Vec3& p) {
    const auto link = flat_refraction(light, p, Vec3(0, level, 0), kUp, 1, kWater);
    const Vec3 in = normalize(link.vertex - light), out = p - link.vertex;
    const double through = 1 - fresnel_dielectric(-in.y, kWater);
    return Toy::Arrival{link.jacobian * through * std::exp(-kSigmaT * length(out)), normalize(out)};
  };
  return t;
}

Toy refraction_of_sight() {
  constexpr double level = 1.1;
  Toy t{"refraction_of_sight",
        Vec3(-0.4, 1.8, 0),
        Vec3(0.5, 0, 0.1),
        Vec3(0.9, 0.8, 0.5),
        4,
        2,
        [](SceneDescription& d) { add_water(d, level); },
        {},
        {}};
  t.arrival = [light = t.light](const Vec3& p) { return direct(light, p); };
  t.view = [](const Vec3& o, const Vec3& w) {
    const Vec3 surface = o + (level - o.y) / w.y * w;
    return ViewRay{surface, *refract_direction(w, kUp, kWater),
                   1 - fresnel_dielectric(-w.y, kWater)};
  };
  return t;
}

Toy plane_mirror() {
  constexpr double wall = 2.5;
  Toy t{"plane_mirror",
        Vec3(-0.4, 1.2, 0),
        Vec3(0.5, 0, 0.1),
        Vec3(0.9, 0.9, 0.5),
        4,
        1,
        [](SceneDescription& d) {
          add_surface(d,
                      make_rectangle(Transform::translate(Vec3(wall, 0, 0)) *
                                     Transform::rotate(kUp, -90) * Transform::scale(Vec3(6))),
                      make_conductor(RGB(0), RGB(1), RGB(1)));
          in_fog(d);
        },
        {},
        straight};
  t.arrival = [light = t.light](const Vec3& p) {
    return direct(mirror_image(light, Vec3(wall, 0, 0), Vec3(-1, 0, 0)), p);
  };
  return t;
}

// ---- what is compared ---------------------------------------------------------------------------

/// On the floor and in the fog: how much, and where.
constexpr const char* kNames[] = {"floor", "floor x", "floor z", "floor x²", "floor xz", "fog x",
                                  "fog z", "fog y",   "fog y²",  "fog xy",   "fog depth"};
constexpr int kFunctions = static_cast<int>(std::size(kNames));
using Values = std::array<double, kFunctions>;

Values functions(const Vec3& p, double depth, bool in_medium) {
  if (in_medium) return {0, 0, 0, 0, 0, p.x, p.z, p.y, p.y * p.y, p.x * p.y, depth};
  return {1, p.x, p.z, p.x * p.x, p.x * p.z, 0, 0, 0, 0, 0, 0};
}

/// Means over light, by n nodes in each dimension.
Values quadrature(const Toy& toy, int n) {
  const Vec3 forward = normalize(toy.target - toy.camera);
  const Vec3 right = normalize(cross(forward, kUp)), up = cross(right, forward);
  const double half = std::tan(kFov * kPi / 360);
  const QuadratureRule film = gauss_legendre(n, -half, half);
  Values sum{};
  double mass = 0;
  const auto add = [&](const Vec3& p, double t, bool in_medium, double light) {
    mass += light;
    const Values g = functions(p, t, in_medium);
    for (int i = 0; i < kFunctions; ++i) sum[i] += light * g[i];
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const Vec3 w = normalize(forward + film.nodes[i] * right + film.nodes[j] * up);
      const ViewRay ray = toy.view(toy.camera, w);
      const double pixel = film.weights[i] * film.weights[j] * ray.seen;
      const double floor = -ray.o.y / ray.w.y;
      const Vec3 hit = ray.o + floor * ray.w;
      const Toy::Arrival there = toy.arrival(hit);
      add(hit, floor, false,
          pixel * std::exp(-kSigmaT * floor) * kReflectance / kPi * there.across * -there.w.y);
      const QuadratureRule depths = gauss_legendre(n, 0, floor);
      for (int l = 0; l < n; ++l) {
        const double t = depths.nodes[l];
        const Vec3 p = ray.o + t * ray.w;
        add(p, t, true,
            pixel * depths.weights[l] * std::exp(-kSigmaT * t) * kSigmaT * kAlbedo / (4 * kPi) *
                toy.arrival(p).across);
      }
    }
  }
  for (double& v : sum) v /= mass;
  return sum;
}

// ---- chains -------------------------------------------------------------------------------------

bool belongs(const Toy& toy, const MeasuredPath& x) {
  if (x.size() != toy.k) return false;
  for (int i = 0; i < x.size(); ++i)
    if (x[i].degenerate != (i == toy.degenerate)) return false;
  return true;
}

class SwitchToy : public ::testing::TestWithParam<std::tuple<Toy, std::string>> {
 protected:
  /// Starts from the target law.
  static std::vector<PathSample> starts(const Toy& toy, const PathPopulation& population) {
    std::vector<PathSample> chosen, parts;
    for (std::uint64_t sample = 0; chosen.size() < kChains; ++sample) {
      population.draw(sample, 1, parts);
      // One a sample: chains are independent.
      if (!parts.empty() && belongs(toy, parts[0].path())) chosen.push_back(parts[0]);
    }
    return chosen;
  }

  static Values run(const Toy& toy, const PathSample& start, const MutationTable<PathSample>& table,
                    std::uint64_t stream) {
    Values sum{};
    const int free = toy.degenerate == 1 ? 2 : 1;
    const auto splat = [&](const PathSample& x, double weight) {
      const MeasuredPath& path = x.path();
      ASSERT_TRUE(belongs(toy, path));
      const Values g =
          functions(path[free].position(), path.edge(free).length, path[free].in_medium());
      for (int i = 0; i < kFunctions; ++i) sum[i] += weight * g[i] / kSteps;
    };
    Chain<PathSample> chain(start, table);
    Rng rng(suite_seed(), RngDomain::Chain, stream, 0);
    for (int step = 0; step < kSteps; ++step) chain.step(table, rng, splat);
    chain.leave(splat);
    return sum;
  }
};

TEST_P(SwitchToy, SharesTimeAsLightIsShared) {
  const auto& [toy, flip] = GetParam();
  const Values expected = quadrature(toy, 24), coarser = quadrature(toy, 16);
  for (int i = 0; i < kFunctions; ++i) ASSERT_NEAR(expected[i], coarser[i], 1e-7) << kNames[i];

  const Scene scene(describe(toy));
  const PathPopulation population(scene, toy.k - 1, suite_seed(), false);
  // What moves, and what flips; propagation alone finds the fog in front of the pinhole too rarely,
  // for it cannot hold the eye's side where the light's is specular.
  MutationWeights weights = {{"switch", 1}, {"caustic", 1}, {"lens", 1}, {"manifold", 1}};
  if (flip == "propagation") weights["propagation"] = 2;
  const auto table =
      make_path_mutations(weights, population.techniques(), population.max_vertices());
  std::array<std::vector<double>, kFunctions> means;
  std::uint64_t stream = 0;
  for (const PathSample& start : starts(toy, population)) {
    const Values mean = run(toy, start, table, stream++);
    for (int i = 0; i < kFunctions; ++i) means[i].push_back(mean[i]);
  }
  const double level = sidak(kSuiteFalseAlarm, 8 * kFunctions);
  for (int i = 0; i < kFunctions; ++i) {
    const Estimate e = estimate(means[i]);
    std::printf("%-20s %-11s %-9s %.5f expected, %.5f ± %.5f\n", toy.name.c_str(), flip.c_str(),
                kNames[i], expected[i], e.mean, e.standard_error);
    EXPECT_GT(compare(e, expected[i]), level)
        << kNames[i] << ": " << e.mean << " ± " << e.standard_error << ", not " << expected[i];
    // The faults known here are larger by far.
    EXPECT_LT(e.standard_error, 0.01) << kNames[i];
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, SwitchToy,
    ::testing::Combine(::testing::Values(no_specular_surface(), refraction_of_light(),
                                         refraction_of_sight(), plane_mirror()),
                       ::testing::Values("switch", "propagation")),
    [](const auto& info) { return std::get<0>(info.param).name + "_" + std::get<1>(info.param); });

}  // namespace
}  // namespace fogbow::testing
