// SPDX-License-Identifier: GPL-3.0-or-later
// A world that can be enumerated, run through the very Chain of the engine.
#include <gtest/gtest.h>

#include <numeric>

#include "mlt/chain.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

constexpr int kNodes = 12;
constexpr double kTarget[kNodes] = {0.4, 2.5, 1, 0.05, 3, 0.7, 1.2, 0.9, 5, 0.2, 0, 1.6};

struct Node {
  int index = 0;
  double log_f_star() const { return std::log(kTarget[index]); }
  Vec2 raster() const { return {index, 0}; }
  std::uint64_t selection_key() const { return index % 3 + (index < 6 ? 1 : 4); }
  void serialize(std::ostream& out) const { write_binary(out, index); }
};

/// Proposals that can be listed.
class Enumerable : public Mutation<Node> {
 public:
  /// T(x → y).
  virtual double density(int x, int y) const = 0;
  Proposal propose(const Node& x, Node& y, Rng& rng) const override {
    double u = rng.uniform();
    for (y.index = 0; y.index < kNodes - 1; ++y.index) {
      u -= density(x.index, y.index);
      if (u < 0) break;
    }
    return {std::log(density(y.index, x.index) / density(x.index, y.index)), std::nullopt,
            std::log(density(x.index, y.index))};
  }
};

/// Steps around a ring, more often up than down, and by a state-dependent choice of mutation.
class Drift final : public Enumerable {
 public:
  const char* name() const override { return "drift"; }
  double selection_weight(const Node& x) const override { return 1 + x.index % 3; }
  double density(int x, int y) const override {
    if (y == (x + 1) % kNodes) return 0.7;
    if (x == (y + 1) % kNodes) return 0.3;
    return 0;
  }
};

/// Jumps that prefer nodes of high index.
class Jump final : public Enumerable {
 public:
  const char* name() const override { return "jump"; }
  double selection_weight(const Node& x) const override { return x.index < 6 ? 0.5 : 2; }
  bool independent() const override { return true; }
  double density(int, int y) const override { return (y + 1.0) / (kNodes * (kNodes + 1) / 2); }
};

MutationTable<Node> table() {
  MutationTable<Node> t;
  t.push_back(std::make_unique<Drift>());
  t.push_back(std::make_unique<Jump>());
  return t;
}

/// π by its definition.
double pi(const MutationTable<Node>& t, std::size_t mutation, int x) {
  double total = 0;
  for (const auto& m : t) total += m->selection_weight(Node{x});
  return t[mutation]->selection_weight(Node{x}) / total;
}

/// Transition matrix by Chain's own acceptance.
std::array<std::array<double, kNodes>, kNodes> transition_matrix(const MutationTable<Node>& t) {
  std::array<std::array<double, kNodes>, kNodes> P{};
  for (int x = 0; x < kNodes; ++x) {
    for (std::size_t m = 0; m < t.size(); ++m) {
      const auto& mutation = static_cast<const Enumerable&>(*t[m]);
      for (int y = 0; y < kNodes; ++y) {
        const double T = mutation.density(x, y);
        if (T == 0 || kTarget[x] == 0) continue;
        StepInfo info;
        info.log_f_star_x = std::log(kTarget[x]);
        info.log_f_star_y = std::log(kTarget[y]);
        info.selection_x = pi(t, m, x);
        info.selection_y = pi(t, m, y);
        info.proposal.log_ratio = std::log(mutation.density(y, x) / T);
        P[x][y] += info.selection_x * T * Chain<Node>::acceptance(info);
      }
    }
    P[x][x] += 1 - std::accumulate(P[x].begin(), P[x].end(), 0.0);
  }
  return P;
}

TEST(FiniteWorld, TargetIsInvariant) {
  const auto t = table();
  const auto P = transition_matrix(t);
  for (int y = 0; y < kNodes; ++y) {
    double sum = 0;
    for (int x = 0; x < kNodes; ++x) sum += kTarget[x] * P[x][y];
    EXPECT_NEAR(sum, kTarget[y], 1e-14 * kNodes);
  }
}

TEST(FiniteWorld, ChainMovesAsItsTransitionMatrixSays) {
  const auto t = table();
  const auto P = transition_matrix(t);
  constexpr int kTrials = 20000;
  double least = 1;
  int comparisons = 0;
  for (int x = 0; x < kNodes; ++x) {
    if (kTarget[x] == 0) continue;
    std::array<std::uint64_t, kNodes> counts{};
    std::array<double, kNodes> expected{};
    for (int i = 0; i < kTrials; ++i) {
      Chain<Node> chain(Node{x}, t);
      Rng rng(testing::suite_seed(), RngDomain::Test, x, i);
      chain.step(t, rng, [](const Node&, double) {});
      ++counts[chain.state().index];
    }
    for (int y = 0; y < kNodes; ++y) expected[y] = kTrials * P[x][y];
    least = std::min(least, testing::chi2_test(counts, expected));
    ++comparisons;
  }
  EXPECT_GT(least, testing::sidak(testing::kSuiteFalseAlarm, comparisons));
}

TEST(FiniteWorld, SplatsEstimateTheTarget) {
  // Expected-value splats over many short independent chains, started from the target: every node's
  // mean weight is its share.
  const auto t = table();
  const double b = std::accumulate(std::begin(kTarget), std::end(kTarget), 0.0);
  constexpr int kChains = 4000, kSteps = 50;
  std::vector<std::vector<double>> weights(kNodes, std::vector<double>(kChains, 0.0));
  for (int i = 0; i < kChains; ++i) {
    Rng start(testing::suite_seed(), RngDomain::WarmUp, i, 0);
    double u = start.uniform() * b;
    int x = 0;
    while (x < kNodes - 1 && u >= kTarget[x]) u -= kTarget[x++];
    Chain<Node> chain(Node{x}, t);
    const auto splat = [&](const Node& node, double w) { weights[node.index][i] += w / kSteps; };
    for (int step = 0; step < kSteps; ++step) {
      Rng rng(testing::suite_seed(), RngDomain::Chain, i, step);
      chain.step(t, rng, splat);
    }
    chain.leave(splat);
  }
  for (int x = 0; x < kNodes; ++x) {
    if (kTarget[x] == 0) {
      EXPECT_EQ(*std::max_element(weights[x].begin(), weights[x].end()), 0);
      continue;
    }
    EXPECT_GT(testing::compare(testing::estimate(weights[x]), kTarget[x] / b),
              testing::sidak(testing::kSuiteFalseAlarm, kNodes))
        << x;
  }
}

}  // namespace
}  // namespace fogbow
