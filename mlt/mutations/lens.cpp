// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/departure.h"
#include "mlt/mutations/path_mutations.h"

namespace fogbow {

namespace {

const StepSizes kAngles(1e-4, 0.1);

/// The segment after `s` on the eye's subpath, from the sensor if there is none before.
std::optional<Segment> next_segment(const MeasuredPath& x, const std::optional<Segment>& s) {
  const int anchor = s ? s->end : x.last();
  return anchor > 0 ? segment_from(x, anchor, Side::Light) : std::nullopt;
}

/// Lens and multi-chain perturbation: a step on the film, then one in direction for every further
/// specular chain, until two vertices follow each other that are not degenerate.
class EyePerturbation final : public Mutation<PathSample> {
 public:
  EyePerturbation(double weight, bool several) : weight_(weight), several_(several) {}
  const char* name() const override { return several_ ? "multichain" : "lens"; }
  double selection_weight(const PathSample& x) const override {
    auto s = next_segment(x.path(), std::nullopt);
    bool several = false;
    for (; s && !movable(x.scene(), x.path(), *s); s = next_segment(x.path(), s)) several = true;
    return s && several == several_ ? weight_ : 0.0;
  }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const Scene& scene = x.scene();
    MeasuredPath& path = y.path();
    y = x;
    std::optional<Segment> s;
    do {
      s = next_segment(x.path(), s);
      const auto w = perturb_departure(x, *s, kAngles, rng);
      if (!w) return refuse(Rejection::OffFilm);
      if (const auto why = retrace(scene, path, *s, *w)) return refuse(*why);
    } while (!movable(scene, x.path(), *s));
    const int end = s->end;
    if (const auto why = complete_segment(y, *s, path.last())) return refuse(*why);
    return {std::log(density(scene, x.path(), end) / density(scene, path, end)), std::nullopt};
  }

 private:
  /// Of all segments up to the vertex `end`.
  static double density(const Scene& scene, const MeasuredPath& x, int end) {
    double product = 1;
    for (auto s = next_segment(x, std::nullopt);; s = next_segment(x, s)) {
      product *= departure_density(scene, x, *s);
      if (s->end == end) return product;
    }
  }

  double weight_;
  bool several_;
};

}  // namespace

PathMutation make_lens(double weight) { return std::make_unique<EyePerturbation>(weight, false); }
PathMutation make_multichain(double weight) {
  return std::make_unique<EyePerturbation>(weight, true);
}

}  // namespace fogbow
