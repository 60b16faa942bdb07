// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/techniques.h"
#include "mlt/mutations/path_mutations.h"
#include "mlt/mutations/technique_sample.h"
#include "mlt/technique_distribution.h"

namespace fogbow {

namespace {

/// Primary samples of x, each perturbed on its own; past their end, what x did not depend on.
class PerturbedStream final : public SampleStream {
 public:
  PerturbedStream(const std::vector<double>& u, Rng& rng) : u_(u), rng_(rng) {}
  double next() override {
    const double u = rng_.uniform();
    return next_ < u_.size() ? perturb_primary_sample(u_[next_++], u) : u;
  }

 private:
  const std::vector<double>& u_;
  Rng& rng_;
  std::size_t next_ = 0;
};

/// A technique j is drawn in proportion to p_j(x̄), then primary samples u with S_j(u) = x̄, and
/// ȳ = S_j(u′). On (j, u) that is a symmetric step with the target f*(S_j u)/Σp(S_j u)
/// [Otsu2017, Bitterli2017].
class PrimarySampleStep final : public Mutation<PathSample> {
 public:
  PrimarySampleStep(double weight, const TechniqueDistribution& techniques)
      : weight_(weight), techniques_(techniques) {}
  const char* name() const override { return "primary_sample"; }
  double selection_weight(const PathSample&) const override { return weight_; }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const MeasuredPath& path = x.path();
    const int k = path.size();
    const auto [s, log_density] =
        choose_split(x.scene(), path, {0, k}, techniques_.probabilities(k), rng.uniform());
    thread_local std::vector<double> u;
    u.reserve(kMostNumbers + kNumbersPerVertex * y.path().capacity());
    if (!invert_technique(x.scene(), path, s, rng, u)) return refuse(Rejection::NotReversible);
    PerturbedStream perturbed(u, rng);
    if (const auto why = sample_technique(s, k - s, perturbed, y)) return refuse(*why);
    return {log_density - log_large_step_density(y, techniques_), std::nullopt};
  }

 private:
  /// That a subpath takes at its ends, and between them.
  static constexpr int kMostNumbers = 16, kNumbersPerVertex = 6;

  double weight_;
  const TechniqueDistribution& techniques_;
};

}  // namespace

PathMutation make_primary_sample(double weight, const TechniqueDistribution& techniques) {
  return std::make_unique<PrimarySampleStep>(weight, techniques);
}

}  // namespace fogbow
