// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "media/mie.h"
#include "tests/helpers/quadrature.h"
#include "tests/unit/materials/phase_cases.h"

namespace fogbow {
namespace {

constexpr double kDegree = kPi / 180;

double one_minus_cos(double degrees) { return 2 * sqr(std::sin(0.5 * degrees * kDegree)); }

/// All droplets of one size: the formula of a sphere in every channel.
TEST(Droplets, OneSizeIsOneSphere) {
  DropletSettings settings = water_droplets(1.5, 0);
  settings.index[2] = {1.4, 0.03};
  const Droplets droplets(settings);
  for (int c = 0; c < 3; ++c) {
    const double x = 2 * kPi * 1500 / settings.wavelengths[c];
    const MieSphere sphere(x, settings.index[c]);
    const auto Q = sphere.efficiencies();
    EXPECT_NEAR(droplets.optics().extinction[c], Q.extinction, 1e-13);
    EXPECT_NEAR(droplets.optics().albedo[c], Q.scattering / Q.extinction, 1e-13);
    EXPECT_NEAR(droplets.optics().asymmetry[c], Q.asymmetry, 1e-13);
    for (const double degrees : {0.0, 0.3, 10.0, 77.0, 140.0, 180.0}) {
      const double d = one_minus_cos(degrees);
      const auto [S1, S2] = sphere.amplitudes(1 - d);
      const double expected = (std::norm(S1) + std::norm(S2)) / (2 * kPi * x * x * Q.scattering);
      EXPECT_NEAR(droplets.f_p(std::vector<double>{d})[0][c] / expected, 1, 1e-12) << degrees;
    }
  }
}

/// The law of sizes written out anew, by Gauss and Kronrod: small droplets, whose fringes are wide.
TEST(Droplets, MeanOverLognormalSizes) {
  const double radius = 0.4, spread = 0.3;
  const DropletSettings settings = water_droplets(radius, spread);
  const Droplets droplets(settings);
  for (const double degrees : {0.0, 20.0, 90.0, 150.0, 180.0}) {
    const RGB got = droplets.f_p(std::vector<double>{one_minus_cos(degrees)})[0];
    for (int c = 0; c < 3; ++c) {
      const double k = 2 * kPi / (1e-3 * settings.wavelengths[c]);
      const auto over_sizes = [&](const std::function<double(const MieSphere&)>& f) {
        return testing::integrate(
            [&](double r) {
              const double z = std::log(r / radius) / spread;
              return std::exp(-0.5 * z * z) / r * f(MieSphere(k * r, settings.index[c]));
            },
            radius * std::exp(-6 * spread), radius * std::exp(9 * spread), 1e-8);
      };
      const double scattered = over_sizes(
          [](const MieSphere& s) { return kPi * sqr(s.x()) * s.efficiencies().scattering; });
      const double towards = over_sizes([&](const MieSphere& s) {
        const auto [S1, S2] = s.amplitudes(std::cos(degrees * kDegree));
        return 0.5 * (std::norm(S1) + std::norm(S2));
      });
      EXPECT_NEAR(got[c] / (towards / scattered), 1, 1e-3) << degrees << ' ' << c;
    }
  }
}

/// Twice as many sizes would change little: the sum against one of 8000 sizes, in fog and cloud.
TEST(Droplets, SizesAreEnough) {
  for (const Vec2& c : {Vec2(4, 0.4), Vec2(10, 0.2), Vec2(10, 0.05)}) {
    const DropletSettings settings = water_droplets(c.x, c.y);
    const Droplets droplets(settings);
    const double k = 2 * kPi / (1e-3 * settings.wavelengths[1]);
    const std::vector<double> degrees{0, 1, 5, 20, 60, 100, 130, 138, 142, 150, 170, 178, 179, 180};
    std::vector<double> d, sum(degrees.size(), 0.0);
    for (const double angle : degrees) d.push_back(one_minus_cos(angle));
    double scattered = 0;
    constexpr int kSizes = 8000;
    for (int i = 0; i < kSizes; ++i) {
      const double z = -5 + (10 + 4 * c.y) * (i + 0.5) / kSizes;
      const MieSphere s(k * c.x * std::exp(z * c.y), settings.index[1]);
      const double number = std::exp(-0.5 * z * z);
      scattered += number * kPi * sqr(s.x()) * s.efficiencies().scattering;
      for (std::size_t j = 0; j < d.size(); ++j) {
        const auto [S1, S2] = s.amplitudes(1 - d[j]);
        sum[j] += number * 0.5 * (std::norm(S1) + std::norm(S2));
      }
    }
    const auto got = droplets.f_p(d);
    for (std::size_t j = 0; j < d.size(); ++j)
      EXPECT_NEAR(got[j].y / (sum[j] / scattered), 1, 0.01)
          << c.x << ' ' << c.y << ' ' << degrees[j];
  }
}

/// Against direct sums, at angles that the table has not seen.
TEST(Droplets, TableErrsByAThousandth) {
  for (const Vec2& c : {Vec2(0.05, 0), Vec2(3, 0), Vec2(10, 0.2), Vec2(2, 0.5)}) {
    const Droplets droplets(water_droplets(c.x, c.y));
    const PhaseTable table = droplets.table();
    const auto phase = make_table_phase(table);
    std::vector<double> d;
    for (int i = 0; i < 900; ++i) d.push_back(one_minus_cos(180 * std::fmod(i * 0.618034, 1.0)));
    for (int i = 0; i < 200; ++i) d.push_back(one_minus_cos(5 * std::fmod(i * 0.618034, 1.0)));
    const auto exact = droplets.f_p(d);
    double worst = 0, squares = 0;
    for (std::size_t i = 0; i < d.size(); ++i) {
      const Vec3 to(std::sqrt(d[i] * (2 - d[i])), 0, d[i] - 1);
      const RGB got = phase->f_p({0, 0, 1}, to);
      for (int ch = 0; ch < 3; ++ch) {
        const double error = std::fabs(got[ch] - exact[i][ch]) / std::max(exact[i][ch], 1e-5);
        worst = std::max(worst, error);
        squares += sqr(error);
      }
    }
    EXPECT_LT(worst, 1e-3) << c.x << ' ' << c.y;
    std::printf("r = %g µm, spread %g: %zu angles, error rms %.2g, at most %.2g\n", c.x, c.y,
                table.values.size(), std::sqrt(squares / (3.0 * d.size())), worst);
    EXPECT_NEAR(phase->mean_cosine(), mean(droplets.optics().asymmetry), 1e-4);
  }
}

TEST(Droplets, TableTriple) {
  const auto phase = make_table_phase(Droplets(water_droplets(5, 0.3)).table());
  const Vec3 from = normalize(Vec3(0.3, -0.7, 0.2));
  EXPECT_EQ(testing::check_triple("droplets", testing::phase_triple(phase, from),
                                  testing::lobe_chart(Frame(-from), 2e-4)),
            "");
  EXPECT_EQ(phase->f_p(from, Vec3(1, 0, 0)), phase->f_p(Vec3(1, 0, 0), from));
}

TEST(Droplets, SmallOnesScatterAsRayleighSays) {
  const auto phase = make_table_phase(Droplets(water_droplets(0.002, 0)).table());
  const auto rayleigh = make_rayleigh_phase();
  for (const double mu : {-1.0, -0.3, 0.0, 0.6, 1.0}) {
    const Vec3 to(std::sqrt(1 - mu * mu), 0, -mu);
    EXPECT_NEAR(phase->f_p({0, 0, 1}, to).x / rayleigh->f_p({0, 0, 1}, to).x, 1, 2e-3) << mu;
  }
}

/// The angle of the first local maximum of the channel from `start` in the sense of `step`, in
/// degrees.
double first_maximum(const Droplets& droplets, int channel, double start, double step, int count) {
  std::vector<double> d;
  for (int i = 0; i <= count; ++i) d.push_back(one_minus_cos(start + i * step));
  const auto f = droplets.f_p(d);
  for (int i = 1; i < count; ++i)
    if (f[i][channel] > f[i - 1][channel] && f[i][channel] > f[i + 1][channel])
      return start + i * step;
  return std::nan("");
}

/// The angle of the greatest value between two, in degrees.
double brightest(const Droplets& droplets, int channel, double lo, double hi) {
  std::vector<double> angles, d;
  for (double angle = lo; angle < hi; angle += 0.1) {
    angles.push_back(angle);
    d.push_back(one_minus_cos(angle));
  }
  const auto f = droplets.f_p(d);
  const auto top = std::max_element(f.begin(), f.end(), [channel](const RGB& a, const RGB& b) {
    return a[channel] < b[channel];
  });
  return angles[static_cast<std::size_t>(top - f.begin())];
}

/// Airy's theory of the rainbow (van de Hulst 1957, sec. 13.24): the brightest angle lies behind
/// Descartes' by 1.0188 (h/x²)^{1/3}, h = 9/4 √((4 − n²)/(n² − 1)³).
double airy_angle(double x, double n) {
  const double incidence = std::acos(std::sqrt((n * n - 1) / 3));
  const double descartes = kPi + 2 * incidence - 4 * std::asin(std::sin(incidence) / n);
  const double h = 2.25 * std::sqrt((4 - n * n) / std::pow(n * n - 1, 3));
  return (descartes + 1.01879 * std::cbrt(h / (x * x))) / kDegree;
}

TEST(Droplets, Fogbow) {
  EXPECT_NEAR(airy_angle(1e9, 4.0 / 3), 137.97, 0.01);  // van de Hulst 1957, table 26: 137°58′
  struct Case {
    double radius, error;
  };
  // Airy's theory holds for x → ∞; where most light is scattered r is exp(2 spread²) greater.
  for (const Case& c : {Case{10, 1.0}, Case{30, 0.5}, Case{80, 0.3}}) {
    const double spread = 0.12;
    const DropletSettings settings = water_droplets(c.radius, spread);
    const Droplets droplets(settings);
    for (int channel = 0; channel < 3; ++channel) {
      const double x =
          2 * kPi * c.radius * std::exp(2 * sqr(spread)) / (1e-3 * settings.wavelengths[channel]);
      const double peak = brightest(droplets, channel, 132, 150);
      EXPECT_NEAR(peak, airy_angle(x, settings.index[channel].real()), c.error)
          << c.radius << ' ' << channel;
      EXPECT_GT(peak, 137.5);
      EXPECT_LT(peak, 145);
    }
  }
}

/// Laven 2005 and philiplaven.com/p6.html: red rings 4° and 7° from the antisolar point in droplets
/// of 5 µm. Rings shrink as λ/r.
TEST(Droplets, Glory) {
  const auto rings = [](double radius) {
    DropletSettings settings = water_droplets(radius, 0.05);
    settings.wavelengths = RGB(650, 550, 450);
    for (int c = 0; c < 3; ++c) settings.index[c] = water_index(settings.wavelengths[c]);
    return Droplets(settings);
  };
  const Droplets small = rings(5), large = rings(10);
  const double first = 180 - first_maximum(small, 0, 179, -0.02, 400);
  EXPECT_NEAR(first, 4, 0.5);
  EXPECT_NEAR(180 - first_maximum(small, 0, 180 - first - 0.5, -0.02, 400), 7, 0.5);
  EXPECT_NEAR((180 - first_maximum(large, 0, 179.5, -0.02, 400)) / first, 0.5, 0.05);
  EXPECT_NEAR((180 - first_maximum(small, 2, 179.3, -0.02, 400)) / first, 450.0 / 650, 0.05);
  // Brighter than what lies around it.
  const auto f = small.f_p(std::vector<double>{2.0, one_minus_cos(165)});
  EXPECT_GT(f[0].x, 2 * f[1].x);
}

TEST(Droplets, RefuseWhatTheyCannotMean) {
  for (const double radius : {0.0, -1.0, 1e6, kInfinity, std::nan("")})
    EXPECT_THROW(Droplets(water_droplets(radius, 0)), std::domain_error);
  for (const double spread : {-0.1, 1.1, std::nan("")})
    EXPECT_THROW(Droplets(water_droplets(1, spread)), std::domain_error);
  EXPECT_THROW(Droplets(water_droplets(300, 0.3)), std::domain_error);
  DropletSettings settings = water_droplets(1, 0);
  settings.wavelengths.y = 0;
  EXPECT_THROW(Droplets{settings}, std::domain_error);
}

}  // namespace
}  // namespace fogbow
