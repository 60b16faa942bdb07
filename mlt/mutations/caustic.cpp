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
    const Scene& scene = x.scene();
    y = x;
    const Segment segment = *last_segment(scene, x.path());
    const Vec3 w = *perturb_departure(x, segment, kAngles, rng);
    if (const auto why = retrace(scene, y.path(), segment, w)) return refuse(*why);
    if (const auto why = complete_segment(y, segment, segment.anchor)) return refuse(*why);
    return {std::log(segment_density(scene, x.path(), segment) /
                     segment_density(scene, y.path(), segment)),
            std::nullopt};
  }

 private:
  double weight_;
};

}  // namespace

PathMutation make_caustic(double weight) { return std::make_unique<Caustic>(weight); }

}  // namespace fogbow
