// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/estimators/estimator.h"
#include "core/path/connection.h"

namespace fogbow {

namespace {

/// Light that the eye subpath runs into at its t-th vertex; every infinite emitter is there at
/// once.
void add_emission(const Scene& scene, Workspace& w, int t, const Vec2& raster) {
  Vertex& x = w.eye[t - 1].x;
  const auto add = [&] {
    if (const auto c = run_into_light(scene, w.eye, t))
      w.add({raster, c->weight * c->value, t, 0, t, x.infinite() ? x.emitter : -1});
  };
  if (!x.infinite()) return add();
  for (const int emitter : scene.infinite_emitters()) {
    x.emitter = emitter;
    add();
  }
}

class Bdpt final : public Estimator {
 public:
  Bdpt(const Scene& scene, const EstimatorSettings& settings)
      : scene_(scene), settings_(settings), max_vertices_(settings.max_depth + 1) {}

  void sample(SampleStream& light, SampleStream& eye, Workspace& w) const override {
    w.contributions.clear();
    Vec2 raster;
    w.refused += !trace_eye_subpath(scene_, eye, max_vertices_, w.eye, raster);
    // Of the last vertex only the emission is used.
    w.refused += !trace_light_subpath(scene_, light, max_vertices_ - 1, w.light);
    const int eye_size = static_cast<int>(w.eye.size());
    const int light_size = static_cast<int>(w.light.size());
    bool specular = true;  // all vertices between the first and this
    for (int t = 1; t <= eye_size; ++t) {
      const Vertex& x = w.eye[t - 1].x;
      const bool left_out = (!settings_.seen_light && specular && hittable(scene_, x)) ||
                            settings_.hides(scene_, x, t);
      if (x.emitter >= 0 && t >= 2 && !left_out) add_emission(scene_, w, t, raster);
      specular = specular && (t == 1 || x.degenerate);
      for (int s = 1; s <= light_size && s + t <= max_vertices_; ++s) {
        const bool seen = s + t == 2 && hittable(scene_, w.light[0].x);
        if (seen && (!settings_.seen_light || settings_.hides(scene_, w.light[0].x, 2))) continue;
        const auto c = join(scene_, w.light, s, w.eye, t);
        if (c) w.add({t == 1 ? c->raster : raster, c->weight * c->value, s + t, s, t});
      }
    }
  }

  const char* name() const override { return "bdpt"; }

 private:
  const Scene& scene_;
  EstimatorSettings settings_;
  int max_vertices_;
};

/// Of all techniques that with t = 1, and alone: its weight is one.
class LightTracer final : public Estimator {
 public:
  LightTracer(const Scene& scene, const EstimatorSettings& settings)
      : scene_(scene), settings_(settings), max_vertices_(settings.max_depth + 1) {}

  void sample(SampleStream& light, SampleStream& eye, Workspace& w) const override {
    w.contributions.clear();
    Vec2 raster;
    trace_eye_subpath(scene_, eye, 1, w.eye, raster);
    w.refused += !trace_light_subpath(scene_, light, max_vertices_ - 1, w.light);
    for (int s = 1; s <= static_cast<int>(w.light.size()); ++s) {
      if (settings_.hides(scene_, w.light[0].x, s + 1)) continue;
      const auto c = join(scene_, w.light, s, w.eye, 1);
      if (c) w.add({c->raster, c->value, s + 1, s, 1});
    }
  }

  const char* name() const override { return "light"; }

 private:
  const Scene& scene_;
  EstimatorSettings settings_;
  int max_vertices_;
};

}  // namespace

std::unique_ptr<Estimator> make_bdpt(const Scene& scene, const EstimatorSettings& settings) {
  return std::make_unique<Bdpt>(scene, settings);
}

std::unique_ptr<Estimator> make_light_tracer(const Scene& scene,
                                             const EstimatorSettings& settings) {
  return std::make_unique<LightTracer>(scene, settings);
}

}  // namespace fogbow
