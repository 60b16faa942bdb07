// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/statistical/peers_rendering.h"

#include <numeric>

#include "core/estimators/sampling.h"
#include "core/image/image_io.h"
#include "core/path/path.h"
#include "core/util/parallel.h"
#include "mlt/class_tally.h"
#include "mlt/picture_importance.h"
#include "mlt/render.h"
#include "tests/statistical/agreement_sampling.h"

namespace fogbow::testing {

namespace {

/// Part by which the fault brightens a path that next-event estimation can make.
double shadow_ray_excess(const Path& path) {
  const Vertex &x1 = path[0], &x2 = path[1];
  if (path.size() < 3 || x1.infinite() || x1.degenerate || x2.degenerate || !x1.medium) return 0;
  const double skipped = kMitsubaShadowEpsilon * length(x2.position() - x1.position());
  return std::expm1(skipped * max_component(x1.medium->sigma_t(x1.position())));
}

/// As renders by chains name it; long paths, of which there are too many kinds to keep each, are
/// among the others.
std::string configuration_text(const Path& path) {
  constexpr std::size_t kLongest = 12;
  if (path.size() > kLongest) return kOtherClasses;
  PathClass c{static_cast<int>(path.size()), 0};
  for (std::size_t i = 0; i < path.size() && i < 32; ++i)
    c.c |= std::uint32_t{path[i].in_medium()} << i;
  return fogbow::configuration_text(c);
}

Tiles empty_tiles(const Scene& scene, int replicates) {
  const auto [width, height] = rendered_size(scene.film());
  FOGBOW_CHECK(width % kTile == 0 && height % kTile == 0);
  const auto count = static_cast<std::size_t>(width / kTile) * (height / kTile);
  return {width / kTile, std::vector(replicates, std::vector<double>(count)),
          std::vector<double>(count)};
}

}  // namespace

Estimate Tiles::estimate(const std::vector<std::size_t>& tiles) const {
  std::vector<double> values;
  for (const auto& replicate : replicates) {
    double sum = 0;
    for (const std::size_t i : tiles) sum += replicate[i];
    values.push_back(sum / static_cast<double>(tiles.size()));
  }
  return testing::estimate(values);
}

void Tiles::add_class(const std::string& configuration, int replicate, double value) {
  auto& values = classes[configuration];
  values.resize(replicates.size());
  values[replicate] += value;
}

double Tiles::mean_excess(const std::vector<std::size_t>& tiles) const {
  double sum = 0;
  for (const std::size_t i : tiles) sum += excess[i];
  return sum / static_cast<double>(tiles.size());
}

Pictures render_tiles(const Scene& scene, const Estimator& estimator, bool classified,
                      int replicates, const SamplesPerPixel& samples, std::uint64_t seed) {
  const auto [width, height] = rendered_size(scene.film());
  const Vec2 pixel(1.0 / width, 1.0 / height);
  Pictures result{empty_tiles(scene, replicates), empty_tiles(scene, replicates)};
  for (Tiles* tiles : {&result.all, &result.by_light}) tiles->splats = tiles->replicates;
  const std::size_t blocks = result.all.block_count();
  using Sources = std::vector<double>;  // by block; last: light tracing
  std::vector<std::vector<double>> excess(replicates, std::vector<double>(result.all.count()));
  std::vector<std::map<std::string, Sources>> classes(replicates);
  const PictureGrid grid{width / kTile, height / kTile};

  double total = 0;
  for (std::size_t tile = 0; tile < grid.size(); ++tile)
    total += kTile * kTile * samples(result.all.block(tile));
  // What a sample of the picture adds to a tile's mean, and to the picture's: a pixel's own are
  // their mean, light tracing's land everywhere from all of them.
  const auto scale = [&, pixels = kTile * kTile](const Contribution& c, int here) {
    return c.t == 1 ? static_cast<double>(grid.size()) / total : 1.0 / (pixels * here);
  };
  parallel_for(replicates, [&, width = width](std::int64_t r) {
    Workspace w;
    std::uint64_t stream = 0;
    const auto sample = [&](int x, int y, std::size_t block) {
      Rng rng(seed, RngDomain::Test, static_cast<std::uint64_t>(r), stream++);
      PixelStream eye(rng, Vec2(x, y) * pixel, pixel);
      RandomStream light(rng);
      estimator.sample(light, eye, w);
      for (const Contribution& c : w.contributions) {
        const std::size_t tile = grid.cell(c.raster);
        const double value = luminance(c.value) * scale(c, samples(block));
        const auto add = [&](Tiles& tiles) {
          tiles.replicates[r][tile] += value;
          if (c.t == 1) tiles.splats[r][tile] += value;
        };
        add(result.all);
        if (!classified) continue;
        const Path path = assemble(scene, w.light, c.s, w.eye, c.t);
        excess[r][tile] += value * shadow_ray_excess(path);
        Sources& sources = classes[r][configuration_text(path)];
        sources.resize(blocks + 1);
        sources[c.t == 1 ? blocks : block] += value / static_cast<double>(grid.size());
        if (reach(scene, path).light) add(result.by_light);
      }
    };
    for (std::size_t tile = 0; tile < grid.size(); ++tile)
      for (int i = 0; i < kTile * kTile; ++i)
        for (int round = 0; round < samples(result.all.block(tile)); ++round)
          sample(static_cast<int>(tile) % grid.across * kTile + i % kTile,
                 static_cast<int>(tile) / grid.across * kTile + i / kTile, result.all.block(tile));
    FOGBOW_CHECK(w.refused == 0);
  });
  for (int r = 0; r < replicates; ++r) {
    for (std::size_t i = 0; i < grid.size(); ++i) result.all.excess[i] += excess[r][i] / replicates;
    for (const auto& [configuration, sources] : classes[r]) {
      auto& all = result.all.class_sources[configuration];
      all.resize(replicates, Sources(blocks + 1));
      all[r] = sources;
      result.all.add_class(configuration, r, std::accumulate(sources.begin(), sources.end(), 0.0));
    }
  }
  return result;
}

Tiles render_tiles_by_chains(const Scene& scene, const ChainOptions& settings, int replicates,
                             double mutations_per_pixel, std::uint64_t seed) {
  Tiles tiles = empty_tiles(scene, replicates);
  RenderOptions options;
  options.integrator = settings.integrator;
  options.overrides = {{"max_depth", std::to_string(settings.max_depth)}};
  if (!settings.mutations.empty()) options.overrides.emplace_back("mutations", settings.mutations);
  options.samples_per_pixel = mutations_per_pixel;
  for (int r = 0; r < replicates; ++r) {
    options.seed = seed + static_cast<std::uint64_t>(r) * 0x9E3779B97F4A7C15;
    const RenderResult result = render(scene, options);
    const Image& image = result.image;
    for (const ClassShare& c : result.classes) tiles.add_class(c.configuration, r, c.value);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        tiles.replicates[r][y / kTile * tiles.across + x / kTile] +=
            luminance(RGB(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2))) /
            (kTile * kTile);
  }
  return tiles;
}

