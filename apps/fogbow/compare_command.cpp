// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/files.h"
#include "apps/fogbow/report.h"
#include "core/image/compare.h"
#include "core/image/image_io.h"

namespace fogbow::cli {

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kTilesShown = 5;

ordered_json rgb_json(const RGB& c) { return {c.x, c.y, c.z}; }

ordered_json tile_json(const TileDifference& tile) {
  return {{"area", {tile.area.x, tile.area.y, tile.area.width, tile.area.height}},
          {"pixels", tile.pixels},
          {"a", tile.image},
          {"b", tile.reference},
          {"standard_error", tile.standard_error},
          {"z", tile.z}};
}

std::string comparison_json(const CompareArguments& arguments, const ComparisonResult& result) {
  ordered_json tiles = ordered_json::array();
  for (const TileDifference& tile : result.tiles) tiles.push_back(tile_json(tile));
  const ordered_json report = {{"version", program_version()},
                               {"a", arguments.a},
                               {"b", arguments.b},
                               {"pixels", result.pixels},
                               {"mse", result.mse},
                               {"rel_mse", result.rel_mse},
                               {"mean_a", rgb_json(result.mean_image)},
                               {"mean_b", rgb_json(result.mean_reference)},
                               {"mean_ratio", rgb_json(result.mean_ratio)},
                               {"luminance_ratio", result.luminance_ratio},
                               {"luminance_ratio_standard_error", result.luminance_ratio_error},
                               {"tile_size", arguments.tile},
                               {"has_errors", result.has_errors},
                               {"tested_tiles", result.tested_tiles},
                               {"chi2", result.chi2},
                               {"fraction_above_2", result.fraction_above_2},
                               {"fraction_above_3", result.fraction_above_3},
                               {"max_abs_z", result.max_abs_z},
                               {"unexplained_tiles", result.unexplained_tiles},
                               {"tiles", tiles}};
  return report.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

void print_tiles(const ComparisonResult& result) {
  if (result.has_errors) {
    std::printf(
        "tile z-scores    %lld tiles, chi2 %.6g, |z| > 2: %.2f%% (normal 4.55%%), > 3: %.2f%% "
        "(normal 0.27%%), largest %.3g\n",
        static_cast<long long>(result.tested_tiles), result.chi2, 100 * result.fraction_above_2,
        100 * result.fraction_above_3, result.max_abs_z);
    if (result.unexplained_tiles > 0)
      std::printf("                 %lld tiles differ where both standard errors are zero\n",
                  static_cast<long long>(result.unexplained_tiles));
  }
  std::printf("worst tiles      x,y,width,height: A, B%s\n", result.has_errors ? ", z" : "");
  for (const std::size_t i : worst_tiles(result, kTilesShown)) {
    const TileDifference& tile = result.tiles[i];
    std::printf("                 %d,%d,%d,%d: %.6g, %.6g", tile.area.x, tile.area.y,
                tile.area.width, tile.area.height, tile.image, tile.reference);
    if (result.has_errors) std::printf(", %.3g", tile.z);
    std::printf("\n");
  }
}

void print_comparison(const ComparisonResult& result) {
  const RGB& ratio = result.mean_ratio;
  std::printf("pixels           %lld\n", static_cast<long long>(result.pixels));
  std::printf("MSE              %.6g\n", result.mse);
  std::printf("relMSE           %.6g\n", result.rel_mse);
  std::printf("mean A / mean B  %.6g, %.6g, %.6g\n", ratio.x, ratio.y, ratio.z);
  std::printf("luminance ratio  %s\n",
              result.luminance_ratio_error > 0
                  ? with_error(result.luminance_ratio, result.luminance_ratio_error).c_str()
                  : format("%.6g", result.luminance_ratio).c_str());
  print_tiles(result);
}

std::optional<Image> read_optional(const std::string& path) {
  if (path.empty()) return std::nullopt;
  return read_image(path);
}

}  // namespace

ExitCode run_compare(const CompareArguments& arguments) {
  if (!arguments.difference.empty()) {
    if (!has_extension(arguments.difference, ".exr"))
      throw Error(ErrorKind::Usage, "--diff: expected a name that ends in .exr, found '" +
                                        arguments.difference + "'");
    require_writable(arguments.difference);
  }
  if (!arguments.json.empty()) require_writable(arguments.json);

  const Image a = read_image(arguments.a), b = read_image(arguments.b);
  const std::optional<Image> error_a = read_optional(arguments.error_a);
  const std::optional<Image> error_b = read_optional(arguments.error_b);
  ComparisonOptions options;
  options.tile_size = arguments.tile;
  for (const auto& [x, y, width, height] : arguments.exclude)
    options.exclude.push_back({x, y, width, height});
  options.image_error = error_a ? &*error_a : nullptr;
  options.reference_error = error_b ? &*error_b : nullptr;
  const ComparisonResult result = compare_images(a, b, options);

  print_comparison(result);
  if (!arguments.difference.empty())
    write_exr(arguments.difference, difference_image(a, b, DifferenceStyle::Signed));
  if (!arguments.json.empty()) write_text_file(arguments.json, comparison_json(arguments, result));
  return ExitCode::Done;
}

}  // namespace fogbow::cli
