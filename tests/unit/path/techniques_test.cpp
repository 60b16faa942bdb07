// SPDX-License-Identifier: GPL-3.0-or-later
// Subpaths cache factors and sum techniques by recursion; here both are held against the
// definitions in path.h.
#include <gtest/gtest.h>

#include <map>

#include "core/estimators/sampling.h"
#include "core/path/connection.h"
#include "core/path/path.h"
#include "core/path/specular_chain.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/test_scenes.h"

namespace fogbow {
namespace {

using testing::test_scenes;

/// Rounding grows with the number of factors; cancellation at grazing angles costs some digits
/// more.
constexpr double kTolerance = 1e-6;

class Techniques : public ::testing::TestWithParam<testing::TestScene> {
 protected:
  void SetUp() override { scene_ = std::make_unique<Scene>(GetParam().make()); }

  /// Calls check(path, s, connection) for every technique of `samples` pairs of subpaths.
  template <class Check>
  void for_each_connection(int samples, int max_vertices, Check&& check) {
    Subpath light, eye;
    for (int i = 0; i < samples; ++i) {
      Rng rng(testing::suite_seed(), RngDomain::Test, 1, i);
      RandomStream stream(rng);
      Vec2 raster;
      trace_eye_subpath(*scene_, stream, max_vertices, eye, raster);
      trace_light_subpath(*scene_, stream, max_vertices, light);
      for (int t = 1; t <= static_cast<int>(eye.size()); ++t) {
        if (const auto c = run_into_light(*scene_, eye, t))
          check(assemble(*scene_, light, 0, eye, t), 0, *c);
        for (int s = 1; s <= static_cast<int>(light.size()); ++s)
          if (const auto c = join(*scene_, light, s, eye, t))
            check(assemble(*scene_, light, s, eye, t), s, *c);
      }
    }
  }

  std::unique_ptr<Scene> scene_;
};

TEST_P(Techniques, ContributionIsFOverItsDensity) {
  int compared = 0;
  for_each_connection(3000, 7, [&](const Path& path, int s, const Connection& c) {
    const RGB expected = f(*scene_, path) / technique_density(*scene_, path, s);
    for (int channel = 0; channel < 3; ++channel)
      ASSERT_NEAR(c.value[channel], expected[channel], kTolerance * max_component(expected))
          << "s=" << s << " k=" << path.size();
    ++compared;
  });
  EXPECT_GT(compared, 1000);
}

TEST_P(Techniques, WeightIsTheBalanceHeuristic) {
  int compared = 0;
  for_each_connection(3000, 7, [&](const Path& path, int s, const Connection& c) {
    double sum = 0;
    for (int j = 0; j < static_cast<int>(path.size()); ++j)
      sum += technique_density(*scene_, path, j);
    ASSERT_NEAR(c.weight, technique_density(*scene_, path, s) / sum, kTolerance)
        << "s=" << s << " k=" << path.size();
    ++compared;
  });
  EXPECT_GT(compared, 1000);
}

TEST_P(Techniques, ReducedContributionFollowsFromTheTracedDensity) {
  // f/p is the same in both languages: for s = k − 1 vertices from the light, p of the reduced one
  // is built of real densities.
  int compared = 0;
  for_each_connection(6000, 7, [&](const Path& path, int s, const Connection& c) {
    if (path[0].infinite() && s == 0) return;  // the last edge has no length to reduce
    double chain_factor = 1;                   // p_s over its counterpart without deltas
    const auto chain = [&](int a, int step) {
      int b = a + step;
      double formal = 1, events = 1;
      for (; path[b].degenerate; b += step) {
        const Vec3 to = normalize(path[b + step].position() - path[b].position());
        const Vec3 from = path[b - step].parallel()
                              ? -path[b - step].point.n_g
                              : normalize(path[b - step].position() - path[b].position());
        // Sampling a Dirac event: probability P instead of P n² |cosθ| δ.
        events *=
            sqr(relative_index(*scene_, path[b], to)) * std::abs(dot(path[b].point.shading.n, to));
        formal *= D(*scene_, path[b], from);
        if (!path[b - step].parallel())
          formal /= glm::dot(path[b - step].position() - path[b].position(),
                             path[b - step].position() - path[b].position());
      }
      if (b == a + step) return;
      const double last = glm::dot(path[b].position() - path[b - step].position(),
                                   path[b].position() - path[b - step].position());
      chain_factor *= formal * events / last / chain_jacobian(*scene_, path, a, b);
    };
    const int k = static_cast<int>(path.size());
    for (int i = 0; i + 1 < s; ++i)
      if (!path[i].degenerate) chain(i, 1);
    for (int i = k - 1; i > s; --i)
      if (!path[i].degenerate && path[i - 1].degenerate) chain(i, -1);
    const RGB reduced =
        reduced_f(*scene_, path) / (technique_density(*scene_, path, s) / chain_factor);
    for (int channel = 0; channel < 3; ++channel)
      ASSERT_NEAR(reduced[channel], c.value[channel], 1e-5 * max_component(c.value))
          << "s=" << s << " k=" << path.size();
    ++compared;
  });
  EXPECT_GT(compared, 1000);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Techniques, ::testing::ValuesIn(test_scenes()),
                         [](const auto& info) {
                           std::string name = info.param.name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace fogbow
