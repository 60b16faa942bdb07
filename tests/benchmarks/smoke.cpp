// SPDX-License-Identifier: GPL-3.0-or-later
// fogbow_smoke [VOXELS [STEPS]]: time per mutation on scenes/smoke with its plume refined to
// VOXELS³ (256), against the same scene with a homogeneous medium of the same mean density. Both
// take turns of STEPS mutations, so that what else the machine does slows both; from the root of
// the repository.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>

#include "core/scene_io/files.h"
#include "core/scene_io/load.h"
#include "core/scene_io/volume_grid.h"
#include "media/media.h"
#include "media/registry.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "mlt/primary_sample.h"
#include "tests/benchmarks/path_chain.h"

namespace fogbow {
namespace {

constexpr int kTurns = 15;
const char* const kScene = "scenes/smoke/scene.xml";

/// The plume between its voxels, with detail as fine as the new ones.
VoxelData refined(int n) {
  const char* file = "scenes/smoke/meshes/smoke.vol";
  const Volume coarse(parse_vol(read_file(file, 1 << 24, {}), file).voxels, {});
  VoxelData data{{n, n, n}, 1, {}};
  std::uint64_t hash = 1;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        hash = hash * 6364136223846793005u + 1442695040888963407u;
        const double detail = 0.7 + 0.6 * static_cast<double>(hash >> 40) / (1 << 24);
        const Vec3 p = (Vec3(x, y, z) + 0.5) / double(n);
        data.values.push_back(static_cast<float>(detail * coarse.value(p).x));
      }
  return data;
}

std::shared_ptr<const Medium> plume(const VoxelData& data) {
  HeterogeneousSettings s;
  s.sigma_t =
      std::make_shared<Volume>(data, VolumeSettings{Transform::translate(Vec3(-0.7, -0.95, -0.7)) *
                                                    Transform::scale(Vec3(1.4, 1.8, 1.4))});
  s.scale = 12;
  s.albedo = std::make_shared<Volume>(RGB(0.92, 0.9, 0.87));
  return make_heterogeneous_medium(s, make_henyey_greenstein(0.4));
}

std::shared_ptr<const Medium> fog(const VoxelData& data) {
  double sum = 0;
  for (const float v : data.values) sum += v;
  return make_homogeneous_medium(RGB(12 * sum / static_cast<double>(data.values.size())),
                                 RGB(0.92, 0.9, 0.87), make_henyey_greenstein(0.4));
}

/// The scene with another medium in its box, and chains on it.
struct Subject {
  Scene scene;
  std::unique_ptr<Estimator> bdpt;
  PathChain paths;
  MutationTable<PrimarySample> table;
  Chain<PrimarySample> samples;

  static SceneDescription with(std::shared_ptr<const Medium> medium) {
    std::vector<std::string> warnings;
    SceneDescription d = load_mitsuba_xml(kScene, builtin_media(), {}, warnings);
    for (Surface& s : d.surfaces)
      if (s.interior) s.interior = medium;
    return d;
  }
  explicit Subject(std::shared_ptr<const Medium> medium)
      : scene(with(std::move(medium))),
        bdpt(make_bdpt(scene, {.seen_light = false})),
        paths(scene, *bdpt),
        table(make_primary_sample_mutations(*bdpt, 0.3)),
        samples(Bootstrap(*bdpt, PathChain::kSeed, 2048).start(0, 0.5), table) {}
};

/// CPU time a step, in µs.
template <class State>
double turn(Chain<State>& chain, const MutationTable<State>& table, int steps) {
  const std::clock_t start = std::clock();
  for (int i = 0; i < steps; ++i) {
    Rng rng(PathChain::kSeed, RngDomain::Chain, 0, chain.steps());
    chain.step(table, rng, [](const State&, double) {});
  }
  return 1e6 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC / steps;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

template <class Turn>
void compare(const char* name, Subject& smoke, Subject& fog, Turn&& turn) {
  std::vector<double> in_smoke, in_fog, ratio;
  for (int i = 0; i < kTurns; ++i) {
    in_smoke.push_back(turn(smoke));
    in_fog.push_back(turn(fog));
    ratio.push_back(in_smoke.back() / in_fog.back());
  }
  std::printf("%-8s %6.2f us in smoke, %6.2f us in fog, ratio %.2f (%.2f to %.2f)\n", name,
              median(in_smoke), median(in_fog), median(ratio), *std::ranges::min_element(ratio),
              *std::ranges::max_element(ratio));
}

}  // namespace
}  // namespace fogbow

int main(int argc, char** argv) {
  using namespace fogbow;
  const int voxels = argc > 1 ? std::atoi(argv[1]) : 256;
  const int steps = argc > 2 ? std::atoi(argv[2]) : 20000;
  if (voxels < 1 || voxels > 1024 || steps < 1) {
    std::fprintf(stderr, "usage: fogbow_smoke [VOXELS [STEPS]]\n");
    return static_cast<int>(ErrorKind::Usage);
  }
  const VoxelData data = refined(voxels);
  Subject smoke(plume(data)), homogeneous(fog(data));
  compare("mlt", smoke, homogeneous,
          [&](Subject& s) { return turn(s.paths.chain, s.paths.table, steps); });
  compare("pssmlt", smoke, homogeneous,
          [&](Subject& s) { return turn(s.samples, s.table, steps); });
}
