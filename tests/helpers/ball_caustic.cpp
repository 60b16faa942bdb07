// SPDX-License-Identifier: GPL-3.0-or-later
#include <numbers>
#include <stdexcept>
#include <vector>

#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"

namespace fogbow::testing {
namespace {

constexpr int kScan = 4000;  // cells of the incidence angle searched for roots of r(i)

}  // namespace

double BallCaustic::angle_at_light(double incidence) const {
  return std::asin(radius / light_distance * std::sin(incidence));
}

std::optional<BallCaustic::Landing> BallCaustic::trace(double incidence, int order) const {
  // A sphere keeps the impact parameter b = R sin i of a ray; only its angle ψ from the axis turns:
  // by i − t at each refraction and π − 2t at each inner reflection, or by π − 2i outside. With b
  // the line meets the plane at r = (b + P sinψ)/cosψ.
  const double sin_i = std::sin(incidence), cos_i = std::cos(incidence);
  const double sin_t = sin_i / index, cos_t = std::sqrt(1 - sqr(sin_t));
  const double t = std::asin(sin_t), dt = cos_i / (index * cos_t);
  const double alpha = angle_at_light(incidence);
  const double dalpha = radius * cos_i / (light_distance * std::cos(alpha));
  const double f = fresnel_dielectric(cos_i, index);
  double psi = 0, dpsi = 0, weight = 0;
  if (order == kOutside) {
    psi = alpha + kPi - 2 * incidence;
    dpsi = dalpha - 2;
    weight = f;
  } else {
    psi = alpha - 2 * (incidence - t) - order * (kPi - 2 * t);
    dpsi = dalpha - 2 + 2 * (order + 1) * dt;
    weight = sqr(1 - f) * std::pow(f, order);
  }
  const double cos_psi = std::cos(psi), sin_psi = std::sin(psi);
  if (cos_psi <= 0) return std::nullopt;
  const double b = radius * sin_i;
  const double r = (b + plane_distance * sin_psi) / cos_psi;
  const double dr =
      (radius * cos_i + plane_distance * cos_psi * dpsi + r * sin_psi * dpsi) / cos_psi;
  return Landing{r, dr, cos_psi, weight};
}

double BallCaustic::solid_angle_density(double incidence) const {
  return sqr(radius / light_distance) * std::sin(incidence) * std::cos(incidence) /
         std::cos(angle_at_light(incidence));
}

void BallCaustic::visit_landings(
    int order, int rings, int azimuths,
    const std::function<void(double x, double y, double flux)>& visit) const {
  const double step = kPi / 2 / rings;
  for (int ring = 0; ring < rings; ++ring) {
    const double incidence = (ring + 0.5) * step;
    const std::optional<Landing> landing = trace(incidence, order);
    if (!landing) continue;
    const double flux =
        intensity * landing->weight * solid_angle_density(incidence) * step * 2 * kPi / azimuths;
    const double turn = std::fmod(ring * std::numbers::phi, 1);  // no two rings aligned
    for (int k = 0; k < azimuths; ++k) {
      const double azimuth = 2 * kPi * (k + turn) / azimuths;
      visit(landing->r * std::cos(azimuth), landing->r * std::sin(azimuth), flux);
    }
  }
}

double BallCaustic::flux_within(double reach, int order) const {
  const auto beyond = [&](double i) {
    const std::optional<Landing> landing = trace(i, order);
    return landing ? std::fmin(std::abs(landing->r) / reach - 1, 1.0) : 1.0;
  };
  std::vector<double> ends = find_roots(beyond, 0, kPi / 2, kScan);
  ends.insert(ends.begin(), 0.0);
  ends.push_back(kPi / 2);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < ends.size(); ++k) {
    if (ends[k + 1] <= ends[k] || beyond((ends[k] + ends[k + 1]) / 2) >= 0) continue;
    sum += integrate([&](double i) { return trace(i, order)->weight * solid_angle_density(i); },
                     ends[k], ends[k + 1]);
  }
  return 2 * kPi * intensity * sum;
}

double BallCaustic::direct_flux_within(double reach) const {
  const double limb = std::asin(radius / light_distance);
  const double edge = std::atan(reach / (light_distance + plane_distance));
  return edge > limb ? 2 * kPi * intensity * (std::cos(limb) - std::cos(edge)) : 0;
}

double BallCaustic::total_flux_within(double reach, int max_order) const {
  double sum = direct_flux_within(reach);
  for (int order = kOutside; order <= max_order; ++order) sum += flux_within(reach, order);
  return sum;
}

double BallCaustic::irradiance(double r, int order) const {
  double sum = 0;
  for (const double side : {r, -r}) {
    // r(i)·cosψ would be smooth where the ray turns away from the plane; the sign alone is enough
    // for the bisection.
    const auto miss = [&](double i) {
      const std::optional<Landing> landing = trace(i, order);
      return landing ? landing->r - side : (order == kOutside ? kInfinity : -kInfinity);
    };
    for (const double i : find_roots(miss, 0, kPi / 2, kScan)) {
      const std::optional<Landing> landing = trace(i, order);
      if (!landing || std::abs(landing->r - side) > 1e-6 * (std::abs(side) + radius)) continue;
      sum += landing->weight * solid_angle_density(i) / (r * std::abs(landing->dr));
    }
  }
  return intensity * sum;
}

double BallCaustic::direct_irradiance(double r) const {
  const double height = light_distance + plane_distance;
  const double limb = std::asin(radius / light_distance);
  if (std::atan(r / height) <= limb) return 0;
  return intensity * height / std::pow(height * height + r * r, 1.5);
}

}  // namespace fogbow::testing
