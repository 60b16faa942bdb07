// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/mie.h"

#include <algorithm>
#include <stdexcept>

namespace fogbow {

namespace {

using Complex = std::complex<double>;

/// Riccati–Bessel functions ψₙ and χₙ of orders −1 to n_max, the order −1 in front.
struct RiccatiBessel {
  std::vector<double> psi, chi;
};

/// χ by upward recurrence. ψ likewise up to n = x; beyond, where that is unstable, by its ratios
/// ψₙ/ψₙ₋₁ from above.
RiccatiBessel riccati_bessel(double x, int n_max) {
  RiccatiBessel f;
  f.psi = {std::cos(x), std::sin(x)};
  f.chi = {-std::sin(x), std::cos(x)};
  std::vector<double> ratio(n_max + 17);
  for (int n = n_max + 15; n > std::min<double>(x, n_max); --n)
    ratio[n] = 1 / ((2 * n + 1) / x - ratio[n + 1]);
  for (int n = 1; n <= n_max; ++n) {
    const double step = (2 * n - 1) / x;
    f.chi.push_back(step * f.chi[n] - f.chi[n - 1]);
    f.psi.push_back(n > x ? ratio[n] * f.psi[n] : step * f.psi[n] - f.psi[n - 1]);
  }
  return f;
}

/// Dₙ = ψₙ'/ψₙ of mx by downward recurrence [Bohren1983, eq. 4.89] from where ψₙ has decayed: up to
/// n = |mx| errors of the start would stay.
std::vector<Complex> logarithmic_derivative(Complex mx, int n_max) {
  const double decayed = std::abs(mx) + 8 * std::cbrt(std::abs(mx));
  const int start = std::max(n_max, static_cast<int>(decayed)) + 16;
  std::vector<Complex> D(start + 1);
  for (int n = start; n > 0; --n) {
    const Complex r = static_cast<double>(n) / mx;
    D[n - 1] = r - 1.0 / (D[n] + r);
  }
  return D;
}

}  // namespace

MieSphere::MieSphere(double x, Complex index) : x_(x) {
  constexpr double kLargest = 1e5;
  if (!(x > 0 && x <= kLargest && index.real() > 0 && index.imag() >= 0 &&
        std::abs(index) * x <= 10 * kLargest))
    throw std::domain_error("no scattering can be computed for such a size or index of refraction");
  // [Wiscombe1980, eq. 4]
  const int n_max = static_cast<int>(std::ceil(x + 4.05 * std::cbrt(x) + 2));
  const auto D = logarithmic_derivative(index * x, n_max);
  const auto [psi, chi] = riccati_bessel(x, n_max);
  Complex a_before = 0, b_before = 0;
  double extinction = 0, scattering = 0, asymmetry = 0;
  Complex back = 0;
  for (int n = 1; n <= n_max; ++n) {
    const Complex xi(psi[n + 1], -chi[n + 1]), xi_before(psi[n], -chi[n]);
    const Complex electric = D[n] / index + n / x, magnetic = D[n] * index + n / x;
    const Complex a = (electric * psi[n + 1] - psi[n]) / (electric * xi - xi_before);  // eq. 4.88
    const Complex b = (magnetic * psi[n + 1] - psi[n]) / (magnetic * xi - xi_before);
    const double degree = 2 * n + 1, c = degree / (n * (n + 1.0));
    terms_.push_back({c * (a + b), c * (a - b)});
    extinction += degree * (a + b).real();                 // eq. 4.62
    scattering += degree * (std::norm(a) + std::norm(b));  // eq. 4.61
    back += (n % 2 ? -degree : degree) * (a - b);
    // sec. 4.5
    asymmetry +=
        c * (a * std::conj(b)).real() +
        (n - 1) * (n + 1.0) / n * (a_before * std::conj(a) + b_before * std::conj(b)).real();
    a_before = a;
    b_before = b;
  }
  const double scale = 2 / (x * x);
  efficiencies_ = {scale * extinction, scale * scattering, std::norm(back) / (x * x),
                   2 * asymmetry / scattering};
}

std::pair<Complex, Complex> MieSphere::amplitudes(double cos_theta) const {
  Complex sum = 0, difference = 0;
  double pi_before = 0, pi = 1;
  double n = 1;
  for (const Term& t : terms_) {
    const double tau = n * cos_theta * pi - (n + 1) * pi_before;  // eq. 4.47
    sum += t.sum * (pi + tau);
    difference += t.difference * (pi - tau);
    const double next = ((2 * n + 1) * cos_theta * pi - (n + 1) * pi_before) / n;
    pi_before = pi;
    pi = next;
    ++n;
  }
  return {0.5 * (sum + difference), 0.5 * (sum - difference)};
}

double water_index(double wavelength) {
  constexpr double A[] = {5.684027565e-1, 1.726177391e-1, 2.086189578e-2, 1.130748688e-1};
  constexpr double squared[] = {5.101829712e-3, 1.821153936e-2, 2.620722293e-2, 1.069792721e1};
  const double square = sqr(1e-3 * wavelength);  // µm²
  double n2 = 1;
  for (int i = 0; i < 4; ++i) n2 += A[i] * square / (square - squared[i]);
  constexpr double kAir = 1.00027;
  return std::sqrt(n2) / kAir;
}

DropletSettings water_droplets(double radius, double spread) {
  DropletSettings settings{radius, spread, DropletSettings().wavelengths, {}};
  for (int c = 0; c < 3; ++c) settings.index[c] = water_index(settings.wavelengths[c]);
  return settings;
}

}  // namespace fogbow
