// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/warp.h"
#include "mlt/manifold/walk.h"
#include "mlt/mutations/candidates.h"
#include "mlt/mutations/held_ray.h"
#include "mlt/mutations/path_mutations.h"

namespace fogbow {

namespace {

/// direction of the flip + 2 · held side + 4 · held through specular + 8 · re-connected by a walk.
constexpr std::string_view kKinds[] = {
    "S-V light direct direct", "V-S light direct direct",   "S-V eye direct direct",
    "V-S eye direct direct",   "S-V light specular direct", "V-S light specular direct",
    "S-V eye specular direct", "V-S eye specular direct",   "S-V light direct walk",
    "V-S light direct walk",   "S-V eye direct walk",       "V-S eye direct walk",
    "S-V light specular walk", "V-S light specular walk",   "S-V eye specular walk",
    "V-S eye specular walk"};

int kind_of(const MeasuredPath& x, const HeldVertex& h) {
  return x[h.vertex].in_medium() + 2 * (h.held == Side::Eye) + 4 * x[h.before()].degenerate +
         8 * x[h.beyond()].degenerate;
}

/// Where the vertex is joined to what stays: one edge, or the chain from the far vertex.
Segment far_segment(const MeasuredPath& x, const HeldVertex& h) {
  const Segment there = *segment_from(x, h.vertex, h.held == Side::Light ? Side::Eye : Side::Light);
  return {there.end, h.vertex, h.held};
}

/// Of choosing a flip that takes a walk, against a direct one: it costs many traced chains, and
/// most of them are refused.
constexpr double kWalkWeight = 1.0 / 8;

template <class Visit>
void for_each_flip(const MeasuredPath& x, Visit&& visit) {
  for_each_held_vertex(x, true, [&](const HeldVertex& h) {
    if (!x[h.beyond()].degenerate) return visit(h, 1.0);
    const auto there = segment_from(x, h.vertex, h.held == Side::Light ? Side::Eye : Side::Light);
    if (there && !x[there->end].parallel()) visit(h, kWalkWeight);
  });
}

double flip_weight(const PathSample& x) {
  return total_weight([&](auto&& visit) { for_each_flip(x.path(), visit); });
}

/// Law q(t) of the distance at which a vertex leaves the wall: free flight that does not reach the
/// wall, equiangular towards the far vertex, and local steps; a mixture of all that apply.
class Departure {
 public:
  Departure(const RayProfile& profile, const Vertex& far) : profile_(profile) {
    for (int c = 0; c < 3; ++c) {
      const LocalSteps steps(profile, c);
      if (!steps.empty()) channels_[channel_count_++] = c;
    }
    if (far.parallel()) return;
    const Vec3 d = far.position() - profile.point(0);
    const double foot = dot(d, profile.edge().w), distance = length(d - foot * profile.edge().w);
    if (distance > 1e-9 * profile.length()) towards_ = {foot, distance, 0, profile.length()};
  }

  std::optional<double> sample(Rng& rng) const {
    const double law = rng.uniform(), u = rng.uniform();
    if (law < equiangular()) return towards_->sample(u);
    const int c = channels_[static_cast<int>(rng.uniform() * channel_count_)];
    const LocalSteps steps(profile_, c);
    if (law < equiangular() + (1 - equiangular()) / 2) return steps.distance(steps.u_wall() * u);
    return steps.distance(steps.step_off_wall(rng));
  }

  double q(double t) const {
    double sum = 0;
    for (int i = 0; i < channel_count_; ++i) {
      const LocalSteps steps(profile_, channels_[i]);
      sum += (steps.free_flight(t) + steps.q_off_wall(t)) / 2;
    }
    sum *= (1 - equiangular()) / channel_count_;
    return towards_ ? sum + equiangular() * towards_->pdf(t) : sum;
  }

  bool empty() const { return channel_count_ == 0; }

 private:
  double equiangular() const { return towards_ ? 1.0 / 3 : 0.0; }

  const RayProfile& profile_;
  std::optional<warp::Equiangular> towards_;
  int channels_[3] = {}, channel_count_ = 0;
};

class Switch final : public Mutation<PathSample> {
 public:
  explicit Switch(double weight) : weight_(weight) {}
  const char* name() const override { return "switch"; }
  std::span<const std::string_view> kinds() const override { return kKinds; }
  double selection_weight(const PathSample& x) const override {
    return weight_ * std::min(flip_weight(x), 1.0);
  }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const Scene& scene = x.scene();
    const double weight = flip_weight(x);
    const auto held = weighted_candidate<HeldVertex>(
        rng.uniform() * weight, [&](auto&& visit) { for_each_flip(x.path(), visit); });
    const int kind = kind_of(x.path(), held);
    const bool into_medium = !x.path()[held.vertex].in_medium();
    const Segment far = far_segment(x.path(), held);
    thread_local HeldRay ray;
    if (!ray.trace(scene, x.path(), held)) return refuse(Rejection::NotReversible, kind);
    if (!ray.has_wall(scene)) return refuse(Rejection::WrongConfiguration, kind);

    const Departure law(ray.profile(), x.path()[far.anchor]);
    if (law.empty()) return refuse(Rejection::WrongConfiguration, kind);
    y = x;
    double t = ray.t();  // of the vertex in the medium
    if (into_medium) {
      const auto distance = law.sample(rng);
      if (!distance || !ray.move_into_medium(scene, *distance, y.path()))
        return refuse(Rejection::WrongConfiguration, kind);
      t = *distance;
    } else {
      ray.move_to_wall(y.path());
    }
    double log_reductions = 0;
    if (const auto why = reconnect(x, y, held, far, log_reductions)) return refuse(*why, kind);

    // Densities in μ given the held ray, but for the candidate's own weight, which it keeps;
    // landing on the wall is certain.
    const double q = law.q(t);
    const double forward = (into_medium ? q : 1) / weight * held_measure(scene, y.path(), held);
    const double reverse =
        (into_medium ? 1 : q) / flip_weight(y) * held_measure(scene, x.path(), held);
    return {std::log(reverse / forward) + log_reductions, std::nullopt, 0, kind};
  }

 private:
  static std::optional<Rejection> reconnect(const PathSample& x, PathSample& y,
                                            const HeldVertex& held, const Segment& far,
                                            double& log_reductions) {
    if (far.length() == 1) return complete_move(y, held);
    const Scene& scene = x.scene();
    if (!walk(scene, y.path(), far)) return Rejection::WalkDiverged;
    y.path().measure_edge(scene, held.held_edge());
    const auto [first, last] = std::minmax(far.anchor, far.end);
    if (const auto why = complete(y, first, last, last_edge(far))) return why;
    if (!returns(scene, x.path(), y.path(), far)) return Rejection::NotReversible;
    log_reductions = log_reduction(scene, y.path(), far) - log_reduction(scene, x.path(), far);
    return std::nullopt;
  }

  double weight_;
};

}  // namespace

PathMutation make_switch(double weight) { return std::make_unique<Switch>(weight); }

}  // namespace fogbow
