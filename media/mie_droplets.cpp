// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <stdexcept>

#include "core/util/parallel.h"
#include "media/mie.h"

namespace fogbow {

namespace {

constexpr int kBlock = 32;  ///< angles that are summed together
using Block = std::array<double, kBlock>;

/// πₙ + τₙ and πₙ − τₙ at the angles of a block, from n = 1 on.
struct AngularFunctions {
  std::vector<Block> sum, difference;

  AngularFunctions(std::span<const double> one_minus_cos, std::size_t terms)
      : sum(terms), difference(terms) {
    for (std::size_t k = 0; k < one_minus_cos.size(); ++k) {
      const double cos_theta = 1 - one_minus_cos[k];
      double before = 0, pi = 1;
      for (std::size_t i = 0; i < terms; ++i) {
        const double n = static_cast<double>(i) + 1;
        const double tau = n * cos_theta * pi - (n + 1) * before;
        sum[i][k] = pi + tau;
        difference[i][k] = pi - tau;
        const double next = ((2 * n + 1) * cos_theta * pi - (n + 1) * before) / n;
        before = pi;
        pi = next;
      }
    }
  }
};

/// |S₁ + S₂|² + |S₁ − S₂|² at the angles of a block.
Block intensity(const MieSphere& sphere, const AngularFunctions& at) {
  Block plus_re{}, plus_im{}, minus_re{}, minus_im{}, result;
  const auto terms = sphere.terms();
  for (std::size_t n = 0; n < terms.size(); ++n)
    for (int k = 0; k < kBlock; ++k) {
      plus_re[k] += terms[n].sum.real() * at.sum[n][k];
      plus_im[k] += terms[n].sum.imag() * at.sum[n][k];
      minus_re[k] += terms[n].difference.real() * at.difference[n][k];
      minus_im[k] += terms[n].difference.imag() * at.difference[n][k];
    }
  for (int k = 0; k < kBlock; ++k)
    result[k] = sqr(plus_re[k]) + sqr(plus_im[k]) + sqr(minus_re[k]) + sqr(minus_im[k]);
  return result;
}

void check(const DropletSettings& s) {
  if (!(s.radius > 0 && std::isfinite(s.radius)))
    throw std::domain_error("the radius of droplets must be positive and finite");
  if (!(s.spread >= 0 && s.spread <= 1))
    throw std::domain_error("the spread of droplets' sizes must lie in [0, 1]");
  for (int c = 0; c < 3; ++c)
    if (!(s.wavelengths[c] > 0 && std::isfinite(s.wavelengths[c])))
      throw std::domain_error("wavelengths must be positive and finite");
}

struct NumberOfSize {
  double x, number;
};

/// Of lognormal sizes, the numbers not normalized: trapezoids in ln x, at most
/// kStep of x apart where most light is scattered if that can be afforded, for resonances are
/// narrow. From 4 standard
/// deviations below the median to 4 above where forward scattering ∝ r⁴ has its own.
std::vector<NumberOfSize> sizes_in_number(double x_of_median, double spread) {
  constexpr double kReach = 4, kStep = 0.05, kLeastSizes = 2048, kWork = 1e6;
  constexpr double kLargestAlone = 5000, kLargestOfMany = 2000;
  const double lo = -kReach * spread, hi = kReach * spread + 4 * sqr(spread);
  const double most = spread > 0 ? kLargestOfMany : kLargestAlone;
  if (!(x_of_median * std::exp(hi) <= most))
    throw std::domain_error("droplets of such a radius and spread are too large for Mie's series");
  if (spread == 0) return {{x_of_median, 1}};
  const double x_median = x_of_median * std::exp(2 * sqr(spread));
  const double affordable = std::max(kLeastSizes, kWork / x_median);
  const double wanted = std::max(kLeastSizes, (hi - lo) * x_median / kStep);
  const int steps = static_cast<int>(std::min(wanted, affordable));
  std::vector<NumberOfSize> result;
  for (int i = 0; i <= steps; ++i) {
    const double y = lo + (hi - lo) * i / steps;
    result.push_back({x_of_median * std::exp(y), std::exp(-0.5 * sqr(y / spread))});
  }
  return result;
}

/// Where linear interpolation misses the values in the middle of pieces.
bool misses(const RGB& a, const RGB& middle, const RGB& b) {
  constexpr double kRelative = 1e-3, kFloor = 1e-5;
  for (int c = 0; c < 3; ++c)
    if (std::fabs(0.5 * (a[c] + b[c]) - middle[c]) > kRelative * std::max(middle[c], kFloor))
      return true;
  return false;
}

}  // namespace

Droplets::Droplets(const DropletSettings& settings) {
  check(settings);
  for (int c = 0; c < 3; ++c) add_sizes(settings, c);
}

void Droplets::add_sizes(const DropletSettings& s, int channel) {
  const double wave_number = 2 * kPi / (1e-3 * s.wavelengths[channel]);  // 1/µm
  const double x_median = wave_number * s.radius * std::exp(2 * sqr(s.spread));
  double disks = 0, extinct = 0, scattered = 0, forward = 0;
  for (const auto& [x, number] : sizes_in_number(wave_number * s.radius, s.spread)) {
    MieSphere sphere(x, s.index[channel]);
    const MieEfficiencies& Q = sphere.efficiencies();
    const double disk = number * sqr(x);
    disks += disk;
    extinct += disk * Q.extinction;
    scattered += disk * Q.scattering;
    forward += disk * Q.scattering * Q.asymmetry;
    sizes_[channel].push_back({std::move(sphere), number});
  }
  // dC_sca/dΩ = (|S₁|² + |S₂|²)/(2k²) and C_sca = Q_sca π x²/k².
  for (Size& size : sizes_[channel]) size.weight /= 4 * kPi * scattered;
  optics_.extinction[channel] = extinct / disks;
  optics_.albedo[channel] = scattered / extinct;
  optics_.asymmetry[channel] = forward / scattered;
  median_x_ = std::max(median_x_, x_median);
}

std::vector<RGB> Droplets::f_p(std::span<const double> one_minus_cos) const {
  std::vector<RGB> result(one_minus_cos.size(), RGB(0));
  const std::size_t blocks = (one_minus_cos.size() + kBlock - 1) / kBlock;
  std::size_t terms = 0;
  for (const auto& channel : sizes_) terms = std::max(terms, channel.back().sphere.terms().size());
  parallel_for(static_cast<std::int64_t>(blocks), [&](std::int64_t block) {
    const std::size_t first = static_cast<std::size_t>(block) * kBlock;
    const auto angles =
        one_minus_cos.subspan(first, std::min<std::size_t>(kBlock, one_minus_cos.size() - first));
    const AngularFunctions at(angles, terms);
    for (int c = 0; c < 3; ++c)
      for (const Size& size : sizes_[c]) {
        const Block value = intensity(size.sphere, at);
        for (std::size_t k = 0; k < angles.size(); ++k)
          result[first + k][c] += size.weight * value[k];
      }
  });
  return result;
}

namespace {

/// A table and which of its pieces have to be halved.
struct Refinement {
  PhaseTable table;
  std::vector<bool> open;

