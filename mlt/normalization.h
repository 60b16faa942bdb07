// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <iosfwd>
#include <vector>

#include "core/image/film.h"
#include "mlt/primary_sample.h"

namespace fogbow {

/// b = ∫ f* dμ for each of the independent groups of chains: the mean over the group's own
/// bootstrap and independent steps.
class Normalization {
 public:
  void add(int group, double f_star_sum, double square_sum, std::uint64_t samples);
  double b(int group) const;
  /// Over all groups.
  double b() const;
  /// Of b(), from the spread between groups.
  double standard_error() const;
  std::uint64_t samples() const;
  /// χ² with kGroups − 1 degrees of freedom of the groups' values against the errors that each
  /// group states for itself.
  double disagreement() const;

  void serialize(std::ostream& out) const;
  static Normalization deserialize(std::istream& in);

 private:
  std::array<double, Film::kGroups> sum_{}, squares_{};
  std::array<std::uint64_t, Film::kGroups> samples_{};
};

/// Mean of independent replicates and its standard error.
struct ReplicateMean {
  double mean = 0, standard_error = 0;
};
ReplicateMean replicate_mean(const std::array<double, Film::kGroups>& replicates);

/// Luminance that BDPT's techniques carry, by k and s; from samples of its own, so that what is
/// made of it does not depend on where chains start.
std::vector<std::vector<double>> pilot_techniques(const Estimator& estimator, std::uint64_t seed,
                                                  std::uint64_t samples);

/// Independent estimates from which chains start.
class Bootstrap {
 public:
  /// `samples_per_group` for every group, doubled (up to 64 times as many) until all groups have
  /// found light. Throws Error(NoLight).
  Bootstrap(const Estimator& estimator, std::uint64_t seed, int samples_per_group);

  const Normalization& normalization() const { return normalization_; }
  /// One of the group's samples, in proportion to its f*: exactly distributed like f*/b once the
  /// picture is scaled by the group's b.
  PrimarySample start(int group, std::uint64_t chain) const;

 private:
  std::uint64_t stream(int group, std::uint64_t sample) const;

  const Estimator& estimator_;
  std::uint64_t seed_;
  Normalization normalization_;
  std::array<std::vector<double>, Film::kGroups> f_star_;
};

}  // namespace fogbow
