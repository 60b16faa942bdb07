// SPDX-License-Identifier: GPL-3.0-or-later
// Detailed balance, by numbers: of paths from the target law and one step of the chain,
// E g(x₀) h(x₁) = E h(x₀) g(x₁), for every mutation alone and for the mixture. Stronger than
// invariance, which it contains as h = 1.
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/util/parallel.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

const int kSamples = std::getenv("FOGBOW_LONG") ? 1 << 20 : 1 << 17;
constexpr int kMaxDepth = 7, kBlock = 256;
/// Products of two features that are compared besides every feature alone.
constexpr int kProducts = 160;
/// Steps accepted, on average, that must have told the two directions of a pair apart for its mean
/// to be normal. Not steps proposed: the flux one way may come in hundreds of steps of little
/// probability, and the other way, once in a while, in one that is always accepted.
constexpr double kLeastAccepted = 50;

/// g and h as indices of features; −1 for the constant one.
struct Pair {
  int g, h;
};

/// Every feature with one; then, by lot, indicators of classes with anything and anything with
/// anything.
std::vector<Pair> make_pairs(const std::vector<Feature>& features) {
  std::vector<Pair> pairs;
  std::vector<int> indicators, all;
  for (int i = 0; i < static_cast<int>(features.size()); ++i) {
    pairs.push_back({i, -1});
    const std::string& name = features[i].name;
    const bool of_class = name.starts_with("class") || name.starts_with("k =");
    // Longer classes are too rare for products.
    if (of_class && name.find("class 6") == std::string::npos) indicators.push_back(i);
    if (!of_class) all.push_back(i);
  }
  Rng rng(suite_seed(), RngDomain::Test, 0, 1 << 20);
  const auto any = [&](const std::vector<int>& from) {
    return from[static_cast<std::size_t>(rng.uniform() * static_cast<double>(from.size()))];
  };
  for (int i = 0; i < kProducts; ++i) pairs.push_back({any(i % 2 ? indicators : all), any(all)});
  return pairs;
}

struct Sums {
  std::vector<double> difference, squares, accepted;
  explicit Sums(std::size_t n) : difference(n), squares(n), accepted(n) {}
  void add(const Sums& s) {
    for (std::size_t i = 0; i < difference.size(); ++i) {
      difference[i] += s.difference[i];
      squares[i] += s.squares[i];
      accepted[i] += s.accepted[i];
    }
  }
};

class TwoPoint : public ::testing::TestWithParam<TestScene> {
 protected:
  TwoPoint()
      : scene_(GetParam().make()),
        population_(scene_, kMaxDepth, suite_seed()),
        features_(path_features(scene_)),
        pairs_(make_pairs(features_)) {
    const MutationWeights all = default_mutation_weights();
    add("mixture", all);
    for (const auto& [name, weight] : all) add(name, {{name, 1.0}});
  }

  void add(const std::string& name, const MutationWeights& weights) {
    names_.push_back(name);
    tables_.push_back(
        make_path_mutations(weights, population_.techniques(), population_.max_vertices()));
  }

  void evaluate(const PathSample& x, std::vector<double>& values) const {
    values.clear();
    for (const Feature& f : features_) values.push_back(f.value(x.path()));
    values.push_back(1);  // index −1
  }

  /// One step from each part of a sample. A mutation alone is applied where it can be, π being one
  /// there. The chance of accepting is weighed, not played: a(g(x)h(y) − h(x)g(y)).
  void step(const MutationTable<PathSample>& table, const std::vector<PathSample>& parts,
            std::uint64_t sample, std::vector<double>& d, std::vector<double>& accepted) const {
    thread_local std::vector<double> at_x, at_y;
    std::ranges::fill(d, 0.0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
      if (table.size() == 1 && !(table[0]->selection_weight(parts[part]) > 0)) continue;
      Chain<PathSample> chain(parts[part], table);
      Rng rng(suite_seed(), RngDomain::Chain, sample * 4096 + part, 0);
      const StepInfo info = chain.step(table, rng, [](const PathSample&, double) {});
      if (!(info.a > 0)) continue;
      evaluate(parts[part], at_x);
      evaluate(info.accepted ? chain.state() : chain.proposed(), at_y);
      const auto value = [](const std::vector<double>& v, int i) {
        return i < 0 ? v.back() : v[static_cast<std::size_t>(i)];
      };
      for (std::size_t i = 0; i < pairs_.size(); ++i) {
        const auto [g, h] = pairs_[i];
        const double apart = value(at_x, g) * value(at_y, h) - value(at_x, h) * value(at_y, g);
        d[i] += info.a * apart;
        if (apart != 0) accepted[i] += info.a;
      }
    }
  }

  std::vector<Sums> run_block(std::uint64_t block) const {
    std::vector<Sums> sums(tables_.size(), Sums(pairs_.size()));
    std::vector<PathSample> parts;
    std::vector<double> d(pairs_.size());
    for (std::uint64_t sample = block * kBlock; sample < (block + 1) * kBlock; ++sample) {
      population_.draw(sample, 1, parts);
      if (parts.empty()) continue;
      for (std::size_t m = 0; m < tables_.size(); ++m) {
        step(tables_[m], parts, sample, d, sums[m].accepted);
        for (std::size_t i = 0; i < pairs_.size(); ++i) {
          if (d[i] == 0) continue;
          sums[m].difference[i] += d[i];
          sums[m].squares[i] += d[i] * d[i];
        }
      }
    }
    return sums;
  }

  std::string name(const Pair& pair) const {
    return features_[pair.g].name + " × " + (pair.h < 0 ? "1" : features_[pair.h].name);
  }

  Scene scene_;
  PathPopulation population_;
  std::vector<Feature> features_;
  std::vector<Pair> pairs_;
  std::vector<std::string> names_;
  std::vector<MutationTable<PathSample>> tables_;
};

TEST_P(TwoPoint, ForwardAndBackwardAreAlike) {
  const int blocks = kSamples / kBlock;
  std::vector<std::vector<Sums>> by_block(blocks);
  parallel_for(blocks,
               [&](std::int64_t b) { by_block[b] = run_block(static_cast<std::uint64_t>(b)); });
  const double level = sidak(
      kSuiteFalseAlarm, static_cast<int>(test_scenes().size() * tables_.size() * pairs_.size()));
  for (std::size_t m = 0; m < tables_.size(); ++m) {
    Sums total(pairs_.size());
    for (const auto& block : by_block) total.add(block[m]);
    int compared = 0;
    double moved = 0, worst = 0;
    std::string where;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      moved = std::max(moved, total.accepted[i]);
      if (total.accepted[i] < kLeastAccepted) continue;
      ++compared;
      const double z = total.difference[i] / std::sqrt(total.squares[i]);
      if (std::abs(z) > std::abs(worst)) worst = z, where = name(pairs_[i]);
      EXPECT_GT(p_value_normal(z), level) << names_[m] << ": " << name(pairs_[i]) << ", z = " << z
                                          << " over " << total.accepted[i] << " steps";
    }
    // Of a mutation that does anything, much must have been seen.
    EXPECT_TRUE(compared >= 60 || moved == 0) << names_[m] << ", at most " << moved << " steps";
    std::printf("%-18s %-14s %3d pairs, worst z %+.2f (%s)\n", GetParam().name.c_str(),
                names_[m].c_str(), compared, worst, where.c_str());
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, TwoPoint, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) { return test_name(info.param); });

}  // namespace
}  // namespace fogbow::testing
