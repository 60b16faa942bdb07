// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>

#include "core/math/random.h"
#include "core/scene/emitters.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/lightcam/emitter_triples.h"

namespace fogbow {
namespace {

const Bounds kBounds{Vec3(-1, 2, 0), Vec3(3, 4, 1)};
constexpr int kCells = 8;

/// Emission that grows along x; nothing else of a medium is asked for.
class GlowingMedium final : public Medium {
 public:
  GlowingMedium() : Medium(nullptr) {}
  RGB sigma_t(const Vec3&) const override { return RGB(1); }
  RGB sigma_s(const Vec3&) const override { return RGB(0); }
  RGB emission(const Vec3& p) const override { return RGB(2 + p.x, 5, 0); }
  bool scatters() const override { return false; }
  bool emits() const override { return true; }
  RGB optical_depth(const Ray&, double t0, double t1) const override { return RGB(t1 - t0); }
  FlightEnd fly(const Ray&, double, double t1, int, double) const override { return {t1, false}; }
  RGB max_emission(const Bounds& box) const override { return RGB(2 + box.hi.x, 5, 0); }
  Majorant majorant(const Ray&, double, double t1) const override { return {t1, 1}; }
};

EmitterPoint at(const Vec3& p) {
  EmitterPoint x;
  x.surface.position = p;
  return x;
}

class VolumeEmitterTest : public ::testing::Test {
 protected:
  /// The medium fills the part of the bounds left of x = 1.5, five of eight cells.
  std::shared_ptr<const Medium> medium_ = std::make_shared<GlowingMedium>();
  std::shared_ptr<Emitter> emitter_ = make_volume_emitter(
      medium_, kBounds, [this](const Vec3& p) { return p.x < 1.5 ? medium_.get() : nullptr; });
};

TEST_F(VolumeEmitterTest, PositionsAreUniformInTheMediumAndLostOutside) {
  constexpr int kSamples = 200000;
  EXPECT_EQ(emitter_->kind(), EmitterKind::Volume);
  std::vector<std::uint64_t> observed(kCells * kCells * kCells + 1);
  std::vector<double> expected(observed.size(), 0.0);
  const double volume = 8;
  Rng rng(testing::suite_seed(), RngDomain::Test, 810, 0);
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 u = uniform3(rng);
    const auto x = emitter_->sample_position(u);
    if (!x) {
      ++observed.back();
      continue;
    }
    EXPECT_DOUBLE_EQ(x->pdf_position, 1 / volume);
    EXPECT_EQ(emitter_->pdf_position(*x), x->pdf_position);
    const Vec3 cell = glm::floor((x->surface.position - kBounds.lo) / kBounds.diagonal() * 8.0);
    ++observed[static_cast<int>((cell.x * kCells + cell.y) * kCells + cell.z)];
    const auto inverse = emitter_->invert_position(*x, Vec3(0.5));
    ASSERT_TRUE(inverse);
    EXPECT_LT(length(*inverse - u), 1e-15);
    EXPECT_LT(length(emitter_->sample_position(*inverse)->surface.position - x->surface.position),
              4e-15);
  }
  for (int i = 0; i < kCells; ++i)
    for (int j = 0; j < kCells * kCells; ++j)
      expected[i * kCells * kCells + j] = i < 5 ? kSamples / 512.0 : 0.0;
  expected.back() = kSamples * 3 / 8.0;
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_TRUE(expected[i] > 0 || observed[i] == 0) << i;
  EXPECT_GT(testing::chi2_test(observed, expected), testing::kSuiteFalseAlarm);
}

TEST_F(VolumeEmitterTest, HasNoDensityOutsideItsBounds) {
  for (const Vec3& p : {Vec3(-1.01, 3, 0.5), Vec3(0, 4.01, 0.5), Vec3(0, 3, -0.01)}) {
    EXPECT_EQ(emitter_->pdf_position(at(p)), 0);
    EXPECT_FALSE(emitter_->invert_position(at(p), Vec3(0.5)));
  }
}

TEST_F(VolumeEmitterTest, DirectionsAreATriple) {
  const EmitterPoint x = at(Vec3(0, 3, 0.5));
  EXPECT_EQ(testing::check_triple(
                "volume directions", testing::direction_triple(*emitter_, x),
                testing::sphere_chart(testing::oblique_frame(normalize(Vec3(1, 1, 2))))),
            "");
}

TEST_F(VolumeEmitterTest, EmitsWhatTheMediumEmitsThere) {
  const EmitterPoint x = at(Vec3(0.5, 3, 0.5));
  EXPECT_EQ(emitter_->L_e(x, Vec3(0, 0, 1)), RGB(2.5, 5, 0));
  testing::expect_near(testing::emitted_flux_density(*emitter_, x, Vec3(0)),
                       4 * kPi * RGB(2.5, 5, 0), 1e-9);
  // The mean of a linear emission over the bounds is that at their centre.
  testing::expect_near(emitter_->power(), 4 * kPi * 8 * RGB(3, 5, 0), 1e-12);
}

/// Emission in proportion to x² where x > 0, and none elsewhere.
class Patchy final : public Medium {
 public:
  Patchy() : Medium(nullptr) {}
  RGB sigma_t(const Vec3&) const override { return RGB(1); }
  RGB sigma_s(const Vec3&) const override { return RGB(0); }
  RGB emission(const Vec3& p) const override { return RGB(sqr(std::max(p.x, 0.0))); }
  bool scatters() const override { return false; }
  bool emits() const override { return true; }
  bool is_heterogeneous() const override { return true; }
  RGB optical_depth(const Ray&, double t0, double t1) const override { return RGB(t1 - t0); }
  FlightEnd fly(const Ray&, double, double t1, int, double) const override { return {t1, false}; }
  RGB max_emission(const Bounds& box) const override { return emission(box.hi); }
  Majorant majorant(const Ray&, double, double t1) const override { return {t1, 1}; }
};

/// Positions are spread as the emission is bounded: their density integrates to one, is what
/// samples show, and nowhere zero where there is light.
TEST(HeterogeneousVolumeEmitter, PositionsFollowTheEmission) {
  const auto medium = std::make_shared<Patchy>();
  const auto emitter =
      make_volume_emitter(medium, kBounds, [&](const Vec3&) { return medium.get(); });
  constexpr int kSamples = 200000, kSlabs = 32;
  Rng rng(testing::suite_seed(), RngDomain::Test, 811, 0);
  std::vector<std::uint64_t> observed(kSlabs * 8);
  std::vector<double> expected(observed.size(), 0.0);
  const auto cell = [](const Vec3& p) {
    const Vec3 u = (p - kBounds.lo) / kBounds.diagonal();
    return static_cast<int>(u.x * kSlabs) * 8 + (u.y < 0.5 ? 0 : 4) + static_cast<int>(4 * u.z);
  };
  double light = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vec3 u = uniform3(rng);
    const auto x = emitter->sample_position(u);
    ASSERT_TRUE(x);
    EXPECT_EQ(emitter->pdf_position(*x), x->pdf_position);
    ++observed[cell(x->surface.position)];
    light += mean(emitter->L_e(*x, Vec3(1, 0, 0))) / x->pdf_position / kSamples;
    const auto inverse = emitter->invert_position(*x, Vec3(0.5));
    ASSERT_TRUE(inverse);
    EXPECT_LT(length(*inverse - u), 1e-12);
    EXPECT_LT(length(emitter->sample_position(*inverse)->surface.position - x->surface.position),
              1e-11);
  }
  // The density is the same all over each slab.
  for (int i = 0; i < kSlabs * 8; ++i) {
    const Vec3 u((i / 8 + 0.5) / kSlabs, i % 8 < 4 ? 0.25 : 0.75, (i % 4 + 0.5) / 4);
    const Vec3 p = kBounds.lo + u * kBounds.diagonal();
    const double pdf = emitter->pdf_position(at(p));
    EXPECT_TRUE(pdf > 0 || is_black(medium->emission(p)));
    expected[i] = kSamples * pdf * 8 / (kSlabs * 8);
  }
  EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), kSamples, 1e-6);
  EXPECT_GT(testing::chi2_test(observed, expected), testing::kSuiteFalseAlarm);
  // ∫x² over x in (0, 3), times two of area; its estimate varies by less than a part in ten.
  EXPECT_NEAR(light, 2 * 9, 5 * 0.1 * 18 / std::sqrt(kSamples));
}

TEST_F(VolumeEmitterTest, NeedsAVolume) {
  const auto anywhere = [](const Vec3&) -> const Medium* { return nullptr; };
  const Bounds flat{Vec3(0), Vec3(1, 1, 0)}, endless{Vec3(0), Vec3(1, 1, kInfinity)};
  EXPECT_THROW(make_volume_emitter(medium_, flat, anywhere), std::domain_error);
  EXPECT_THROW(make_volume_emitter(medium_, endless, anywhere), std::domain_error);
  EXPECT_THROW(make_volume_emitter(medium_, Bounds(), anywhere), std::domain_error);
}

}  // namespace
}  // namespace fogbow
