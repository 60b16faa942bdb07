// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/path/specular_chain.h"

#include <gtest/gtest.h>

#include "tests/helpers/test_scenes.h"
#include "tests/unit/path/eye_chains.h"

namespace fogbow {
namespace {

/// Follows path[a]'s ray, turned by `offset`, through the same events to the plane across the last
/// ray at path[b].
std::optional<Vec3> retrace(const Scene& scene, const Path& path, int a, int b,
                            const Vec3& offset) {
  const int step = a < b ? 1 : -1;
  Vertex x = path[a];
  Vec3 w = normalize(normalize(path[a + step].position() - x.position()) + offset);
  for (int i = a + step; i != b; i += step) {
    const auto hit = scene.accel().intersect(Ray{x.position(), w}, x.id);
    if (!hit || hit->id.shape != path[i].id.shape) return std::nullopt;
    const SurfacePoint point = scene.surface_point(*hit);
    Vec3 N = point.shading.n;
    if (dot(w, N) > 0) N = -N;
    const Vec3 w_in_path = normalize(path[i - step].position() - path[i].position());
    const Vec3 w_out_path = normalize(path[i + step].position() - path[i].position());
    const bool reflects =
        dot(w_in_path, path[i].point.n_g) * dot(w_out_path, path[i].point.n_g) > 0;
    const double c = -dot(w, N);
    if (reflects) {
      w += 2 * c * N;
    } else {
      const double ratio =
          relative_index(scene, path[i], w_in_path) / relative_index(scene, path[i], w_out_path);
      w = ratio * w + (ratio * c - std::sqrt(1 - sqr(ratio) * (1 - c * c))) * N;
    }
    x.point = point;
    x.id = hit->id;
  }
  const Vec3 last = normalize(path[b].position() - path[b - step].position());
  return x.position() + dot(path[b].position() - x.position(), last) / dot(w, last) * w;
}

/// Every chain from non-degenerate a to non-degenerate b found in the scene's paths.
template <class Check>
void for_each_chain(const Scene& scene, int samples, Check&& check) {
  const auto degenerate = [](const Vertex& x) { return x.degenerate; };
  for (int i = 0; i < samples; ++i) testing::for_each_chain(scene, 2, i, degenerate, check);
}

class SpecularChain : public ::testing::TestWithParam<const char*> {};

TEST_P(SpecularChain, JacobianIsThatOfRetracedRays) {
  const Scene scene(testing::make_test_scene(GetParam()));
  int compared = 0;
  std::vector<double> errors;
  for_each_chain(scene, 3000, [&](const Path& path, int from, int to) {
    for (const auto& [a, b] : {std::pair(from, to), std::pair(to, from)}) {
      const int step = a < b ? 1 : -1;
      const Vec3 w = normalize(path[a + step].position() - path[a].position());
      const Vec3 w_last = normalize(path[b].position() - path[b - step].position());
      const Frame across(w);
      const double h = 1e-6;
      const auto s1 = retrace(scene, path, a, b, h * across.s);
      const auto s0 = retrace(scene, path, a, b, -h * across.s);
      const auto t1 = retrace(scene, path, a, b, h * across.t);
      const auto t0 = retrace(scene, path, a, b, -h * across.t);
      if (!s1 || !s0 || !t1 || !t0) continue;
      const double area = std::abs(dot(w_last, cross(*s1 - *s0, *t1 - *t0))) / (4 * h * h);
      errors.push_back(std::abs(chain_jacobian(scene, path, a, b) * area - 1));
      ++compared;
    }
  });
  ASSERT_GT(compared, 500);
  // The finite difference itself fails where it straddles an edge of the mesh or comes close to a
  // caustic.
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[errors.size() * 9 / 10], 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Scenes, SpecularChain,
                         ::testing::Values("glass-sphere-fog", "mirror-fog", "water",
                                           "fog-in-glass"),
                         [](const auto& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(SpecularChain, EtenduesOfBothDirectionsAreInTheRatioOfSquaredIndices) {
  // n_a² J_{a→b} = n_b² J_{b→a}: holds where shading normals are the surface's own.
  const Scene scene(testing::make_test_scene("fog-in-glass"));
  int compared = 0, refracting = 0;
  for_each_chain(scene, 3000, [&](const Path& path, int a, int b) {
    const auto index = [&](int end, int step) {
      double n = 1;  // relative to the other end: product over the chain's refractions
      for (int i = end + step; path[i].degenerate; i += step) {
        const Vec3 back = normalize(path[i - step].position() - path[i].position());
        const Vec3 on = normalize(path[i + step].position() - path[i].position());
        n *= relative_index(scene, path[i], back) / relative_index(scene, path[i], on);
      }
      return n;
    };
    const double n_ratio = index(a, 1);
    refracting += std::abs(n_ratio - 1) > 0.1;
    const double ratio = chain_jacobian(scene, path, a, b) / chain_jacobian(scene, path, b, a);
    ASSERT_NEAR(ratio * n_ratio * n_ratio, 1, 1e-6);
    ++compared;
  });
  EXPECT_GT(compared, 500);
  EXPECT_GT(refracting, 200);
}

}  // namespace
}  // namespace fogbow