Estimate Reference::estimate(const std::vector<std::size_t>& tiles, const Tiles& like) const {
  // Each pixel's variance comes from tens of renders: together they are known well.
  constexpr double kDegreesOfFreedom = 1e4;
  double sum = 0, variance = 0;
  for (const std::size_t i : tiles) {
    const int x0 = static_cast<int>(i) % like.across * kTile,
              y0 = static_cast<int>(i) / like.across * kTile;
    for (int y = y0; y < y0 + kTile; ++y)
      for (int x = x0; x < x0 + kTile; ++x) {
        const auto at = [&](const Image& image) {
          return luminance(RGB(image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)));
        };
        sum += at(mean);
        // Channels of one path go together: their errors add up.
        variance += sqr(at(error));
      }
  }
  const double pixels = static_cast<double>(tiles.size()) * kTile * kTile;
  return {sum / pixels, std::sqrt(variance) / pixels, kDegreesOfFreedom};
}

Reference read_reference(const std::string& name, const Scene& scene) {
  const FilmSettings& film = scene.film();
  const auto [width, height] = rendered_size(film);
  const auto crop = [&, width = width, height = height](const std::string& file) {
    const Image whole = read_image("scenes/" + name + "/" + file);
    const int rgb[] = {whole.channel("R"), whole.channel("G"), whole.channel("B")};
    Image part(width, height, {"R", "G", "B"});
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c)
          part.at(x, y, c) = whole.at(x + film.crop_x, y + film.crop_y, rgb[c]);
    return part;
  };
  return {crop("reference.exr"), crop("stderr.exr")};
}

}  // namespace fogbow::testing