  std::vector<double> middles() const {
    std::vector<double> result;
    for (std::size_t i = 0; i < open.size(); ++i)
      if (open[i]) result.push_back(0.5 * (table.one_minus_cos[i] + table.one_minus_cos[i + 1]));
    return result;
  }
  /// Halves what is open; halves stay open where the middle was missed.
  Refinement finer(const std::vector<double>& middles, const std::vector<RGB>& values) const {
    Refinement result;
    const auto add = [&result](double d, const RGB& value) {
      result.table.one_minus_cos.push_back(d);
      result.table.values.push_back(value);
    };
    for (std::size_t i = 0, m = 0; i < open.size(); ++i) {
      add(table.one_minus_cos[i], table.values[i]);
      const bool again = open[i] && misses(table.values[i], values[m], table.values[i + 1]);
      if (open[i]) {
        add(middles[m], values[m]);
        ++m;
        result.open.push_back(again);
      }
      result.open.push_back(again);
    }
    add(table.one_minus_cos.back(), table.values.back());
    return result;
  }
};

}  // namespace

/// Begins with three angles a fringe of the droplets that scatter most, and halves pieces (in cosθ)
/// until their middles are met; the middles stay.
PhaseTable Droplets::table() const {
  constexpr std::size_t kMostKnots = 1 << 18;
  const int pieces = static_cast<int>(std::max(180.0, std::ceil(kPi * median_x_)));
  Refinement r;
  for (int i = 0; i <= pieces; ++i)
    r.table.one_minus_cos.push_back(i < pieces ? 2 * sqr(std::sin(0.5 * kPi * i / pieces)) : 2.0);
  r.table.values = f_p(r.table.one_minus_cos);
  r.open.assign(pieces, true);
  for (auto middles = r.middles(); !middles.empty(); middles = r.middles()) {
    if (middles.size() + r.table.values.size() > kMostKnots)
      throw std::domain_error(
          "the fringes of these droplets are too fine for a table: spread their sizes");
    r = r.finer(middles, f_p(middles));
  }
  return std::move(r.table);
}

}  // namespace fogbow
