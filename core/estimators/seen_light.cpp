// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>

#include "core/estimators/estimator.h"

namespace fogbow {

namespace {

/// Follows every specular event from the eye at once: there are few, and their light has no other
/// technique than to be run into.
class SeenLight final : public Estimator {
 public:
  SeenLight(const Scene& scene, const EstimatorSettings& settings)
      : scene_(scene),
        settings_(settings),
        max_vertices_(settings.max_depth + 1),
        glows_(std::ranges::any_of(scene.media(), [](const auto& m) { return m->emits(); })) {}
  const char* name() const override { return "seen light"; }

  void sample(SampleStream&, SampleStream& eye, Workspace& w) const override {
    w.contributions.clear();
    const Vec2 raster = eye.next2();
    Vertex x = sample_sensor(scene_, eye.next2());
    const Sensor& sensor = scene_.sensor();
    const SensorRay ray = sensor.sample_direction(x.position(), raster);
    x.point.position = ray.origin;
    const double importance =
        W_e(scene_, x, ray.w) * D(scene_, x, ray.w) / (ray.pdf_sigma * sensor.pdf_A(x.position()));
    const Way way{raster, importance, eye, w};
    go(way, x, ray.w, RGB(1), 2, sensor.near_distance(ray.w), sensor.far_distance(ray.w));
  }

 private:
  /// What all branches of one sample have in common.
  struct Way {
    Vec2 raster;
    double importance;
    SampleStream& u;
    Workspace& w;

    void add(const RGB& throughput, const RGB& radiance, int k, bool glow = false) const {
      w.add({raster, importance * throughput * radiance, k, 0, k, -1, glow});
    }
  };
  /// Branches with less than this part of what the ray started with are subject to roulette.
  static constexpr double kSplitting = 1.0 / 16;

  /// Along w from x to the vertex number k from the eye.
  void go(const Way& way, const Vertex& x, const Vec3& w, const RGB& throughput, int k,
          double near = 0, double far = kInfinity) const {
    if (glows_) see_glow(way, x, w, throughput, k, near, far);
    RGB behind(1);
    // Every surface that light passes in part is seen, and what lies behind it.
    for (int passages = 0; !is_black(behind); ++passages) {
      Vertex next;
      Edge edge;
      const ExtendResult result = extend_to_surface(scene_, x, w, next, edge, near, far, passages);
      const RGB arrived = throughput * edge.tau;
      if (result != ExtendResult::Reached) return see_sky(way, edge, arrived, k);
      if (hittable(scene_, next) && !settings_.hides(scene_, next, k))
        way.add(arrived, L_e(scene_, next, -w), k);
      behind = edge.tau * passage(scene_, next, w);
      if (k < max_vertices_) scatter(way, next, -w, arrived, k);
    }
  }

  /// One place on the ray, by a free flight that ends in a medium.
  void see_glow(const Way& way, const Vertex& x, const Vec3& w, const RGB& throughput, int k,
                double near, double far) const {
    thread_local RayProfile ray;
    ray.trace(scene_, x, w, near, far);
    const RGB ends = RGB(1) - ray.edge().tau_q;  // with these probabilities
    std::array<int, 3> channels;
    int count = 0;
    for (int c = 0; c < 3; ++c)
      if (ends[c] > 0) channels[count++] = c;
    if (count == 0) return;
    const int channel = channels[std::min(static_cast<int>(way.u.next() * count), count - 1)];
    const auto t = ray.distance(channel, way.u.next() * ends[channel]);
    if (!t) return;  // on a surface that light passes in part
    Edge edge;
    const Vertex place = ray.vertex(scene_, *t, edge);
    if (place.emitter < 0) return;
    const RGB sigma_t = place.medium->sigma_t(place.position());
    double q = 0;
    for (int i = 0; i < count; ++i) {
      const int c = channels[i];
      q += sigma_t[c] * edge.tau_q[c] / ends[c] / count;
    }
    if (q > 0) way.add(throughput * edge.tau / q, L_e(scene_, place, -w), k, true);
  }

  void see_sky(const Way& way, const Edge& edge, const RGB& throughput, int k) const {
    Vertex sky;
    if (!make_infinite_vertex(scene_, edge, sky)) return;
    for (const int emitter : scene_.infinite_emitters()) {
      sky.emitter = emitter;
      if (!settings_.hides(scene_, sky, k)) way.add(throughput, L_e(scene_, sky, -edge.w), k);
    }
  }

  void scatter(const Way& way, Vertex& x, const Vec3& from, const RGB& throughput, int k) const {
    x.degenerate = true;
    for (const bool transmit : {false, true}) {
      const auto w = specular_direction(scene_, x, from, transmit);
      if (!w) continue;
      // The formal density of an event that is certain: n² |cosθ| (bsdf.h).
      const double density =
          sqr(relative_index(scene_, x, *w)) * std::abs(dot(x.point.shading.n, *w));
      RGB branch = throughput * f_hat(scene_, x, *w, from, true) * (D(scene_, x, *w) / density);
      if (!is_finite(branch)) {
        ++way.w.refused;
        continue;
      }
      const double survival = max_component(branch) / kSplitting;
      if (!(survival > 0)) continue;
      if (survival < 1) {
        if (way.u.next() >= survival) continue;
        branch /= survival;
      }
      go(way, x, *w, branch, k + 1);
    }
  }

  const Scene& scene_;
  EstimatorSettings settings_;
  int max_vertices_;
  bool glows_;
};

}  // namespace

std::unique_ptr<Estimator> make_seen_light(const Scene& scene, const EstimatorSettings& settings) {
  return std::make_unique<SeenLight>(scene, settings);
}

}  // namespace fogbow
