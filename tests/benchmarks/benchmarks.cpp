// SPDX-License-Identifier: GPL-3.0-or-later
// Usage: fogbow_benchmarks SCENE.xml... [Google Benchmark's flags]; every scene by rays alone, by
// each estimator and by chains, whose mutations are split into the time inside Embree and the rest.
#include <benchmark/benchmark.h>

#include <filesystem>

#include "core/estimators/sampling.h"
#include "core/image/image_io.h"
#include "core/math/random.h"
#include "core/math/warp.h"
#include "core/scene_io/load.h"
#include "core/util/log.h"
#include "media/registry.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "tests/benchmarks/embree_clock.h"
#include "tests/benchmarks/path_chain.h"

namespace fogbow {
namespace {

using benchmark::Counter;

constexpr std::uint64_t kSeed = PathChain::kSeed;

Counter rate(double count) { return Counter(count, Counter::kIsRate); }

/// Rays from the camera, and cosine-distributed ones from where those arrive.
struct RaySet {
  std::vector<Ray> primary, bounce;
  std::vector<PrimitiveId> bounce_from;

  explicit RaySet(const Scene& scene) {
    Rng rng(kSeed, RngDomain::Test, 0, 0);
    for (int i = 0; i < 1 << 16; ++i) {
      const Vec3 o = scene.sensor().sample_position(uniform2(rng));
      const Ray ray{o, scene.sensor().sample_direction(o, uniform2(rng)).w};
      primary.push_back(ray);
      const auto hit = scene.accel().intersect(ray);
      if (!hit) continue;
      const SurfacePoint x = scene.surface_point(*hit);
      const Frame frame(dot(x.n_g, ray.d) < 0 ? x.n_g : -x.n_g);
      bounce.push_back({x.position, frame.to_world(warp::sample_cosine_hemisphere(uniform2(rng)))});
      bounce_from.push_back(hit->id);
    }
  }
};

void trace(benchmark::State& state, const Scene& scene, bool bounce) {
  const RaySet set(scene);
  const auto& rays = bounce ? set.bounce : set.primary;
  std::size_t i = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        scene.accel().intersect(rays[i], bounce ? set.bounce_from[i] : kNoPrimitive));
    if (++i == rays.size()) i = 0;
  }
  state.counters["rays/s"] = rate(static_cast<double>(state.iterations()));
}

void estimate(benchmark::State& state, const Estimator& estimator) {
  Workspace w;
  std::uint64_t i = 0;
  const std::uint64_t before = rays_traced();
  for (auto _ : state) {
    Rng rng(kSeed, RngDomain::Sampling, i++, 0);
    RandomStream stream(rng);
    estimator.sample(stream, stream, w);
    benchmark::DoNotOptimize(w.contributions.data());
  }
  const auto rays = static_cast<double>(rays_traced() - before);
  state.counters["samples/s"] = rate(static_cast<double>(state.iterations()));
  state.counters["rays/s"] = rate(rays);
  state.counters["rays/sample"] = rays / static_cast<double>(state.iterations());
}

template <class State>
void mutate(benchmark::State& state, const MutationTable<State>& table, Chain<State>& chain) {
  const std::uint64_t before = rays_traced();
  for (auto _ : state) {
    Rng rng(kSeed, RngDomain::Chain, 0, chain.steps());
    chain.step(table, rng, [](const State& x, double weight) {
      benchmark::DoNotOptimize(x.contributions().data());
      benchmark::DoNotOptimize(weight);
    });
  }
  const auto rays = static_cast<double>(rays_traced() - before);
  state.counters["mutations/s"] = rate(static_cast<double>(state.iterations()));
  state.counters["rays/s"] = rate(rays);
  state.counters["rays/mutation"] = rays / static_cast<double>(state.iterations());
}

/// Of one mutation: so many, if they come within this time.
constexpr int kProposals = 4000;
constexpr double kMostSeconds = 10;

void mutate_samples(benchmark::State& state, const Estimator& estimator) {
  const auto table = make_primary_sample_mutations(estimator, 0.3);
  Chain<PrimarySample> chain(Bootstrap(estimator, kSeed, 2048).start(0, 0.5), table);
  mutate(state, table, chain);
}

