// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "media/media.h"
#include "tests/unit/materials/phase_cases.h"

namespace fogbow {
namespace {

using testing::phase_triple;

const Vec3 kFroms[] = {{0, 0, 1}, {0, 0, -1}, normalize(Vec3(0.3, -0.7, 0.2))};

TEST(PhaseFunction, IsotropicTriple) {
  for (const Vec3& from : kFroms)
    EXPECT_EQ(testing::check_triple("isotropic", phase_triple(make_isotropic_phase(), from),
                                    testing::sphere_chart()),
              "");
}

TEST(PhaseFunction, HenyeyGreensteinTriples) {
  for (const double g : {-0.99, -0.6, -1e-12, 0.0, 1e-8, 0.5, 0.85, 0.99})
    for (const Vec3& from : kFroms) {
      const Frame peak(g < 0 ? from : -from);
      EXPECT_EQ(testing::check_triple("HG " + std::to_string(g),
                                      phase_triple(make_henyey_greenstein(g), from),
                                      testing::lobe_chart(peak, std::pow(1 - std::fabs(g), 1.5))),
                "");
    }
}

TEST(PhaseFunction, RayleighTriple) {
  for (const Vec3& from : kFroms)
    EXPECT_EQ(testing::check_triple("Rayleigh", phase_triple(make_rayleigh_phase(), from),
                                    testing::sphere_chart(Frame(from))),
              "");
}

TEST(PhaseFunction, DraineTriples) {
  const Vec2 cases[] = {{0, 1},    {1e-9, 0.5}, {0.001, 300}, {0.6, 0},   {0.8, 1},
                        {0.8, 40}, {0.99, 5},   {-0.7, 1},    {-0.95, 30}};  // g, α
  const Vec3 from = kFroms[2];
  for (const Vec2& c : cases) {
    const Frame peak(c.x < 0 ? from : -from);
    EXPECT_EQ(testing::check_triple("Draine " + std::to_string(c.x) + " " + std::to_string(c.y),
                                    phase_triple(make_draine(c.x, c.y), from),
                                    testing::lobe_chart(peak, std::pow(1 - std::fabs(c.x), 1.5))),
              "");
  }
}

/// The laws that it holds as special cases, and the formula itself.
TEST(PhaseFunction, DraineValues) {
  const auto plain = make_draine(0.7, 0), hg = make_henyey_greenstein(0.7);
  const auto gas = make_draine(0, 1), rayleigh = make_rayleigh_phase();
  for (const Vec3& a : kFroms)
    for (const Vec3& b : kFroms) {
      EXPECT_DOUBLE_EQ(plain->pdf_sigma(a, b), hg->pdf_sigma(a, b));
      EXPECT_DOUBLE_EQ(gas->pdf_sigma(a, b), rayleigh->pdf_sigma(a, b));
    }
  const double mu = 0.3, g = -0.4, alpha = 2.5;
  const Vec3 to(std::sqrt(1 - mu * mu), 0, -mu);
  EXPECT_NEAR(make_draine(g, alpha)->f_p({0, 0, 1}, to).z,
              (1 - g * g) * (1 + alpha * mu * mu) / (1 + alpha * (1 + 2 * g * g) / 3) /
                  (4 * kPi * std::pow(1 + g * g - 2 * g * mu, 1.5)),
              1e-14);
}

TEST(PhaseFunction, BlendTriples) {
  const auto forward = make_henyey_greenstein(0.8), backward = make_henyey_greenstein(-0.5);
  const auto partly_black = make_tabulated_phase({1, 0, 0, 3});
  const std::pair<const char*, std::shared_ptr<const PhaseFunction>> cases[] = {
      {"blend 0", make_blend_phase(forward, backward, 0)},
      {"blend 1", make_blend_phase(forward, backward, 1)},
      {"blend 0.3", make_blend_phase(forward, backward, 0.3)},
      {"blend with a table", make_blend_phase(partly_black, backward, 0.6)},
      {"blend of the same", make_blend_phase(partly_black, partly_black, 0.5)},
      {"blend of blends", make_blend_phase(make_blend_phase(forward, make_rayleigh_phase(), 0.7),
                                           make_blend_phase(partly_black, backward, 0.2), 0.55)}};
  const Vec3 from = kFroms[2];
  for (const auto& [name, phase] : cases)
    EXPECT_EQ(testing::check_triple(name, phase_triple(phase, from),
                                    testing::lobe_chart(Frame(-from), 2.0 / 3)),
              "");
}

TEST(PhaseFunction, TableTriples) {
  const std::vector<double> tables[] = {
      {1, 1}, {0, 1}, {0.5, 1, 1.5}, {0, 0, 1, 1, 0}, {2, 0, 3, 0, 0, 7, 0, 40}, {5, 1, 0, 0}};
  const Vec3 from = kFroms[2];
  for (const auto& values : tables) {
    testing::Chart chart = testing::sphere_chart(Frame(-from));
    chart.columns = 4 * static_cast<int>(values.size() - 1);  // knots are grid lines
    EXPECT_EQ(testing::check_triple("table of " + std::to_string(values.size()),
                                    phase_triple(make_tabulated_phase(values), from), chart),
              "");
  }
}

/// What is evaluated at once is what is evaluated one by one, from either side.
TEST(PhaseFunction, EvaluateAnswersBothWhicheverWayLightGoes) {
  const PhaseTable colours{{0, 0.5, 2}, {RGB(9, 8, 7), RGB(1, 0, 0.5), RGB(0, 9, 1)}};
  const std::shared_ptr<const PhaseFunction> phases[] = {
      make_isotropic_phase(),
      make_henyey_greenstein(0.7),
      make_rayleigh_phase(),
      make_draine(0.5, 2),
      make_blend_phase(make_henyey_greenstein(0.9), make_rayleigh_phase(), 0.3),
      make_tabulated_phase({0.5, 1, 1.5}),
      make_table_phase(colours)};
  for (const auto& phase : phases)
    for (const Vec3& a : kFroms)
      for (const Vec3& b : kFroms) {
        const PhaseValue there = phase->evaluate(a, -b), back = phase->evaluate(-b, a);
        EXPECT_EQ(there.f_p, phase->f_p(a, -b));
        EXPECT_EQ(there.pdf_sigma, phase->pdf_sigma(a, -b));
        EXPECT_EQ(back.f_p, there.f_p);
        EXPECT_EQ(back.pdf_sigma, there.pdf_sigma);
      }
}

TEST(PhaseFunction, TableWithAChannelThatNeverScattersBack) {
  PhaseTable table{
      {0, 0.01, 0.5, 1.9, 2},
      {RGB(100, 90, 80), RGB(9, 8, 7), RGB(1, 0, 0.5), RGB(0, 0.1, 0.5), RGB(0, 9, 1)}};
  const auto phase = make_table_phase(table);
  for (const Vec3& from : kFroms) {
    testing::Chart chart = testing::lobe_chart(Frame(-from), 0.01);
    EXPECT_EQ(testing::check_triple("RGB table", phase_triple(phase, from), chart), "");
    for (const Vec3& to : kFroms)
      EXPECT_NEAR(mean(phase->f_p(from, to)), phase->pdf_sigma(from, to), 1e-13);
  }
  // Values at the knots keep their ratios; every channel is one in all.
  const RGB ahead = phase->f_p(kFroms[0], -kFroms[0]), behind = phase->f_p(kFroms[0], kFroms[0]);
  EXPECT_EQ(behind.x, 0);
  EXPECT_NEAR(ahead.y / behind.y, 10, 1e-12);
  EXPECT_NEAR(ahead.z / behind.z, 80, 1e-12);
  EXPECT_NEAR(ahead.x, 100 / (2 * kPi * (0.545 + 2.45 + 0.7)), 1e-12);
}

/// Moments by quadrature over the engine's own values: norm 1, mean cosine, second Legendre
/// moment.
void expect_moments(const PhaseFunction& phase, double peak_width, double mean_cosine,
                    double second) {
  const Vec3 from = kFroms[2];
  const testing::Chart chart = testing::lobe_chart(Frame(-from), peak_width);
  double moment[3] = {0, 0, 0};
  for (int i = 0; i < 32; ++i)
    for (int m = 0; m < 3; ++m)
      moment[m] += testing::integrate(
          [&](const Vec2& c) {
            const Vec3 to = chart.point(c);
            const double mu = -dot(from, to);
            const double legendre = m == 0 ? 1 : (m == 1 ? mu : 0.5 * (3 * mu * mu - 1));
            return phase.f_p(from, to).y * legendre * chart.jacobian(c);
          },
          Vec2(i / 32.0, 0), Vec2((i + 1) / 32.0, 1), 1e-10);
  EXPECT_NEAR(moment[0], 1, 1e-7);
  EXPECT_NEAR(moment[1], mean_cosine, 1e-7);
  EXPECT_NEAR(moment[2], second, 1e-7);
  EXPECT_NEAR(phase.mean_cosine(), mean_cosine, 1e-14);
}

TEST(PhaseFunction, Moments) {
  for (const double g : {-0.9, -0.3, 1e-10, 0.4, 0.8, 0.95})
    expect_moments(*make_henyey_greenstein(g), g > 0 ? 1 - g : 0.9, g, g * g);
  expect_moments(*make_rayleigh_phase(), 0.5, 0, 0.1);
  // Draine: μ³ = (2P₃ + 3P₁)/5 and μ⁴ = (8P₄ + 20P₂ + 7)/35, and P_l has the mean g^l in HG.
  const double g = 0.6, a = 3, norm = 1 + a * (1 + 2 * g * g) / 3;
  const double fourth = (8 * std::pow(g, 4) + 20 * g * g + 7) / 35, square = (2 * g * g + 1) / 3;
  expect_moments(*make_draine(g, a), 0.4, (g + a * (2 * g * g * g + 3 * g) / 5) / norm,
                 (g * g + a * (1.5 * fourth - 0.5 * square)) / norm);
  // ∫μ(1 + μ)/2 dμ = 1/3 and ∫P₂(1 + μ)/2 dμ = 0; |μ| has ∫P₂|μ| dμ = 1/4.
  expect_moments(*make_tabulated_phase({0, 1}), 0.5, 1.0 / 3, 0);
  expect_moments(*make_tabulated_phase({1, 0, 1}), 1, 0, 0.25);
  // No symmetry: 2μ from 0 to 1.
  expect_moments(*make_tabulated_phase({0, 0, 1}), 1, 2.0 / 3, 0.25);
  expect_moments(*make_blend_phase(make_henyey_greenstein(0.8), make_rayleigh_phase(), 0.25), 0.2,
                 0.6, 0.75 * 0.64 + 0.025);
}

TEST(PhaseFunction, LightGoesOnStraightForPositiveG) {
  const auto forward = make_henyey_greenstein(0.9);
  const Vec3 from = kFroms[2];
  EXPECT_NEAR(forward->f_p(from, -from).x, 1.9 / (4 * kPi * 0.01), 1e-10);
  EXPECT_NEAR(forward->f_p(from, from).x, 0.1 / (4 * kPi * sqr(1.9)), 1e-15);
}

TEST(PhaseFunction, Reciprocity) {
  const auto hg = make_henyey_greenstein(-0.7), table = make_tabulated_phase({3, 1, 2, 9});
  for (const auto& phase : {hg, table, make_rayleigh_phase(), make_blend_phase(hg, table, 0.3)})
    for (const Vec3& a : kFroms)
      for (const Vec3& b : kFroms) EXPECT_EQ(phase->f_p(a, b), phase->f_p(b, a));
}

TEST(PhaseFunction, RefusesWhatItCannotMean) {
  for (const double g : {1.0, -1.0, 2.0, std::nan("")}) {
    EXPECT_THROW(make_henyey_greenstein(g), std::domain_error);
    EXPECT_THROW(make_draine(g, 1), std::domain_error);
  }
  for (const double alpha : {-0.1, kInfinity, std::nan("")})
    EXPECT_THROW(make_draine(0.5, alpha), std::domain_error);
  for (const double weight : {-0.1, 1.1, std::nan("")})
    EXPECT_THROW(make_blend_phase(make_isotropic_phase(), make_isotropic_phase(), weight),
                 std::domain_error);
  const std::vector<double> tables[] = {
      {}, {1}, {0, 0}, {1, -1}, {1, std::nan("")}, {1, kInfinity}};
  for (const auto& values : tables) EXPECT_THROW(make_tabulated_phase(values), std::domain_error);
  EXPECT_THROW(make_table_phase({{0, 1, 1, 2}, std::vector<RGB>(4, RGB(1))}), std::domain_error);
  EXPECT_THROW(make_table_phase({{0, 1}, std::vector<RGB>(2, RGB(1))}), std::domain_error);
  EXPECT_THROW(make_table_phase({{0, 2}, std::vector<RGB>(2, RGB(1, 0, 1))}), std::domain_error);
}

/// Mitsuba 3.9.1 (scalar_rgb, single precision): PhaseFunction.eval_pdf of what load_dict makes of
/// {'type': 'rayleigh'} and so on, at wi = (0, 0, 1) and wo with cosine −cosθ to it.
TEST(PhaseFunction, ValuesOfMitsuba) {
  struct Group {
    std::shared_ptr<const PhaseFunction> phase;
    std::vector<Vec2> values;  // cosθ of scattering, value
  };
  const auto hg = make_henyey_greenstein(0.8), rayleigh = make_rayleigh_phase();
  const auto nested = make_blend_phase(make_isotropic_phase(), make_henyey_greenstein(-0.5), 0.5);
  const Group groups[] = {
      {rayleigh,  // rayleigh
       {{-1, 0.1193662},
        {-0.9, 0.1080264},
        {-0.35, 0.06699427},
        {-0.1, 0.06027993},
        {0.2, 0.06207042},
        {0.7, 0.08892782},
        {0.95, 0.1135471},
        {1, 0.1193662}}},
      {make_tabulated_phase({0.5, 1, 1.5}),  // tabphase, values='0.5, 1.0 1.5'
       {{-1, 0.03978873},
        {-0.9, 0.04376761},
        {-0.35, 0.06565141},
        {-0.1, 0.0755986},
        {0.2, 0.08753522},
        {0.7, 0.1074296},
        {0.95, 0.1173768},
        {1, 0.1193662}}},
      {make_tabulated_phase({3, 0, 0, 0.25, 7, 11}),  // tabphase, values='3, 0, 0, 0.25, 7, 11'
       {{-1, 0.08376576},
        {-0.9, 0.06282431},
        {-0.35, 0},
        {-0.1, 0.00174512},
        {0.2, 0.00698048},
        {0.7, 0.2233754},
        {0.95, 0.2931801},
        {1, 0.3071411}}},
      {make_blend_phase(hg, rayleigh, 0.25),  // blendphase, weight=0.25, hg (g=0.8), rayleigh
       {{-1, 0.03352569},
        {-0.9, 0.03098152},
        {-0.35, 0.02333302},
        {-0.1, 0.02396701},
        {0.2, 0.0296851},
        {0.7, 0.07953119},
        {0.95, 0.5452576},
        {1, 2.715585}}},
      // blendphase, weight=0.9, tabphase ('1,4') and blendphase, weight=0.5, isotropic, hg (g=-0.5)
      {make_blend_phase(make_tabulated_phase({1, 4}), nested, 0.9),
       {{-1, 0.2538521},
        {-0.9, 0.1691769},
        {-0.35, 0.07355224},
        {-0.1, 0.0650681},
        {0.2, 0.0601045},
        {0.7, 0.05697293},
        {0.95, 0.0565341},
        {1, 0.0565}}}};
  for (const Group& group : groups)
    for (const Vec2& v : group.values) {
      const Vec3 to(std::sqrt(1 - v.x * v.x), 0, -v.x);
      // Single precision, which 1/(1 − g)² = 25 multiplies in the peak of hg.
      EXPECT_NEAR(group.phase->f_p({0, 0, 1}, to).y, v.y, 25 * 0x1p-23 * v.y + 1e-9) << v.x;
    }
}

}  // namespace
}  // namespace fogbow
