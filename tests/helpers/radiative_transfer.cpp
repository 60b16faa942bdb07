// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/radiative_transfer.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

#include "tests/helpers/closed_forms.h"
#include "tests/helpers/quadrature.h"

namespace fogbow::testing {
namespace {

constexpr int kPanel = 40;  // Gauss nodes a panel; the phase function is cut at degree 2·40 − 1,
                            // where g = 0.75 has 1e-10

using Matrix = std::vector<double>;

Matrix multiply(const Matrix& a, const Matrix& b, int n, int columns) {
  Matrix c(static_cast<std::size_t>(n) * columns, 0.0);
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < columns; ++j) c[i * columns + j] += a[i * n + k] * b[k * columns + j];
  return c;
}

/// A⁻¹B by elimination with row pivots.
Matrix solve(Matrix a, Matrix b, int n, int columns) {
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (std::abs(a[i * n + k]) > std::abs(a[pivot * n + k])) pivot = i;
    if (a[pivot * n + k] == 0) throw std::runtime_error("singular matrix");
    for (int j = 0; j < n; ++j) std::swap(a[k * n + j], a[pivot * n + j]);
    for (int j = 0; j < columns; ++j) std::swap(b[k * columns + j], b[pivot * columns + j]);
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = a[i * n + k] / a[k * n + k];
      if (factor == 0) continue;
      for (int j = k; j < n; ++j) a[i * n + j] -= factor * a[k * n + j];
      for (int j = 0; j < columns; ++j) b[i * columns + j] -= factor * b[k * columns + j];
    }
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < columns; ++j) b[i * columns + j] /= a[i * n + i];
  return b;
}

/// Legendre polynomials up to degree 2·kPanel − 1.
std::vector<double> legendre(double x) {
  std::vector<double> p(2 * kPanel);
  p[0] = 1;
  p[1] = x;
  for (int l = 2; l < 2 * kPanel; ++l) p[l] = ((2 * l - 1) * x * p[l - 1] - (l - 1) * p[l - 2]) / l;
  return p;
}

double sum_row(const Matrix& m, int row, int n) {
  double sum = 0;
  for (int j = 0; j < n; ++j) sum += m[row * n + j];
  return sum;
}

}  // namespace

ChandrasekharH::ChandrasekharH(double albedo) : albedo_(albedo) {
  // H has a μ ln μ at 0; μ = s⁴ makes the integrand smooth enough for Gauss.
  const QuadratureRule rule = gauss_legendre(96, 0, 1);
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const double s = rule.nodes[i];
    nodes_.push_back(s * s * s * s);
    weights_.push_back(rule.weights[i] * 4 * s * s * s);
  }
  h_.assign(nodes_.size(), 1.0);
  double change = 1;
  for (int iteration = 0; change > 1e-15; ++iteration) {
    if (iteration > 100000) throw std::runtime_error("H did not converge");
    std::vector<double> next;
    for (double mu : nodes_) next.push_back((*this)(mu));
    change = 0;
    for (std::size_t i = 0; i < h_.size(); ++i)
      change = std::fmax(change, std::abs(next[i] / h_[i] - 1));
    if (change < 1e-13 && iteration > 10000) break;  // rounding
    h_ = std::move(next);
  }
}

double ChandrasekharH::operator()(double mu) const {
  // 1/H(μ) = √(1−ϖ) + (ϖ/2) ∫₀¹ μ' H(μ')/(μ+μ') dμ'   (Chandrasekhar 1960, ch. V, eq. 17)
  double integral = 0;
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    integral += weights_[i] * nodes_[i] * h_[i] / (mu + nodes_[i]);
  return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * integral);
}

double ChandrasekharH::brdf(double mu, double mu0) const {
  return albedo_ / (4 * std::numbers::pi) * (*this)(mu) * (*this)(mu0) / (mu + mu0);
}

double ChandrasekharH::plane_albedo(double mu0) const {
  return 1 - std::sqrt(1 - albedo_) * (*this)(mu0);
}

double critical_cosine(double n) { return std::sqrt(1 - 1 / (n * n)); }

