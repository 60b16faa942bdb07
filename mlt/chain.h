// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/util/binary_io.h"
#include "core/util/check.h"
#include "mlt/mutation.h"

namespace fogbow {

struct MutationCounts {
  std::uint64_t proposed = 0, accepted = 0;
  std::array<std::uint64_t, kRejectionNames.size()> rejected{};

  void add(const MutationCounts& other) {
    proposed += other.proposed;
    accepted += other.accepted;
    for (std::size_t i = 0; i < rejected.size(); ++i) rejected[i] += other.rejected[i];
  }
};

/// What one step did; `a` is the acceptance probability.
struct StepInfo {
  std::size_t mutation = 0;
  Proposal proposal;
  double f_star_x = 0, f_star_y = 0;
  double selection_x = 1, selection_y = 1;  ///< π
  double a = 0;
  bool accepted = false;
};

template <class State>
using MutationTable = std::vector<std::unique_ptr<Mutation<State>>>;

/// π(x̄) of one mutation of a table.
template <class State>
double selection_probability(const MutationTable<State>& table, std::size_t mutation,
                             const State& x) {
  double total = 0;
  for (const auto& m : table) total += m->selection_weight(x);
  return total > 0 ? table[mutation]->selection_weight(x) / total : 0;
}

/// A Metropolis–Hastings chain with target f*. A State offers f_star(), serialize(out) and static
/// deserialize(in).
template <class State>
class Chain {
 public:
  /// `start` must carry light.
  explicit Chain(State start) : x_(std::move(start)), y_(x_) { FOGBOW_CHECK(x_.f_star() > 0); }

  /// The only place where an acceptance is formed. `splat(state, weight)` takes expected-value
  /// weights: the proposal's a, and the current state's gathered 1 − a when the chain leaves it.
  template <class Splat>
  StepInfo step(const MutationTable<State>& table, Rng& rng, Splat&& splat) {
    StepInfo info;
    info.mutation = choose(table, rng.uniform());
    const Mutation<State>& mutation = *table[info.mutation];
    info.f_star_x = x_.f_star();
    info.proposal = mutation.propose(x_, y_, rng);
    MutationCounts& counts = counts_[info.mutation];
    ++counts.proposed;
    if (!info.proposal.rejection) {
      info.f_star_y = y_.f_star();
      if (!std::isfinite(info.f_star_y) || !std::isfinite(info.proposal.log_ratio))
        info.proposal.rejection = Rejection::NonFinite;
      else if (!(info.f_star_y > 0))
        info.proposal.rejection = Rejection::NoLight;
    }
    if (info.proposal.rejection) {
      ++counts.rejected[static_cast<std::size_t>(*info.proposal.rejection)];
    } else {
      info.selection_x = selection_probability(table, info.mutation, x_);
      info.selection_y = selection_probability(table, info.mutation, y_);
      info.a = acceptance(info);
    }
    ++steps_;
    weight_ += 1 - info.a;
    info.accepted = rng.uniform() < info.a;
    if (info.accepted) {
      ++counts.accepted;
      leave(splat);
      std::swap(x_, y_);
      weight_ = info.a;
    } else if (info.a > 0) {
      splat(std::as_const(y_), info.a);
    }
    return info;
  }

  /// a(x̄→ȳ) = min{1, f*(ȳ)π(ȳ)T(ȳ→x̄;r*) / (f*(x̄)π(x̄)T(x̄→ȳ;r))}.
  static double acceptance(const StepInfo& info) {
    const double ratio = info.f_star_y * info.selection_y / (info.f_star_x * info.selection_x);
    return std::fmin(1.0, ratio * std::exp(info.proposal.log_ratio));
  }

  /// Splats what the current state has gathered; at the end of a run.
  template <class Splat>
  void leave(Splat&& splat) {
    if (weight_ > 0) splat(std::as_const(x_), weight_);
    weight_ = 0;
  }

  const State& state() const { return x_; }
  const State& proposed() const { return y_; }
  std::uint64_t steps() const { return steps_; }
  const std::vector<MutationCounts>& counts() const { return counts_; }
  void prepare(std::size_t mutations) { counts_.resize(mutations); }

  void serialize(std::ostream& out) const {
    x_.serialize(out);
    write_binary(out, weight_);
    write_binary(out, steps_);
    write_binary_vector(out, counts_);
  }
  static Chain deserialize(std::istream& in) {
    Chain chain(State::deserialize(in));
    chain.weight_ = read_binary<double>(in);
    chain.steps_ = read_binary<std::uint64_t>(in);
    chain.counts_ = read_binary_vector<MutationCounts>(in, 1024);
    return chain;
  }

 private:
  std::size_t choose(const MutationTable<State>& table, double u) const {
    double total = 0;
    for (const auto& m : table) total += m->selection_weight(x_);
    FOGBOW_CHECK(total > 0);
    double rest = u * total;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
      const double weight = table[i]->selection_weight(x_);
      if (weight <= 0) continue;
      chosen = i;
      if (rest < weight) break;
      rest -= weight;
    }
    return chosen;
  }

  State x_, y_;
  double weight_ = 0;
  std::uint64_t steps_ = 0;
  std::vector<MutationCounts> counts_;
};

}  // namespace fogbow
