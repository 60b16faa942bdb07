// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <chrono>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "core/estimators/estimator.h"
#include "core/image/film.h"
#include "core/math/random.h"
#include "core/util/parallel.h"
#include "mlt/chain.h"
#include "mlt/class_tally.h"
#include "mlt/normalization.h"

namespace fogbow {

/// What one chain has seen besides its splats.
struct ChainRecord {
  BridgeSums bridge;  ///< of independent steps
  /// By k: expected value of luminance / f* of the paths of k vertices, and of its square.
  std::vector<double> length_share, length_squares;
  ClassTally classes;  ///< of chains of paths alone

  /// Luminance of one contribution of the current state, in parts of its f*.
  void gather(int k, double part) {
    const auto size = static_cast<std::size_t>(k) + 1;
    if (of_state_.size() < size)
      for (auto* v : {&of_state_, &length_share, &length_squares}) v->resize(size);
    of_state_[k] += part;
    shortest_ = std::min(shortest_, size - 1);
    longest_ = std::max(longest_, size - 1);
  }
  /// All contributions of a state of this weight have been gathered.
  void settle(double weight) {
    for (std::size_t k = shortest_; k <= longest_; ++k) {
      length_share[k] += weight * of_state_[k];
      length_squares[k] += weight * sqr(of_state_[k]);
      of_state_[k] = 0;
    }
    shortest_ = kNone;
    longest_ = 0;
  }

  void serialize(std::ostream& out) const;
  static ChainRecord deserialize(std::istream& in);

 private:
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::vector<double> of_state_;
  std::size_t shortest_ = kNone, longest_ = 0;  ///< lengths of the state's contributions
};

/// Film::kGroups independent groups of chains of one State; every chain is a function of (seed,
/// index) alone.
template <class State>
class ChainEnsemble {
 public:
  using Start = std::function<State(int group, std::uint64_t chain)>;

  ChainEnsemble(const MutationTable<State>& table, std::uint64_t seed, int chains_per_group,
                const Start& start, const Bridge& bridge = {})
      : table_(table),
        seed_(seed),
        bridge_(bridge),
        chains_(Film::kGroups * chains_per_group),
        records_(chains_.size()) {
    parallel_for(static_cast<std::int64_t>(chains_.size()), [&](std::int64_t i) {
      chains_[i].emplace(start(group_of(i), static_cast<std::uint64_t>(i)), table_);
    });
  }

  std::size_t size() const { return chains_.size(); }
  static int group_of(std::size_t chain) { return static_cast<int>(chain % Film::kGroups); }

  /// Every chain goes on until it has made `steps(chain)` steps in all.
  void run(const std::function<std::uint64_t(std::size_t)>& steps, Film& film) {
    parallel_for(static_cast<std::int64_t>(chains_.size()), [&](std::int64_t i) {
      SplatQueue splats(film);
      const std::uint64_t goal = steps(i);
      while (chains_[i]->steps() < goal) step(i, splats);
      splats.flush();
    });
  }

  /// Splats what the current states have gathered.
  void finish(Film& film) {
    parallel_for(static_cast<std::int64_t>(chains_.size()), [&](std::int64_t i) {
      Rng rng(seed_, RngDomain::Film, static_cast<std::uint64_t>(i), chains_[i]->steps());
      SplatQueue splats(film);
      chains_[i]->leave(splatter(i, rng, splats));
      splats.flush();
    });
  }

  StepInfo step(std::size_t i, SplatQueue& splats) {
    Chain<State>& chain = *chains_[i];
    Rng rng(seed_, RngDomain::Chain, i, chain.steps());
    const bool timed = chain.steps() % kTimedStep == 0;
    const auto start = timed ? Clock::now() : Clock::time_point();
    const StepInfo info = chain.step(table_, rng, splatter(i, rng, splats));
    if (timed)
      chain.time(info.mutation, std::chrono::duration<double>(Clock::now() - start).count());
    if (table_[info.mutation]->independent()) tally(info, records_[i].bridge);
    return info;
  }

  const Chain<State>& chain(std::size_t i) const { return *chains_[i]; }
  const ChainRecord& record(std::size_t i) const { return records_[i]; }

  std::uint64_t total_steps() const {
    std::uint64_t total = 0;
    for (const auto& chain : chains_) total += chain->steps();
    return total;
  }

  void serialize(std::ostream& out) const {
    for (std::size_t i = 0; i < size(); ++i) {
      chains_[i]->serialize(out);
      records_[i].serialize(out);
    }
  }
  /// Into an ensemble made with the same arguments; `read` makes a State of a stream.
  void deserialize(std::istream& in, const std::function<State(std::istream&)>& read) {
    for (std::size_t i = 0; i < size(); ++i) {
      chains_[i].emplace(Chain<State>::deserialize(in, table_, read));
      records_[i] = ChainRecord::deserialize(in);
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// One step in so many is timed: the clock costs a part of a step.
  static constexpr std::uint64_t kTimedStep = 61;

  /// T(ȳ) is that of an independent step, and T(x̄) is found in its ratio. A refusal depends on ȳ
  /// alone, the choice of the mutation on x̄.
  void tally(const StepInfo& info, BridgeSums& sums) const {
    const Proposal& p = info.proposal;
    if (p.rejection) return sums.add_sample(0, 1);
    const double log_y = info.log_f_star_y - p.log_density;
    const double log_x = info.log_f_star_x - (p.log_ratio + p.log_density);
    sums.add_sample(std::exp(log_y), bridge_(log_y));
    sums.add_state(bridge_(log_x), 1 / info.selection_x);
  }

  auto splatter(std::size_t i, Rng& offsets, SplatQueue& splats) {
    return [this, i, &offsets, &splats](const State& x, double weight) {
      ChainRecord& record = records_[i];
      double all = 0, f_star = 0;  // in the unit of the contributions
      for (const Contribution& c : x.contributions()) {
        const double part = luminance(c.value);
        all += part;
        f_star += part * x.importance()(c.raster);
      }
      const double scale = weight / f_star;
      for (const Contribution& c : x.contributions()) {
        splats.splat(c.raster, c.value * scale, group_of(i), uniform2(offsets));
        record.gather(c.k, luminance(c.value) / f_star);
      }
      record.settle(weight);
      if constexpr (requires { x.path(); }) record.classes.add(path_class(x.path()), all * scale);
    };
  }

  const MutationTable<State>& table_;
  std::uint64_t seed_;
  Bridge bridge_;
  std::vector<std::optional<Chain<State>>> chains_;
  std::vector<ChainRecord> records_;
};

}  // namespace fogbow
