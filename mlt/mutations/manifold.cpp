// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/manifold/walk.h"
#include "mlt/mutations/candidates.h"
#include "mlt/mutations/departure.h"
#include "mlt/mutations/path_mutations.h"

namespace fogbow {

namespace {

const StepSizes kAngles(1e-4, 0.1);

/// From the anchor to the vertex that moves, and the chain by which it is joined to one that stays
/// (anchor there, as walks start from it).
struct Move {
  Segment traced, walked;
};

/// Calls visit(Move) for every way to move a vertex in front of a specular chain.
template <class Visit>
void for_each_move(const Scene& scene, const MeasuredPath& x, Visit&& visit) {
  for (int i = 0; i < x.size(); ++i) {
    if (x[i].degenerate) continue;
    for (const Side toward : {Side::Light, Side::Eye}) {
      const auto traced = segment_from(x, i, toward);
      if (!traced) continue;
      const auto beyond = held_chain_from(scene, x, traced->end, toward);
      if (!beyond || beyond->length() < 2 || x[beyond->end].parallel()) continue;
      const Side back = toward == Side::Light ? Side::Eye : Side::Light;
      visit(Move{*traced, {beyond->end, traced->end, back}});
    }
  }
}

int count(const PathSample& x) {
  return count_candidates([&](auto&& visit) { for_each_move(x.scene(), x.path(), visit); });
}

class Manifold final : public Mutation<PathSample> {
 public:
  explicit Manifold(double weight) : weight_(weight) {}
  const char* name() const override { return "manifold"; }
  double selection_weight(const PathSample& x) const override {
    return count(x) > 0 ? weight_ : 0.0;
  }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const Scene& scene = x.scene();
    MeasuredPath& path = y.path();
    const int candidates = count(x);
    const int chosen = static_cast<int>(rng.uniform() * candidates);
    const auto move =
        candidate<Move>(chosen, [&](auto&& visit) { for_each_move(scene, x.path(), visit); });
    y = x;
    const auto w = perturb_departure(x, move.traced, kAngles, rng);
    if (!w) return refuse(Rejection::OffFilm);
    if (const auto why = retrace(scene, path, move.traced, *w)) return refuse(*why);
    if (!walk(scene, path, move.walked)) return refuse(Rejection::WalkDiverged);
    const auto [first, last] = std::minmax(move.traced.anchor, move.walked.anchor);
    if (const auto why = complete(y, first, last, last_edge(move.walked))) return refuse(*why);
    if (!returns(scene, x.path(), path, move.walked)) return refuse(Rejection::NotReversible);

    // T of the traced part alone; f of the walked part is the reduced one [JakobMarschner2012].
    // A vertex that has come onto something glossy, or left it, has other moves.
    const double traced = departure_density(scene, x.path(), move.traced) /
                          departure_density(scene, path, move.traced);
    return {std::log(traced * candidates / count(y)) + log_reduction(scene, path, move.walked) -
                log_reduction(scene, x.path(), move.walked),
            std::nullopt};
  }

 private:
  double weight_;
};

}  // namespace

PathMutation make_manifold(double weight) { return std::make_unique<Manifold>(weight); }

}  // namespace fogbow
