// SPDX-License-Identifier: GPL-3.0-or-later
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
    const Scene& scene = x.scene();
    y = x;
    const int chosen = static_cast<int>(rng.uniform() * count(x));
    Segment segment{};
    int n = 0;
    for_each_segment(scene, x.path(), [&](const Segment& s) {
      if (n++ == chosen) segment = s;
    });
    const Vec3 w = *perturb_departure(x, segment, kAngles, rng);
    if (const auto why = retrace(scene, y.path(), segment, w)) return refuse(*why);
    if (const auto why = complete_segment(y, segment, segment.anchor)) return refuse(*why);
    return {std::log(segment_density(scene, x.path(), segment) /
                     segment_density(scene, y.path(), segment)),
            std::nullopt};
  }

 private:
  static int count(const PathSample& x) {
    int n = 0;
    for_each_segment(x.scene(), x.path(), [&](const Segment&) { ++n; });
    return n;
  }

  double weight_;
};

}  // namespace

PathMutation make_scattering(double weight) {
  return std::make_unique<ScatteringPerturbation>(weight);
}

}  // namespace fogbow
