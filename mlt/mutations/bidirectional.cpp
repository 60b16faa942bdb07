// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>

#include "core/estimators/sampling.h"
#include "core/path/techniques.h"
#include "mlt/mutations/path_mutations.h"
#include "mlt/mutations/retrace.h"

namespace fogbow {

namespace {

/// Longest range that is deleted or inserted, and how far their sizes may differ.
constexpr int kLongest = 6, kMostChange = 3;

/// Weight of deleting d vertices: short ranges mostly.
double deletion_weight(int d) {
  constexpr double kWeights[kLongest + 1] = {0.15, 0.3, 0.25, 0.15, 0.08, 0.04, 0.03};
  return kWeights[d];
}

/// The same of inserting n where d were deleted; nothing must not be replaced by nothing.
double insertion_weight(int d, int n) {
  constexpr double kWeights[kMostChange + 1] = {1, 0.3, 0.1, 0.03};
  return d == 0 && n == 0 ? 0.0 : kWeights[std::abs(n - d)];
}

/// A choice between first … last in proportion to weight(i).
class Choice {
 public:
  template <class Weight>
  Choice(int first, int last, Weight weight) : first_(first), last_(last) {
    for (int i = first; i <= last; ++i) total_ += weights_[i] = weight(i);
  }
  int sample(double u) const {
    u *= total_;
    int i = first_;
    while (i < last_ && u >= weights_[i]) u -= weights_[i++];
    return i;
  }
  double probability(int i) const { return weights_[i] / total_; }

 private:
  int first_, last_;
  std::array<double, kLongest + 1> weights_{};
  double total_ = 0;
};

class Bidirectional final : public Mutation<PathSample> {
 public:
  Bidirectional(double weight, int max_vertices) : weight_(weight), max_vertices_(max_vertices) {}
  const char* name() const override { return "bidirectional"; }
  double selection_weight(const PathSample&) const override { return weight_; }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const int k = x.path().size();
    const int d = deletion(k).sample(rng.uniform());
    const int s = static_cast<int>(rng.uniform() * (k - d + 1)), t = k - d - s;
    const int n = insertion(k, d).sample(rng.uniform());
    // Nothing follows the sensor, and no light that is a point or infinite scatters.
    const bool light_is_inside = s + n > 0 && t == k;
    if (k - d + n < 2 || (d == 0 && n == 0) || s == k ||
        (light_is_inside && !scatters(x.path()[0])))
      return refuse(Rejection::WrongConfiguration);
    const int from_light = static_cast<int>(rng.uniform() * (n + 1));
    keep(x.path(), s, t, n, y.path());
    if (const auto why = grow(y, s, t, from_light, rng)) return refuse(*why);
    // The record (s, t) is the same both ways, and its probability a factor of T.
    return {log_density(x, {s, s + d}, n) - log_density(y, {s, s + n}, d), std::nullopt};
  }

 private:
  static bool scatters(const Vertex& x) { return x.on_surface() || x.in_medium(); }
  static Choice deletion(int k) { return Choice(0, std::min(k, kLongest), deletion_weight); }
  Choice insertion(int k, int d) const {
    const int most = std::min({d + kMostChange, kLongest, max_vertices_ - (k - d)});
    return Choice(std::max(d - kMostChange, 0), most,
                  [d](int n) { return insertion_weight(d, n); });
  }

  /// T of the range of y, where `deleted` vertices were before.
  double log_density(const PathSample& y, Range range, int deleted) const {
    const int n = range.size(), k = y.path().size() - n + deleted;
    const double choices = deletion(k).probability(deleted) / (k - deleted + 1) *
                           insertion(k, deleted).probability(n) / (n + 1);
    std::array<double, kLongest + 1> splits;
    splits.fill(choices);
    return log_range_density(y.scene(), y.path(), range, std::span(splits).first(n + 1));
  }

  /// x's first s and last t vertices with room for n between them.
  static void keep(const MeasuredPath& x, int s, int t, int n, MeasuredPath& y) {
    y.resize(s + n + t);
    y.copy(x, 0, 0, s);
    y.copy(x, x.size() - t, s + n, t);
  }

  /// Vertices from both ends of the gap, and the edge between them.
  static std::optional<Rejection> grow(PathSample& sample, int s, int t, int from_light, Rng& rng) {
    const Scene& scene = sample.scene();
    MeasuredPath& y = sample.path();
    const int joint = s + from_light;  // first vertex on the eye's side
    if (joint >= y.size()) return Rejection::WrongConfiguration;
    for (int i = s; i < joint; ++i)
      if (!grow_vertex(scene, y, i, Side::Light, rng)) return Rejection::MissedScene;
    for (int i = y.size() - t - 1; i >= joint; --i)
      if (!grow_vertex(scene, y, i, Side::Eye, rng)) return Rejection::MissedScene;
    for (const int end : {joint - 1, joint}) {
      if (end < 0) continue;
      const bool fits = joint == 0 ? hittable(scene, y[0]) : connectible(scene, y[end]);
      if (!fits || (joint > 0 && end == joint && y[end].infinite()))
        return Rejection::WrongConfiguration;
      y.vertex(end).degenerate = false;
    }
    if (!joinable(scene, y, joint)) return Rejection::WrongConfiguration;
    if (joint > 0) y.aim(scene, joint - 1);
    // Roulette at a vertex looks at the next on the eye's side: one more on the light's.
    const int first = std::max(s - 2, 0), last = std::min(y.size() - t, y.last());
    return complete(sample, first, last, joint - 1);
  }

  /// y[i] from its neighbour on the side given.
  static bool grow_vertex(const Scene& scene, MeasuredPath& y, int i, Side side, Rng& rng) {
    RandomStream u(rng);
    const bool eye = side == Side::Eye;
    const int from = eye ? i + 1 : i - 1;
    if (from < 0) {
      SubpathVertex start;
      if (!sample_emitter(scene, u, start)) return false;
      y.vertex(i) = start.x;
      return true;
    }
    if (from == y.size()) {
      y.vertex(i) = sample_sensor(scene, u.next2());
      return true;
    }
    Step step;
    if (from == 0 || from == y.last()) {
      const Vec2 u_direction = u.next2(), u_distance = u.next2();
      if (!(eye ? leave_sensor(scene, y.vertex(from), u_direction, u_distance, step)
                : leave_emitter(scene, y[from], u_direction, u_distance, step)))
        return false;
    } else {
      const Vec3 back = eye ? y.to_eye(from) : y.to_light(from);
      const auto sample =
          leave_vertex(scene, y[from], back, side, eye && y[from + 1].degenerate, u, step);
      if (!sample) return false;
      y.vertex(from).degenerate = sample->degenerate;
    }
    y.vertex(i) = step.next;
    y.set_edge(std::min(i, from), eye ? reversed(step.edge) : step.edge);
    if (i == 0) choose_infinite_emitter(scene, y.vertex(0), u);
    return i == 0 || !step.next.infinite();
  }

  double weight_;
  int max_vertices_;
};

}  // namespace

PathMutation make_bidirectional(double weight, int max_vertices) {
  return std::make_unique<Bidirectional>(weight, max_vertices);
}

}  // namespace fogbow
