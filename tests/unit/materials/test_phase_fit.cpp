// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "media/mie.h"
#include "media/phase_fit.h"
#include "tests/unit/materials/phase_cases.h"

namespace fogbow {
namespace {

/// rms of ln(a/b) over angles uniform in θ.
double log_distance(const PhaseFunction& a, const PhaseFunction& b) {
  constexpr int kAngles = 7200;
  double sum = 0;
  for (int i = 0; i < kAngles; ++i) {
    const double theta = kPi * (i + 0.5) / kAngles;
    const Vec3 from(0, 0, 1), to(std::sin(theta), 0, -std::cos(theta));
    sum += sqr(std::log(a.pdf_sigma(from, to) / b.pdf_sigma(from, to)));
  }
  return std::sqrt(sum / kAngles);
}

TEST(PhaseFit, FindsWhatItCanSay) {
  const auto original = make_blend_phase(make_henyey_greenstein(0.96), make_draine(0.55, 12), 0.4);
  const PhaseFit fit = fit_phase(*original);
  EXPECT_NEAR(fit.g_hg, 0.96, 1e-6);
  EXPECT_NEAR(fit.g_draine, 0.55, 1e-6);
  EXPECT_NEAR(fit.alpha, 12, 1e-4);
  EXPECT_NEAR(fit.weight, 0.4, 1e-6);
  EXPECT_LT(fit.error, 1e-8);
  EXPECT_LT(log_distance(*make_fitted_phase(fit), *original), 1e-7);
  const PhaseFit single = fit_phase(*make_henyey_greenstein(-0.3));
  EXPECT_NEAR(single.hg_alone, -0.3, 1e-7);
  EXPECT_LT(single.hg_error, 1e-8);
}

TEST(PhaseFit, StaysWithinItsBounds) {
  // A peak that is sharper than the bounds allow, and hardly anything besides.
  const auto table =
      make_table_phase({{0, 1e-9, 1e-8, 1, 2}, {RGB(1), RGB(1), RGB(1e-9), RGB(1e-9), RGB(1e-9)}});
  const PhaseFit fit = fit_phase(*table);
  EXPECT_LE(std::fabs(fit.g_hg), 0.9999);
  EXPECT_LE(std::fabs(fit.g_draine), 0.9999);
  EXPECT_TRUE(fit.alpha >= 0 && fit.alpha <= 1000);
  EXPECT_TRUE(fit.weight >= 0 && fit.weight <= 1);
  EXPECT_THROW(fit_phase(*make_tabulated_phase({1, 0, 0, 1})), std::domain_error);
}

/// Fog: two lobes come much closer than one. [Jendersie2023] gives such fits by diameter
/// (5 to 50 µm), made with other weights; ours must not be worse in our own measure.
TEST(PhaseFit, Fog) {
  for (const double radius : {4.0, 10.0}) {
    const auto table = make_table_phase(Droplets(water_droplets(radius, 0.2)).table());
    const PhaseFit fit = fit_phase(*table);
    EXPECT_NEAR(log_distance(*make_fitted_phase(fit), *table), fit.error, 0.02 * fit.error);
    EXPECT_NEAR(log_distance(*make_henyey_greenstein(fit.hg_alone), *table), fit.hg_error,
                0.02 * fit.hg_error);
    EXPECT_LT(fit.error, 0.5 * fit.hg_error);
    const double d = 2 * radius;
    const PhaseFit published{std::exp(-0.0990567 / (d - 1.67154)),
                             std::exp(-2.20679 / (d + 3.91029) - 0.428934),
                             std::exp(3.62489 - 8.29288 / (d + 5.52825)),
                             std::exp(-0.599085 / (d - 0.641583) - 0.665888),
                             0,
                             0,
                             0};
    const double theirs = log_distance(*make_fitted_phase(published), *table);
    EXPECT_LE(fit.error, theirs * 1.001);
    EXPECT_LT(theirs, 0.75 * fit.hg_error);
    std::printf(
        "r = %g µm: HG(%.4f) and %.4f of Draine(%.4f, %.4g): error %.3f; published fit %.3f; "
        "HG(%.4f) alone %.3f\n",
        radius, fit.g_hg, fit.weight, fit.g_draine, fit.alpha, fit.error, theirs, fit.hg_alone,
        fit.hg_error);
  }
}

}  // namespace
}  // namespace fogbow
