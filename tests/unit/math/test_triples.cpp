// SPDX-License-Identifier: GPL-3.0-or-later
// The checker of triples finds planted faults: a check that cannot fail proves nothing.
#include <gtest/gtest.h>

#include "core/math/warp.h"
#include "tests/helpers/triples.h"

namespace fogbow::testing {
namespace {

/// Uniform on the hemisphere, with a wall of probability 0.3 that is a second lobe on the lower
/// one.
Triple two_lobes() {
  return {3,
          [](const Vec3& u) -> std::optional<Vec3> {
            const Vec3 w = warp::sample_hemisphere({u.y, u.z});
            return u.x < 0.3 ? -w : w;
          },
          [](const Vec3& w) { return (w.z < 0 ? 0.3 : 0.7) / (2 * kPi); },
          [](const Vec3& w, const Vec3& auxiliary) -> std::optional<Vec3> {
            const Vec2 u = warp::invert_hemisphere(w.z < 0 ? -w : w);
            const double lobe = w.z < 0 ? warp::invert_interval(0, 0.3, auxiliary.x)
                                        : warp::invert_interval(0.3, 1, auxiliary.x);
            return Vec3(lobe, u.x, u.y);
          }};
}

void expect_fault(const Triple& triple, const std::string& what,
                  const TripleOptions& options = {}) {
  const std::string found = check_triple("planted", triple, sphere_chart(), options);
  EXPECT_NE(found.find(what), std::string::npos) << "found only: " << found;
}

TEST(Triples, AcceptsACorrectTriple) {
  EXPECT_EQ(check_triple("two lobes", two_lobes(), sphere_chart()), "");
}

TEST(Triples, FindsAWrongDensity) {
  Triple triple = two_lobes();
  triple.pdf = [](const Vec3& w) { return (w.z < 0 ? 0.29 : 0.71) / (2 * kPi); };
  expect_fault(triple, "do not follow the density");
  triple.pdf = [](const Vec3& w) { return (w.z < 0 ? 0.3 : 0.7) / (2 * kPi) * 1.0001; };
  expect_fault(triple, "integrates to");
  triple.pdf = [](const Vec3& w) { return (1 + 0.05 * w.x) * (w.z < 0 ? 0.3 : 0.7) / (2 * kPi); };
  expect_fault(triple, "do not follow the density");
}

TEST(Triples, FindsLostSamples) {
  Triple triple = two_lobes();
  const auto whole = triple.sample;
  triple.sample = [whole](const Vec3& u) { return u.y < 0.01 ? std::nullopt : whole(u); };
  expect_fault(triple, "samples lost");
  expect_fault(triple, "do not follow the density", {.mass = {}});
}

TEST(Triples, FindsAWrongInverse) {
  Triple triple = two_lobes();
  triple.invert = [](const Vec3& w, const Vec3& auxiliary) -> std::optional<Vec3> {
    auto u = two_lobes().invert(w, auxiliary);
    u->y += 1e-9;
    return u;
  };
  expect_fault(triple, "is not x");
}

TEST(Triples, FindsAnAuxiliaryThatIsNotDrawn) {
  Triple triple = two_lobes();
  triple.invert = [](const Vec3& w, const Vec3&) { return two_lobes().invert(w, Vec3(0.5)); };
  expect_fault(triple, "u[0] of invert(sample(u)) is not uniform");
}

/// A fold: each w has two u, and the inverse must draw between them in proportion to their
/// densities.
TEST(Triples, FindsThePriorInPlaceOfThePosterior) {
  const auto cosine = [](const Vec3& w) { return warp::pdf_cosine_hemisphere(w); };
  const auto uniform = [](const Vec3& w) { return warp::pdf_hemisphere(w); };
  Triple mixture;
  mixture.dimensions = 3;
  mixture.sample = [](const Vec3& u) -> std::optional<Vec3> {
    return u.x < 0.5 ? warp::sample_cosine_hemisphere({u.y, u.z})
                     : warp::sample_hemisphere({u.y, u.z});
  };
  mixture.pdf = [=](const Vec3& w) { return 0.5 * (cosine(w) + uniform(w)); };
  const auto inverse = [=](bool posterior) {
    return [=](const Vec3& w, const Vec3& auxiliary) -> std::optional<Vec3> {
      if (!(w.z > 0)) return std::nullopt;
      const double p = posterior ? cosine(w) / (cosine(w) + uniform(w)) : 0.5;
      const bool first = auxiliary.y < p;
      const Vec2 u = first ? warp::invert_cosine_hemisphere(w) : warp::invert_hemisphere(w);
      return Vec3(0.5 * auxiliary.x + (first ? 0 : 0.5), u.x, u.y);
    };
  };
  mixture.invert = inverse(true);
  EXPECT_EQ(check_triple("mixture", mixture, sphere_chart()), "");
  mixture.invert = inverse(false);
  expect_fault(mixture, "not jointly uniform");
}

TEST(Integrate, ResolvesPeaksAndEdges) {
  const auto peak = [](const Vec2& x) {
    return std::exp(-0.5 * (sqr((x.x - 0.5) / 0.01) + sqr((x.y - 0.5) / 0.01)));
  };
  EXPECT_NEAR(integrate(peak, Vec2(0), Vec2(1), 1e-10), 2 * kPi * 1e-4, 1e-9);
  const auto disk = [](const Vec2& x) { return x.x * x.x + x.y * x.y < 1 ? 1.0 : 0.0; };
  EXPECT_NEAR(integrate(disk, Vec2(0), Vec2(1), 1e-9), kPi / 4, 1e-4);
}

}  // namespace
}  // namespace fogbow::testing