void mutate_paths(benchmark::State& state, const Scene& scene, const Estimator& bdpt) {
  PathChain c(scene, bdpt);
  mutate(state, c.table, c.chain);
}

/// Of the steps of a chain of all mutations, those by one: as they come in a render.
void mutate_by(benchmark::State& state, const Scene& scene, const Estimator& bdpt,
               const std::string& mutation) {
  PathChain c(scene, bdpt);
  double all = 0;
  EmbreeClock embree;
  const auto deadline = precise_seconds() + kMostSeconds;
  for (auto _ : state) {
    for (bool done = false; !done;) {
      Rng rng(kSeed, RngDomain::Chain, 0, c.chain.steps());
      const EmbreeClock before = EmbreeClock::now();
      const double start = precise_seconds();
      const StepInfo step = c.chain.step(c.table, rng, [](const PathSample& x, double weight) {
        benchmark::DoNotOptimize(x.contributions().data());
        benchmark::DoNotOptimize(weight);
      });
      const double seconds = precise_seconds() - start;
      if (start > deadline) return state.SkipWithError("hardly ever chosen here");
      if (c.table[step.mutation]->name() != mutation) continue;
      done = true;
      const EmbreeClock spent = EmbreeClock::now() - before;
      embree.seconds += spent.seconds;
      embree.rays += spent.rays;
      all += seconds;
      state.SetIterationTime(seconds);
    }
  }
  const auto n = static_cast<double>(state.iterations());
  state.counters["rays"] = static_cast<double>(embree.rays) / n;
  state.counters["us in Embree"] = 1e6 * embree.seconds / n;
  state.counters["us rest"] = 1e6 * (all - embree.seconds) / n;
}

/// A scene with its estimators; all live until the program ends, as registered benchmarks refer to
/// them.
struct Subject {
  Scene scene;
  std::unique_ptr<Estimator> path, light, bdpt;
  std::unique_ptr<Estimator> chained;  ///< what chains are made of

  explicit Subject(SceneDescription description)
      : scene(std::move(description)),
        path(make_path_tracer(scene, {})),
        light(make_light_tracer(scene, {})),
        bdpt(make_bdpt(scene, {})),
        chained(make_bdpt(scene, {.seen_light = false})) {}

  void register_all(const std::string& name) {
    const auto add = [&](const char* what, auto&& run) {
      return benchmark::RegisterBenchmark((name + "/" + what).c_str(), run)
          ->Unit(benchmark::kMicrosecond);
    };
    add("primary rays", [this](benchmark::State& s) { trace(s, scene, false); });
    add("bounce rays", [this](benchmark::State& s) { trace(s, scene, true); });
    add("path", [this](benchmark::State& s) { estimate(s, *path); });
    add("light", [this](benchmark::State& s) { estimate(s, *light); });
    add("bdpt", [this](benchmark::State& s) { estimate(s, *bdpt); });
    add("pssmlt", [this](benchmark::State& s) { mutate_samples(s, *chained); });
    add("mlt", [this](benchmark::State& s) { mutate_paths(s, scene, *chained); });
    for (const auto& [mutation, weight] : default_mutation_weights())
      add(("mlt by " + mutation).c_str(),
          [this, mutation = mutation](benchmark::State& s) {
            mutate_by(s, scene, *chained, mutation);
          })
          ->UseManualTime()
          ->Iterations(kProposals);
  }
};

std::string scene_name(const std::filesystem::path& file) {
  return file.stem() == "scene" ? file.parent_path().filename().string() : file.stem().string();
}

}  // namespace
}  // namespace fogbow

int main(int argc, char** argv) {
  using namespace fogbow;
  benchmark::Initialize(&argc, argv);
  set_log_level(LogLevel::Error);
  std::vector<std::unique_ptr<Subject>> subjects;
  try {
    for (int i = 1; i < argc; ++i) {
      std::vector<std::string> warnings;
      LoadOptions options;
      options.read_image = read_image;
      subjects.push_back(
          std::make_unique<Subject>(load_mitsuba_xml(argv[i], builtin_media(), options, warnings)));
      subjects.back()->register_all(scene_name(argv[i]));
    }
  } catch (const Error& e) {
    log(LogLevel::Error, e.what());
    return static_cast<int>(e.kind());
  }
  benchmark::RunSpecifiedBenchmarks();
}
