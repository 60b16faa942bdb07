// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/primary_sample_mutations.h"

namespace fogbow {

namespace {

/// Both kernels are symmetric on the hypercube: the ratio of proposals is one.
class LargeStep final : public Mutation<PrimarySample> {
 public:
  LargeStep(const Estimator& estimator, double weight) : estimator_(estimator), weight_(weight) {}
  const char* name() const override { return "large_step"; }
  double selection_weight(const PrimarySample&) const override { return weight_; }
  bool independent() const override { return true; }
  Proposal propose(const PrimarySample&, PrimarySample& y, Rng& rng) const override {
    y.draw(estimator_, rng);
    return {};
  }

 private:
  const Estimator& estimator_;
  double weight_;
};

class SmallStep final : public Mutation<PrimarySample> {
 public:
  SmallStep(const Estimator& estimator, double weight) : estimator_(estimator), weight_(weight) {}
  const char* name() const override { return "small_step"; }
  double selection_weight(const PrimarySample&) const override { return weight_; }
  Proposal propose(const PrimarySample& x, PrimarySample& y, Rng& rng) const override {
    y.perturb(estimator_, x, rng);
    return {};
  }

 private:
  const Estimator& estimator_;
  double weight_;
};

}  // namespace

MutationTable<PrimarySample> make_primary_sample_mutations(const Estimator& estimator,
                                                           double large_step_probability) {
  MutationTable<PrimarySample> table;
  table.push_back(std::make_unique<LargeStep>(estimator, large_step_probability));
  table.push_back(std::make_unique<SmallStep>(estimator, 1 - large_step_probability));
  return table;
}

}  // namespace fogbow
