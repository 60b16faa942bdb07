// SPDX-License-Identifier: GPL-3.0-or-later
#include <complex>

#include "tests/helpers/quadrature.h"
#include "tests/statistical/closed_forms_expected.h"

namespace fogbow::testing {

namespace {

constexpr double kAlpha = 0.5;

/// Smith's masking of isotropic facets (Walter et al. 2007, eqs. 23 and 34), exact for Beckmann.
double masking(Facets facets, double cos_theta) {
  const double tan_theta = std::sqrt(1 - sqr(cos_theta)) / cos_theta;
  if (facets == Facets::Ggx) return 2 / (1 + std::sqrt(1 + sqr(kAlpha * tan_theta)));
  const double a = 1 / (kAlpha * tan_theta);
  return 2 / (1 + std::erf(a) + std::exp(-a * a) / (a * std::sqrt(kPi)));
}

/// tanθ of the facets below which the share t of the projected area ∫ D cosθ dσ lies.
double slope(Facets facets, double t) {
  const double square = facets == Facets::Ggx ? t / (1 - t) : -std::log1p(-t);
  return kAlpha * std::sqrt(square);
}

/// What one facet of normal h sends towards a, in units of what it receives; see rough-furnace.xml.
using FacetRadiance = std::function<double(const Vec3& a, const Vec3& h)>;

/// ∫ D(h) G1(a) (a·h)₊/μ facet(a, h) dσ(h), with D cosθ dσ = dt dφ/2π.
double rough_radiance(Facets facets, double mu, const FacetRadiance& facet) {
  static const QuadratureRule shares = gauss_legendre(128, 0, 1);
  constexpr int kAzimuths = 128;
  const Vec3 a(std::sqrt(1 - mu * mu), 0, mu);
  double sum = 0;
  for (std::size_t i = 0; i < shares.nodes.size(); ++i) {
    // Share 1 − s⁴ crowds the nodes where facets are steep.
    const double s = shares.nodes[i];
    const double tan_theta = slope(facets, 1 - sqr(sqr(s)));
    const double weight = shares.weights[i] * 4 * s * s * s / kAzimuths;
    for (int j = 0; j < kAzimuths; ++j) {
      const double phi = 2 * kPi * (j + 0.5) / kAzimuths;
      const Vec3 h = normalize(Vec3(tan_theta * std::cos(phi), tan_theta * std::sin(phi), 1));
      if (dot(a, h) > 0) sum += weight * dot(a, h) / h.z * facet(a, h);
    }
  }
  return sum * masking(facets, mu) / mu;
}

/// Unpolarized Fresnel reflectance of a metal, from the complex amplitudes (Born and Wolf, 1.5).
double fresnel_metal(double cos_i, std::complex<double> n) {
  const std::complex<double> cos_t = std::sqrt(1.0 - (1 - sqr(cos_i)) / (n * n));
  return 0.5 * (std::norm((cos_i - n * cos_t) / (cos_i + n * cos_t)) +
                std::norm((n * cos_i - cos_t) / (n * cos_i + cos_t)));
}

ExpectedPixels rough_pixels(int width, int height, Facets facets,
                            const std::array<FacetRadiance, 3>& channels) {
  const View view{Vec3(0, -3, 2), Vec3(0), Vec3(0, 0, 1), 30};
  const PixelGrid grid{view.fov_x_degrees, width, height};
  const auto cosine = [&](const Vec3& d) { return -view.to_world(d).z; };
  constexpr int kNodes = 20;
  const double lo = 0.95 * cosine(grid.direction(0, 0)),
               hi = 1.01 * cosine(grid.direction(0.5 * width, height));
  std::vector<RGB> means(static_cast<std::size_t>(width) * height);
  for (int c = 0; c < 3; ++c) {
    std::vector<double> values;
    for (const double mu : ChebyshevInterpolant::nodes(kNodes, lo, hi))
      values.push_back(rough_radiance(facets, mu, channels[c]));
    const ChebyshevInterpolant L(lo, hi, values);
    for (int i = 0; i < width * height; ++i)
      means[i][c] = grid.pixel_mean(
          i % width, i / width, [&](const Vec3& d) { return L(cosine(d)); }, 5);
  }
  return {means.begin(), means.end()};
}

}  // namespace

ExpectedPixels rough_conductor_pixels(int width, int height, Facets facets) {
  const auto metal = [facets](double eta, double k) {
    return [facets, n = std::complex<double>(eta, k)](const Vec3& a, const Vec3& h) {
      const Vec3 r = 2 * dot(a, h) * h - a;
      return r.z > 0 ? fresnel_metal(dot(a, h), n) * masking(facets, r.z) : 0;
    };
  };
  return rough_pixels(width, height, facets, {metal(0.2, 3.9), metal(1.1, 2.6), metal(2, 1)});
}

ExpectedPixels rough_dielectric_pixels(int width, int height, Facets facets) {
  constexpr double kIndex = 1.5;
  const auto glass = [facets](const Vec3& a, const Vec3& h) {
    const double F = fresnel_dielectric(dot(a, h), kIndex);
    const Vec3 r = 2 * dot(a, h) * h - a;
    const Vec3 t = *refract_direction(-a, h, kIndex);
    double L = r.z > 0 ? F * masking(facets, r.z) : 0;
    if (t.z < 0) L += (1 - F) * masking(facets, -t.z) / sqr(kIndex);
    return L;
  };
  return rough_pixels(width, height, facets, {glass, glass, glass});
}

}  // namespace fogbow::testing
