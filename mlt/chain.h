// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "core/math/vec.h"
#include "core/util/binary_io.h"
#include "core/util/check.h"
#include "mlt/mutation.h"

namespace fogbow {

/// Of the proposals of one mutation in one chain.
struct MutationCounts {
  static constexpr std::size_t kMostKinds = 16;

  std::uint64_t proposed = 0, accepted = 0;
  std::array<std::uint64_t, kRejectionNames.size()> rejected{};
  std::array<std::uint64_t, kMostKinds> proposed_kind{}, accepted_kind{};
  double squared_jump = 0;  ///< Σ a |raster(ȳ) − raster(x̄)|²
  double seconds = 0;       ///< of the steps that were timed
  std::uint64_t timed = 0;

  void add(const MutationCounts& other) {
    proposed += other.proposed;
    accepted += other.accepted;
    for (std::size_t i = 0; i < rejected.size(); ++i) rejected[i] += other.rejected[i];
    for (std::size_t i = 0; i < kMostKinds; ++i) {
      proposed_kind[i] += other.proposed_kind[i];
      accepted_kind[i] += other.accepted_kind[i];
    }
    squared_jump += other.squared_jump;
    seconds += other.seconds;
    timed += other.timed;
  }
};

/// What one step did; `a` is the acceptance probability.
struct StepInfo {
  std::size_t mutation = 0;
  Proposal proposal;
  double log_f_star_x = 0, log_f_star_y = 0;
  double selection_x = 1, selection_y = 1;  ///< π
  double a = 0;
  bool accepted = false;
};

template <class State>
using MutationTable = std::vector<std::unique_ptr<Mutation<State>>>;

/// π(x̄) of every mutation of a table.
class Selection {
 public:
  template <class State>
  void evaluate(const MutationTable<State>& table, const State& x) {
    weights_.resize(table.size());
    total_ = 0;
    for (std::size_t i = 0; i < table.size(); ++i)
      total_ += weights_[i] = table[i]->selection_weight(x);
  }
  double probability(std::size_t mutation) const { return weights_[mutation] / total_; }
  std::size_t choose(double u) const {
    FOGBOW_CHECK(total_ > 0);
    double rest = u * total_;
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < weights_.size(); ++i) {
      if (weights_[i] <= 0) continue;
      chosen = i;
      if (rest < weights_[i]) break;
      rest -= weights_[i];
    }
    return chosen;
  }

 private:
  std::vector<double> weights_;
  double total_ = 0;
};

/// A Metropolis–Hastings chain with target f*. A State offers log_f_star(), raster(),
/// serialize(out) and selection_key(): states of one key that is not 0 have the same selection
/// weights.
template <class State>
class Chain {
 public:
  /// `start` must carry light.
  Chain(State start, const MutationTable<State>& table)
      : x_(std::move(start)), y_(x_), counts_(table.size()) {
    FOGBOW_CHECK(x_.log_f_star() > -std::numeric_limits<double>::infinity());
    selection_x_.evaluate(table, x_);
    selection_y_ = selection_x_;
  }

  /// The only place where an acceptance is formed. `splat(state, weight)` takes expected-value
  /// weights: the proposal's a, and the current state's gathered 1 − a when the chain leaves it.
  template <class Splat>
  StepInfo step(const MutationTable<State>& table, Rng& rng, Splat&& splat) {
    const std::size_t mutation = selection_x_.choose(rng.uniform());
    StepInfo info{.mutation = mutation,
                  .proposal = table[mutation]->propose(x_, y_, rng),
                  .log_f_star_x = x_.log_f_star()};
    if (!info.proposal.rejection) {
      info.log_f_star_y = y_.log_f_star();
      if (info.log_f_star_y == -std::numeric_limits<double>::infinity())
        info.proposal.rejection = Rejection::NoLight;
      else if (info.proposal.log_ratio == -std::numeric_limits<double>::infinity())
        info.proposal.rejection = Rejection::NotReversible;
      else if (!std::isfinite(info.log_f_star_y) || !std::isfinite(info.proposal.log_ratio))
        info.proposal.rejection = Rejection::NonFinite;
    }
    const bool same_selection = x_.selection_key() != 0 && x_.selection_key() == y_.selection_key();
    if (!info.proposal.rejection) {
      if (!same_selection) selection_y_.evaluate(table, y_);
      info.selection_x = selection_x_.probability(info.mutation);
      info.selection_y = (same_selection ? selection_x_ : selection_y_).probability(info.mutation);
      info.a = acceptance(info);
    }
    info.accepted = rng.uniform() < info.a;
    count(info);
    ++steps_;
    weight_ += 1 - info.a;
    if (info.accepted) {
      leave(splat);
      std::swap(x_, y_);
      if (!same_selection) std::swap(selection_x_, selection_y_);
      weight_ = info.a;
    } else if (info.a > 0) {
      splat(std::as_const(y_), info.a);
    }
    return info;
  }

  /// a(x̄→ȳ) = min{1, f*(ȳ)π(ȳ)T(ȳ→x̄;r*) / (f*(x̄)π(x̄)T(x̄→ȳ;r))}.
  static double acceptance(const StepInfo& info) {
    const double log_ratio = info.log_f_star_y - info.log_f_star_x + info.proposal.log_ratio;
    return std::min(1.0, info.selection_y / info.selection_x * std::exp(log_ratio));
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
  /// What a step of this mutation took.
  void time(std::size_t mutation, double seconds) {
    counts_[mutation].seconds += seconds;
    ++counts_[mutation].timed;
  }

  void serialize(std::ostream& out) const {
    x_.serialize(out);
    write_binary(out, weight_);
    write_binary(out, steps_);
    write_binary_vector(out, counts_);
  }
  /// `read` makes a State of what its serialize() wrote.
  template <class Read>
  static Chain deserialize(std::istream& in, const MutationTable<State>& table, Read&& read) {
    Chain chain(read(in), table);
    chain.weight_ = read_binary<double>(in);
    chain.steps_ = read_binary<std::uint64_t>(in);
    chain.counts_ = read_binary_vector<MutationCounts>(in, 1024);
    return chain;
  }

 private:
  void count(const StepInfo& info) {
    MutationCounts& c = counts_[info.mutation];
    ++c.proposed;
    ++c.proposed_kind[info.proposal.kind];
    if (info.proposal.rejection) {
      ++c.rejected[static_cast<std::size_t>(*info.proposal.rejection)];
      return;
    }
    const Vec2 jump = y_.raster() - x_.raster();
    c.squared_jump += info.a * dot(jump, jump);
    c.accepted += info.accepted;
    c.accepted_kind[info.proposal.kind] += info.accepted;
  }

  State x_, y_;
  Selection selection_x_, selection_y_;
  double weight_ = 0;
  std::uint64_t steps_ = 0;
  std::vector<MutationCounts> counts_;
};

}  // namespace fogbow
