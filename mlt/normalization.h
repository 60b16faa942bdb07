// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <iosfwd>

#include "core/image/film.h"

namespace fogbow {

/// Where samples of density p and states of chains meet [MengWong1996]: with
/// g = 1/(1 + f*/(r₀p)), b = E_p[g f*/p] / E_{f*/b}[g]. What p samples far too seldom (f*/p ≫ r₀)
/// counts as little as chains spend their time elsewhere, instead of once in a long while for all.
class Bridge {
 public:
  /// No bridge: g = 1.
  Bridge() = default;
  /// `b`: about what is sought.
  explicit Bridge(double b) {
    if (b > 0) log_limit_ = std::log(kLimit * b);
  }

  /// g, by log f*/p.
  double operator()(double log_ratio) const { return 1 / (1 + std::exp(log_ratio - log_limit_)); }

 private:
  /// r₀ / b; the best is the ratio of independent samples to independent states that were looked
  /// at.
  static constexpr double kLimit = 300;

  double log_limit_ = std::numeric_limits<double>::infinity();
};

/// Sums over samples and states on both sides of a bridge.
struct BridgeSums {
  double f_star = 0, squares = 0;  ///< Σ f*/p, Σ (f*/p)²
  double sampled = 0;              ///< Σ g f*/p
  double sampled_squares = 0;      ///< Σ (g f*/p)²
  std::uint64_t samples = 0;
  double visited = 0, states = 0;  ///< Σ g of states, and how many they stand for

  void add_sample(double ratio, double g) {
    f_star += ratio;
    squares += ratio * ratio;
    sampled += g * ratio;
    sampled_squares += g * ratio * (g * ratio);
    ++samples;
  }
  void add_state(double g, double weight) {
    visited += g * weight;
    states += weight;
  }
  void add(const BridgeSums& other);
  /// Over the bridge, where there are states on its other side.
  double b() const;
  /// Of the samples alone.
  double mean() const;
  /// Equal samples that would know the mean of f*/p as well: (Σ f*/p)² / Σ (f*/p)².
  double effective_samples() const { return squares > 0 ? f_star * f_star / squares : 0; }
};

/// Standard error of b between groups, relative to b, above which the groups are said to disagree:
/// the picture's brightness is then anyone's guess.
inline constexpr double kDisagreement = 0.1;

/// b = ∫ f* dμ for each of the independent groups of chains, from the group's own bootstrap,
/// independent steps and the states they met.
class Normalization {
 public:
  void add(int group, const BridgeSums& sums) { groups_[group].add(sums); }
  double b(int group) const { return estimate(groups_[group]); }
  /// Of all groups together.
  double b() const { return estimate(all()); }
  /// Of b(), from the spread between groups, but no less than what the samples contribute by their
  /// own spread: eight groups may agree by chance.
  double standard_error() const;
  std::uint64_t samples() const;
  double effective_samples() const { return all().effective_samples(); }
  /// χ² with kGroups − 1 degrees of freedom of the groups' sample means of f*/p against the errors
  /// that each group states for itself.
  double disagreement() const;

  void serialize(std::ostream& out) const;
  static Normalization deserialize(std::istream& in);

 private:
  /// Not where its groups say next to nothing and those of the samples say more: few states may be
  /// found where samples and chains meet.
  bool over_bridge() const;
  double estimate(const BridgeSums& sums) const { return over_bridge() ? sums.b() : sums.mean(); }
  BridgeSums all() const;

  std::array<BridgeSums, Film::kGroups> groups_{};
};

/// Mean of independent replicates and its standard error.
struct ReplicateMean {
  double mean = 0, standard_error = 0;
};
ReplicateMean replicate_mean(const std::array<double, Film::kGroups>& replicates);

}  // namespace fogbow