PlaneLayer::PlaneLayer(double albedo, double g, double thickness, std::vector<double> view_cosines,
                       double split) {
  const auto panel = [&](double a, double b) {
    const QuadratureRule rule = gauss_legendre(kPanel, a, b);
    mu_.insert(mu_.end(), rule.nodes.begin(), rule.nodes.end());
    weight_.insert(weight_.end(), rule.weights.begin(), rule.weights.end());
  };
  if (split > 0) panel(0, split);
  panel(split, 1);
  first_view_ = static_cast<int>(mu_.size());
  mu_.insert(mu_.end(), view_cosines.begin(), view_cosines.end());
  weight_.resize(mu_.size(), 0.0);
  size_ = static_cast<int>(mu_.size());
  int doublings = 0;
  double thin = thickness;
  for (; thin > 1e-8; thin /= 2) ++doublings;
  start(albedo, g, thin);
  for (int i = 0; i < doublings; ++i) double_up();
}

void PlaneLayer::start(double albedo, double g, double thickness) {
  std::vector<std::vector<double>> p;
  for (double mu : mu_) p.push_back(legendre(mu));
  reflect_.assign(static_cast<std::size_t>(size_) * size_, 0.0);
  transmit_ = reflect_;
  for (int i = 0; i < size_; ++i) {
    for (int j = 0; j < size_; ++j) {
      double forward = 0, backward = 0, g_l = 1;
      for (int l = 0; l < 2 * kPanel; ++l, g_l *= g) {
        const double term = (2 * l + 1) * g_l * p[i][l] * p[j][l];
        forward += term;
        backward += l % 2 ? -term : term;
      }
      // dI(μ_i) = ϖ/2 ∫ p(μ_i, μ_j) I(μ_j) dμ_j · (1 − exp(−τ/μ_i)); the next order in τ is left
      // out
      const double scattered = albedo / 2 * weight_[j] * -std::expm1(-thickness / mu_[i]);
      reflect_[i * size_ + j] = scattered * backward;
      transmit_[i * size_ + j] = scattered * forward;
    }
    transmit_[i * size_ + i] += std::exp(-thickness / mu_[i]);
  }
}

void PlaneLayer::double_up() {
  // R₂ = R + T (1 − R R)⁻¹ R T,  T₂ = T (1 − R R)⁻¹ T
  Matrix loop = multiply(reflect_, reflect_, size_, size_);
  for (double& x : loop) x = -x;
  for (int i = 0; i < size_; ++i) loop[i * size_ + i] += 1;
  const Matrix inner = solve(loop, transmit_, size_, size_);
  const Matrix back = multiply(reflect_, inner, size_, size_);
  const Matrix out = multiply(transmit_, back, size_, size_);
  for (std::size_t i = 0; i < out.size(); ++i) reflect_[i] += out[i];
  transmit_ = multiply(transmit_, inner, size_, size_);
}

double PlaneLayer::reflected(int view) const {
  return sum_row(reflect_, first_view_ + view, size_);
}

double PlaneLayer::transmitted(int view) const {
  return sum_row(transmit_, first_view_ + view, size_);
}

double PlaneLayer::reflected_under_glass(double n) const {
  // Inside, just below the face: down(μ) = F(μ) up(μ) + n² (1 − F(μ)) · 1 (nothing enters beyond
  // the critical angle, where F = 1), up = R down. Outside: L = F₀ + (1 − F₀) up(1)/n².
  std::vector<double> fresnel, entering;
  for (double mu : mu_) {
    fresnel.push_back(fresnel_dielectric(mu, 1 / n));
    entering.push_back(n * n * (1 - fresnel.back()));
  }
  Matrix loop(reflect_.size());
  for (int i = 0; i < size_; ++i)
    for (int j = 0; j < size_; ++j)
      loop[i * size_ + j] = (i == j ? 1 : 0) - reflect_[i * size_ + j] * fresnel[j];
  const Matrix up = solve(loop, multiply(reflect_, entering, size_, 1), size_, 1);
  const double outside = fresnel_dielectric(1, n);
  return outside + (1 - outside) * up[first_view_] / (n * n);
}

}  // namespace fogbow::testing
