// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/mutations/candidates.h"
#include "mlt/mutations/held_ray.h"
#include "mlt/mutations/path_mutations.h"

namespace fogbow {

namespace {

constexpr std::string_view kKinds[] = {"volume-volume", "volume-surface", "surface-volume"};
enum Kind { Within, ToWall, OffWall };

int count(const PathSample& x) {
  return count_candidates([&](auto&& visit) { for_each_held_vertex(x.path(), false, visit); });
}

/// Σ over channels of the kernel K from distance `from` to `to`, both ends being the wall where
/// they have its distance.
double kernel(const RayProfile& profile, double from, double to) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    const LocalSteps steps(profile, c);
    if (steps.empty()) continue;
    if (to == profile.length())
      sum += steps.mass_on_wall(from);
    else
      sum += from == profile.length() ? steps.q_off_wall(to) : steps.q(from, to);
  }
  return sum;
}

class Propagation final : public Mutation<PathSample> {
 public:
  explicit Propagation(double weight) : weight_(weight) {}
  const char* name() const override { return "propagation"; }
  std::span<const std::string_view> kinds() const override { return kKinds; }
  double selection_weight(const PathSample& x) const override { return count(x) > 0 ? weight_ : 0; }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const Scene& scene = x.scene();
    const int candidates = count(x);
    const int chosen = static_cast<int>(rng.uniform() * candidates);
    const auto held = candidate<HeldVertex>(
        chosen, [&](auto&& visit) { for_each_held_vertex(x.path(), false, visit); });
    thread_local HeldRay ray;
    Kind kind = x.path()[held.vertex].in_medium() ? Within : OffWall;
    if (!ray.trace(scene, x.path(), held)) return refuse(Rejection::NotReversible, kind);

    const LocalSteps steps(ray.profile(), static_cast<int>(3 * rng.uniform()));
    if (steps.empty()) return refuse(Rejection::WrongConfiguration, kind);
    const double u = kind == Within ? steps.step(ray.t(), rng) : steps.step_off_wall(rng);
    if (u >= steps.u_wall()) kind = ToWall;
    y = x;
    double t = ray.wall();
    if (kind == ToWall) {
      if (!ray.has_wall(scene)) return refuse(Rejection::WrongConfiguration, kind);
      ray.move_to_wall(y.path());
    } else {
      const auto distance = steps.distance(u);
      if (!distance || !ray.move_into_medium(scene, *distance, y.path()))
        return refuse(Rejection::WrongConfiguration, kind);
      t = *distance;
    }
    if (const auto why = complete_move(y, held)) return refuse(*why, kind);

    const double forward =
        kernel(ray.profile(), ray.t(), t) / candidates * held_measure(scene, y.path(), held);
    const double reverse =
        kernel(ray.profile(), t, ray.t()) / count(y) * held_measure(scene, x.path(), held);
    return {std::log(reverse / forward), std::nullopt, 0, kind};
  }

 private:
  double weight_;
};

}  // namespace

PathMutation make_propagation(double weight) { return std::make_unique<Propagation>(weight); }

}  // namespace fogbow
