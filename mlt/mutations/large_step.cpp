// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/estimators/sampling.h"
#include "core/path/techniques.h"
#include "mlt/mutations/path_mutations.h"
#include "mlt/mutations/technique_sample.h"
#include "mlt/technique_distribution.h"

namespace fogbow {

namespace {

class LargeStep final : public Mutation<PathSample> {
 public:
  LargeStep(double weight, const TechniqueDistribution& techniques)
      : weight_(weight), techniques_(techniques) {}
  const char* name() const override { return "large_step"; }
  double selection_weight(const PathSample&) const override { return weight_; }
  bool independent() const override { return true; }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const auto [s, t] = techniques_.sample(rng.uniform());
    RandomStream u(rng);
    if (const auto why = sample_technique(s, t, u, y)) return refuse(*why);
    const double forward = log_large_step_density(y, techniques_);
    return {log_large_step_density(x, techniques_) - forward, std::nullopt, forward};
  }

 private:
  double weight_;
  const TechniqueDistribution& techniques_;
};

}  // namespace

double log_large_step_density(const PathSample& y, const TechniqueDistribution& techniques) {
  const int k = y.path().size();
  return log_range_density(y.scene(), y.path(), {0, k}, techniques.probabilities(k));
}

PathMutation make_large_step(double weight, const TechniqueDistribution& techniques) {
  return std::make_unique<LargeStep>(weight, techniques);
}

}  // namespace fogbow
