// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/departure.h"
#include "mlt/mutations/path_mutations.h"

namespace fogbow {

namespace {

const StepSizes kAngles(1e-3, 1);

/// The segment that brings light to the vertex next to the sensor.
std::optional<Segment> last_segment(const Scene& scene, const MeasuredPath& x) {
  const int end = x.last() - 1;
  if (end < 1 || x[end].degenerate) return std::nullopt;
  const auto back = segment_from(x, end, Side::Light);
  if (!back) return std::nullopt;
  const Segment segment{back->end, end, Side::Eye};
  return movable(scene, x, segment) ? std::optional(segment) : std::nullopt;
}

class Caustic final : public Mutation<PathSample> {
 public:
  explicit Caustic(double weight) : weight_(weight) {}
  const char* name() const override { return "caustic"; }
  double selection_weight(const PathSample& x) const override {
    return last_segment(x.scene(), x.path()) ? weight_ : 0.0;
  }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    return perturb_segment(x, y, *last_segment(x.scene(), x.path()), kAngles, rng);
  }

 private:
  double weight_;
};

}  // namespace

PathMutation make_caustic(double weight) { return std::make_unique<Caustic>(weight); }

}  // namespace fogbow
