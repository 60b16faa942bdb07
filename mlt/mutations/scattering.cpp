// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/candidates.h"
#include "mlt/mutations/departure.h"
#include "mlt/mutations/path_mutations.h"

namespace fogbow {

namespace {

const StepSizes kAngles(0.02, 3);

/// Calls visit(segment) for the segments that leave medium vertices and can be moved.
template <class Visit>
void for_each_segment(const Scene& scene, const MeasuredPath& x, Visit&& visit) {
  for (int i = 1; i < x.last(); ++i) {
    if (!x[i].in_medium()) continue;
    for (const Side toward : {Side::Light, Side::Eye}) {
      const auto segment = segment_from(x, i, toward);
      if (segment && movable(scene, x, *segment)) visit(*segment);
    }
  }
}

class ScatteringPerturbation final : public Mutation<PathSample> {
 public:
  explicit ScatteringPerturbation(double weight) : weight_(weight) {}
  const char* name() const override { return "scattering"; }
  double selection_weight(const PathSample& x) const override { return count(x) > 0 ? weight_ : 0; }

  /// One of the segments, of which ȳ has the same.
  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const int chosen = static_cast<int>(rng.uniform() * count(x));
    const auto segment = candidate<Segment>(
        chosen, [&](auto&& visit) { for_each_segment(x.scene(), x.path(), visit); });
    return perturb_segment(x, y, segment, kAngles, rng);
  }

 private:
  static int count(const PathSample& x) {
    return count_candidates([&](auto&& visit) { for_each_segment(x.scene(), x.path(), visit); });
  }

  double weight_;
};

}  // namespace

PathMutation make_scattering(double weight) {
  return std::make_unique<ScatteringPerturbation>(weight);
}

}  // namespace fogbow
