// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <span>
#include <vector>

namespace fogbow {

/// What one chain has seen of a quantity h: Σ w h and Σ w h² over states of weights w.
struct ChainMoments {
  double sum = 0, squares = 0;
};

/// How well chains have mixed, as far as one quantity tells.
struct Convergence {
  double r_hat = 1;  ///< potential scale reduction [GelmanRubin1992]; 1 where all chains agree
  /// Independent samples that would give the same error of the mean over all chains; from the
  /// spread between chains, so that no correlation escapes it.
  double effective_samples = 0;
};

/// Of at least two chains that have made `steps` steps each on average, weights summing to that.
/// A quantity that does not vary counts as converged.
Convergence convergence(std::span<const ChainMoments> chains, std::span<const double> steps);

}  // namespace fogbow
