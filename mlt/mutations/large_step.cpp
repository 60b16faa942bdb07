// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/estimators/sampling.h"
#include "core/path/techniques.h"
#include "mlt/mutations/path_mutations.h"
#include "mlt/technique_distribution.h"

namespace fogbow {

namespace {

class LargeStep final : public Mutation<PathSample> {
 public:
  LargeStep(double weight, const TechniqueDistribution& techniques)
      : weight_(weight), techniques_(techniques) {}
  const char* name() const override { return "large_step"; }
  double selection_weight(const PathSample&) const override { return weight_; }
  bool independent() const override { return true; }

  Proposal propose(const PathSample& x, PathSample& y, Rng& rng) const override {
    const auto [s, t] = techniques_.sample(rng.uniform());
    thread_local Subpath light, eye;
    light.reserve(x.path().capacity());
    eye.reserve(x.path().capacity());
    if (const auto why = trace(x.scene(), s, t, rng, light, eye)) return refuse(*why);
    if (const auto why = y.assemble(light, s, eye, t)) return refuse(*why);
    const double forward = log_large_step_density(y, techniques_);
    return {log_large_step_density(x, techniques_) - forward, std::nullopt, forward};
  }

 private:
  static std::optional<Rejection> trace(const Scene& scene, int s, int t, Rng& rng, Subpath& light,
                                        Subpath& eye) {
    RandomStream u(rng);
    Vec2 raster;
    trace_eye_subpath(scene, u, t, eye, raster);
    if (static_cast<int>(eye.size()) < t) return Rejection::MissedScene;
    light.clear();
    if (s > 0) trace_light_subpath(scene, u, s, light);
    if (static_cast<int>(light.size()) < s) return Rejection::MissedScene;
    if (s > 0 && (!light[s - 1].connects || !eye[t - 1].connects || eye[t - 1].x.infinite()))
      return Rejection::WrongConfiguration;
    if (s > 0) return std::nullopt;
    if (t < 2 || !hittable(scene, eye[t - 1].x)) return Rejection::WrongConfiguration;
    choose_infinite_emitter(scene, eye[t - 1].x, rng);
    return std::nullopt;
  }

  double weight_;
  const TechniqueDistribution& techniques_;
};

}  // namespace

double log_large_step_density(const PathSample& y, const TechniqueDistribution& techniques) {
  const int k = y.path().size();
  return log_range_density(y.scene(), y.path(), {0, k}, techniques.probabilities(k));
}

PathMutation make_large_step(double weight, const TechniqueDistribution& techniques) {
  return std::make_unique<LargeStep>(weight, techniques);
}

}  // namespace fogbow
