// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/util/rng.h"

namespace fogbow {

/// Why a proposal cannot be made; expected, counted by kind.
enum class Rejection : std::uint8_t {
  OffFilm,
  MissedScene,
  WrongConfiguration,
  Occluded,
  WalkDiverged,
  NotReversible,
  NonFinite,
  NoLight,  ///< f*(ȳ) = 0 where the proposal itself cannot tell why
};
inline constexpr std::array<std::string_view, 8> kRejectionNames = {
    "off-film",      "missed-scene",   "wrong-configuration", "occluded",
    "walk-diverged", "not-reversible", "non-finite",          "no-light"};

struct Proposal {
  /// Log of the reverse over the forward joint proposal measure, auxiliary draws and Jacobians
  /// included; the target is not in it [Green1995].
  double log_ratio = 0;
  std::optional<Rejection> rejection;
  /// Log density of ȳ where it does not depend on x̄: f*(ȳ) over it estimates b.
  double log_density = 0;
  /// Index into the mutation's kinds(), for statistics.
  int kind = 0;
};
inline Proposal refuse(Rejection why, int kind = 0) { return {0, why, 0, kind}; }

/// Proposes ȳ from x̄. All state lives in the chain; x̄ is never written to.
template <class State>
class Mutation {
 public:
  virtual ~Mutation() = default;
  virtual const char* name() const = 0;
  /// Unnormalized π(x̄); the chain multiplies π(ȳ)/π(x̄).
  virtual double selection_weight(const State& x) const = 0;
  /// Whether ȳ does not depend on x̄.
  virtual bool independent() const { return false; }
  /// Kinds of proposals that statistics tell apart; empty where there is but one.
  virtual std::span<const std::string_view> kinds() const { return {}; }
  /// Writes ȳ, its f* included.
  virtual Proposal propose(const State& x, State& y, Rng& rng) const = 0;
};

}  // namespace fogbow
