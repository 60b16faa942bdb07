// SPDX-License-Identifier: GPL-3.0-or-later
// fogbow_autocorrelation SCENE MUTATION [CHAINS [STEPS]]: how long chains of all mutations take to
// forget whether the caustic lies on a surface or in the fog, with MUTATION and without it. The
// indicator is of the first vertex beyond the specular ones at the light; its integrated
// autocorrelation time comes from the spread of independent chains' means, in steps and in CPU
// time.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "core/estimators/sampling.h"
#include "core/image/image_io.h"
#include "core/scene_io/load.h"
#include "media/registry.h"
#include "mlt/bootstrap.h"
#include "mlt/chain.h"
#include "mlt/path_sample.h"
#include "mlt/pilot.h"
#include "mlt/registry.h"
#include "mlt/technique_distribution.h"

namespace fogbow {
namespace {

constexpr int kMaxDepth = 64, kVertices = kMaxDepth + 1, kRounds = 4;
constexpr std::uint64_t kSeed = 1;

bool caustic_in_medium(const MeasuredPath& path) {
  int first = 1;
  while (path[first].degenerate) ++first;
  return first > 1 && path[first].in_medium();
}

/// Of one mixture, over all chains so far.
struct Mixture {
  std::string title;
  MutationTable<PathSample> table;
  std::vector<double> means{};  ///< of each chain
  double seconds = 0;

  void run(const Bootstrap& bootstrap, const Scene& scene, int chains, int steps) {
    const std::clock_t begun = std::clock();
    for (int c = 0; c < chains; ++c) {
      const std::uint64_t stream = means.size();
      Rng choice(kSeed, RngDomain::WarmUp, stream, 2);
      const double start = choice.uniform();
      auto x = PathSample::choose(scene, kVertices,
                                  bootstrap.start(static_cast<int>(stream % Film::kGroups), start),
                                  choice.uniform());
      Chain<PathSample> chain(x.value(), table);
      double sum = 0;
      for (int i = 0; i < steps; ++i) {
        Rng rng(kSeed, RngDomain::Chain, stream, i);
        chain.step(table, rng, [](const PathSample&, double) {});
        sum += caustic_in_medium(chain.state().path());
      }
      means.push_back(sum / steps);
    }
    seconds += static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
  }

  /// In µs of CPU time; prints.
  double report(int steps) const {
    const auto n = static_cast<double>(means.size());
    double mean = 0, variance = 0;
    for (const double m : means) mean += m / n;
    for (const double m : means) variance += sqr(m - mean) / (n - 1);
    const double iact = variance * steps / (mean * (1 - mean));
    const double step = 1e6 * seconds / n / steps;
    std::printf("%-24s in fog %.4f, %7.1f ± %.1f steps of %.3f µs: %.1f µs\n", title.c_str(), mean,
                iact, iact * std::sqrt(2 / (n - 1)), step, iact * step);
    return iact * step;
  }
};

int run(const std::string& file, const std::string& mutation, int chains, int steps) {
  std::vector<std::string> warnings;
  LoadOptions options;
  options.read_image = read_image;
  const Scene scene(load_mitsuba_xml(file, builtin_media(), options, warnings));
  const auto bdpt = make_bdpt(scene, {.max_depth = kMaxDepth, .seen_light = false});
  const auto [width, height] = rendered_size(scene.film());
  const Pilot pilot = run_pilot(*bdpt, static_cast<double>(width) / height, kSeed, 1 << 15);
  const TechniqueDistribution techniques(pilot.techniques, kVertices);
  const Bootstrap bootstrap(*bdpt, kSeed, 1 << 14, pilot.importance);
  MutationWeights weights = default_mutation_weights();
  Mixture with{"all", make_path_mutations(weights, techniques, kVertices)};
  if (weights.erase(mutation) == 0) throw Error(ErrorKind::Usage, "no mutation " + mutation);
  Mixture without{"without " + mutation, make_path_mutations(weights, techniques, kVertices)};
  // By turns, so that a machine whose speed drifts slows both alike.
  for (int round = 0; round < kRounds; ++round)
    for (Mixture* mixture : {&with, &without})
      mixture->run(bootstrap, scene, chains / kRounds, steps);
  const double a = with.report(steps), b = without.report(steps);
  std::printf("%s: %.2f times shorter at equal CPU time\n", mutation.c_str(), b / a);
  return 0;
}

}  // namespace
}  // namespace fogbow

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: %s SCENE MUTATION [CHAINS [STEPS]]\n", argv[0]);
    return 2;
  }
  try {
    return fogbow::run(argv[1], argv[2], argc > 3 ? std::atoi(argv[3]) : 1024,
                       argc > 4 ? std::atoi(argv[4]) : 4000);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 1;
  }
}
