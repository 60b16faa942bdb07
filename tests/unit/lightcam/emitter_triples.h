// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <gtest/gtest.h>

#include "core/scene/emitters.h"
#include "tests/helpers/triples.h"

namespace fogbow::testing {

/// Directions that leave one point of an emitter, as sample_direction, pdf_direction and
/// invert_direction.
inline Triple direction_triple(const Emitter& emitter, const EmitterPoint& x) {
  return {2,
          [&emitter, x](const Vec3& u) -> std::optional<Vec3> {
            const EmitterDirection d = emitter.sample_direction(x, Vec2(u));
            EXPECT_EQ(d.origin, x.surface.position);
            EXPECT_NEAR(d.pdf_direction, emitter.pdf_direction(x, d.w), 1e-12);
            return d.w;
          },
          [&emitter, x](const Vec3& w) { return emitter.pdf_direction(x, w); },
          [&emitter, x](const Vec3& w, const Vec3&) -> std::optional<Vec3> {
            const auto u = emitter.invert_direction(x, {w, x.surface.position, 0});
            if (!u) return std::nullopt;
            return Vec3(*u, 0);
          }};
}

/// An orthonormal frame that owes nothing to Frame's own construction.
inline Frame oblique_frame(const Vec3& n) {
  const Vec3 s = normalize(cross(n, Vec3(0.3, -0.7, 0.2)));
  return Frame(s, cross(n, s), n);
}

/// ∫ L_e |cosθ| dσ over all directions around n; cosine 1 where n is zero.
inline RGB emitted_flux_density(const Emitter& emitter, const EmitterPoint& x, const Vec3& n) {
  const Chart chart = sphere_chart(oblique_frame(length(n) > 0 ? n : Vec3(0, 0, 1)));
  RGB flux(0);
  for (int c = 0; c < 3; ++c)
    flux[c] = integrate(
        [&](const Vec2& p) {
          const Vec3 w = chart.point(p);
          return emitter.L_e(x, w)[c] * (length(n) > 0 ? std::fabs(dot(w, n)) : 1) *
                 chart.jacobian(p);
        },
        Vec2(0), Vec2(1), 1e-9);
  return flux;
}

inline void expect_near(const RGB& a, const RGB& b, double relative) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], relative * std::fabs(b[c]));
}

}  // namespace fogbow::testing
