// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/statistical/peers_rendering.h"

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

/// As renders by chains name it.
std::string configuration_text(const Path& path) {
  PathClass c{static_cast<int>(path.size()), 0};
  for (std::size_t i = 0; i < path.size() && i < 32; ++i)
    c.c |= std::uint32_t{path[i].in_medium()} << i;
  return fogbow::configuration_text(c);
}

Tiles empty_tiles(const Scene& scene, int replicates) {
  const auto [width, height] = rendered_size(scene.film());
  FOGBOW_CHECK(width % kTile == 0 && height % kTile == 0);
  const auto count = static_cast<std::size_t>(width / kTile) * (height / kTile);
  return {width / kTile,
          std::vector(replicates, std::vector<double>(count)),
          std::vector<double>(count),
          {}};
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
                      int replicates, int rounds, std::uint64_t seed) {
  const auto [width, height] = rendered_size(scene.film());
  const Vec2 pixel(1.0 / width, 1.0 / height);
  Pictures result{empty_tiles(scene, replicates), empty_tiles(scene, replicates)};
  std::vector<std::vector<double>> excess(replicates, std::vector<double>(result.all.count()));
  std::vector<std::map<std::string, double>> classes(replicates);
  const PictureGrid grid{width / kTile, height / kTile};
  parallel_for(replicates, [&, width = width, height = height](std::int64_t r) {
    Workspace w;
    for (int i = 0; i < rounds * width * height; ++i) {
      const int x = i % width, y = i / width % height;
      Rng rng(seed, RngDomain::Test, static_cast<std::uint64_t>(r), static_cast<std::uint64_t>(i));
      PixelStream eye(rng, Vec2(x, y) * pixel, pixel);
      RandomStream light(rng);
      estimator.sample(light, eye, w);
      for (const Contribution& c : w.contributions) {
        const std::size_t tile = grid.cell(c.raster);
        const double value = luminance(c.value);
        result.all.replicates[r][tile] += value;
        if (!classified) continue;
        const Path path = assemble(scene, w.light, c.s, w.eye, c.t);
        excess[r][tile] += value * shadow_ray_excess(path);
        classes[r][configuration_text(path)] += value;
        if (reach(scene, path).light) result.by_light.replicates[r][tile] += value;
      }
    }
    FOGBOW_CHECK(w.refused == 0);
  });
  // The mean over all samples of what lands on a tile, times the number of tiles, is its mean.
  const double samples = static_cast<double>(rounds) * width * height;
  const double scale = static_cast<double>(grid.size()) / samples;
  for (int r = 0; r < replicates; ++r) {
    for (std::size_t i = 0; i < grid.size(); ++i) {
      result.all.replicates[r][i] *= scale;
      result.by_light.replicates[r][i] *= scale;
      result.all.excess[i] += excess[r][i] * scale / replicates;
    }
    for (const auto& [configuration, value] : classes[r])
      result.all.add_class(configuration, r, value / samples);
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
