// SPDX-License-Identifier: GPL-3.0-or-later
/// invariance_judge MANIFEST: compares pairs of scenes that must give the same picture, by paired
/// replicates with equal seeds. Exit code 1 if a pair differs.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "core/scene_io/load.h"
#include "core/util/log.h"
#include "media/registry.h"
#include "mlt/render.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

using Json = nlohmann::json;

constexpr int kTilesASide = 4;
constexpr double kWantedPower = 0.99;
/// Relative differences of the mean that pixels of single precision can make.
constexpr double kRounding = 1e-6;

struct Window {
  int x = 0, y = 0, width = 0, height = 0;
};

/// Mean luminance, and that of each tile.
std::vector<double> statistics_of(const Image& image, const Window& w, bool tiles) {
  const int side = tiles ? std::min({kTilesASide, w.width, w.height}) : 0;
  std::vector<double> result(1 + side * side);
  std::vector<int> count(result.size());
  const auto add = [&](std::size_t i, double value) {
    result[i] += value;
    ++count[i];
  };
  for (int y = 0; y < w.height; ++y)
    for (int x = 0; x < w.width; ++x) {
      const auto at = [&](int c) { return image.at(w.x + x, w.y + y, c); };
      const double value = luminance(RGB(at(0), at(1), at(2)));
      add(0, value);
      if (side > 0) add(1 + (y * side / w.height) * side + x * side / w.width, value);
    }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] /= count[i];
  return result;
}

/// One side of a comparison: {"scene", "integrator", "spp", "overrides"}, and where needed "size",
/// "crop".
class Renderer {
 public:
  explicit Renderer(const Json& side) {
    LoadOptions load;
    if (side.contains("crop")) load.crop = side["crop"].get<std::array<int, 4>>();
    if (side.contains("size")) load.size = side["size"].get<std::pair<int, int>>();
    std::vector<std::string> warnings;
    scene_ = std::make_unique<Scene>(
        load_mitsuba_xml(side.at("scene"), builtin_media(), load, warnings));
    options_.integrator = side.at("integrator");
    for (const auto& [key, value] : side.at("overrides").items())
      options_.overrides.emplace_back(key, value.get<std::string>());
    options_.samples_per_pixel = side.at("spp").get<double>();
    options_.threads = 1;
  }

  const Image& operator()(int replicate) {
    if (images_.size() <= static_cast<std::size_t>(replicate)) {
      options_.seed = testing::suite_seed() + replicate;
      RenderResult result = render(*scene_, options_);
      refused_ += result.non_finite;
      images_.push_back(std::move(result.image));
    }
    return images_[replicate];
  }
  std::uint64_t refused() const { return refused_; }

 private:
  std::unique_ptr<Scene> scene_;
  RenderOptions options_;
  std::vector<Image> images_;  ///< one a replicate, for the pairs that share this side
  std::uint64_t refused_ = 0;
};

struct Verdict {
  bool pass = true;
  double mean = 0, difference = 0, p = 1, mean_power = 0;
  double tile_power = 0;  ///< the part of the tiles whose bias would be found
};

class Judge {
 public:
  explicit Judge(const Json& manifest)
      : manifest_(manifest),
        level_(testing::sidak(
            testing::kSuiteFalseAlarm,
            static_cast<int>(manifest.at("pairs").size()) * (1 + kTilesASide * kTilesASide))) {}

  int run() {
    int failures = 0;
    for (const Json& pair : manifest_.at("pairs")) {
      const Verdict v = judge(pair);
      const bool weak = !(v.mean_power >= kWantedPower);
      std::printf("%s%s %s: mean %.6g, relative difference %+.2e, p %.2g, power %.3f, tiles %.2f\n",
                  v.pass ? "ok" : "DIFFERENT", weak ? " BUT WEAK" : "",
                  pair.at("name").get<std::string>().c_str(), v.mean, v.difference / v.mean, v.p,
                  v.mean_power, v.tile_power);
      std::fflush(stdout);
      failures += !v.pass || weak;
    }
    std::printf(
        "%zu pairs, level %.2g; power: to find a bias of %g of the mean; tiles: the part in which "
        "one of %g would be found with probability %g\n",
        manifest_["pairs"].size(), level_, manifest_["mean_bias"].get<double>(),
        manifest_["tile_bias"].get<double>(), kWantedPower);
    return failures > 0 ? 1 : 0;
  }

 private:
  Renderer& renderer(const Json& side) {
    auto& r = renderers_[side.dump()];
    if (!r) r = std::make_unique<Renderer>(side);
    return *r;
  }

  Verdict judge(const Json& pair) {
    Renderer &a = renderer(pair.at("a")), &b = renderer(pair.at("b"));
    std::vector<std::vector<double>> means, differences;
    const int replicates = pair.at("replicates");
    for (int r = 0; r < replicates; ++r) {
      const Image& image_a = a(r);
      const Image& image_b = b(r);
      const Window whole_a{0, 0, image_a.width, image_a.height};
      const Window whole_b{0, 0, image_b.width, image_b.height};
      Window w = whole_a;
      if (pair.contains("window")) {
        const auto box = pair["window"].get<std::array<int, 4>>();
        w = {box[0], box[1], box[2], box[3]};
      }
      const bool tiles = w.width == whole_b.width && w.height == whole_b.height;
      const std::vector<double> x = statistics_of(image_a, w, tiles);
      const std::vector<double> y = statistics_of(image_b, whole_b, tiles);
      means.resize(x.size());
      differences.resize(x.size());
      for (std::size_t i = 0; i < x.size(); ++i) {
        means[i].push_back(x[i]);
        differences[i].push_back(y[i] - x[i]);
      }
    }
    Verdict v;
    v.pass = a.refused() == 0 && b.refused() == 0;
    for (std::size_t i = 0; i < means.size(); ++i) weigh(means[i], differences[i], i, v);
    if (means.size() > 1) v.tile_power /= static_cast<double>(means.size() - 1);
    return v;
  }

  void weigh(const std::vector<double>& means, const std::vector<double>& differences,
             std::size_t i, Verdict& v) const {
    const double mean = testing::estimate(means).mean;
    testing::Estimate d = testing::estimate(differences);
    if (i == 0) {
      v.mean = mean;
      v.difference = d.mean;
    }
    d.mean = std::copysign(std::fmax(std::fabs(d.mean) - kRounding * v.mean, 0), d.mean);
    const double p = testing::compare(d, 0);
    v.p = std::fmin(v.p, p);
    if (!(p >= level_)) v.pass = false;
    const char* key = i == 0 ? "mean_bias" : "tile_bias";
    const double power = testing::power(d, {}, manifest_.at(key).get<double>() * mean, level_);
    if (i == 0)
      v.mean_power = power;
    else if (power >= kWantedPower)
      ++v.tile_power;
  }

  const Json& manifest_;
  double level_;
  std::map<std::string, std::unique_ptr<Renderer>> renderers_;
};

}  // namespace
}  // namespace fogbow

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: invariance_judge MANIFEST.json\n";
    return 2;
  }
  try {
    fogbow::set_log_level(fogbow::LogLevel::Error);
    std::ifstream file(argv[1]);
    const nlohmann::json manifest = nlohmann::json::parse(file);
    return fogbow::Judge(manifest).run();
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 3;
  }
}
