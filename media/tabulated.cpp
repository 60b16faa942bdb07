// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <stdexcept>
#include <utility>

#include "media/axial_phase.h"
#include "media/media.h"
#include "media/table_phase.h"

namespace fogbow {
namespace {

void check(const PhaseTable& t) {
  const std::size_t n = t.one_minus_cos.size();
  if (n < 2 || t.values.size() != n)
    throw std::domain_error("a phase function needs at least two values");
  if (t.one_minus_cos.front() != 0 || t.one_minus_cos.back() != 2 ||
      !std::is_sorted(t.one_minus_cos.begin(), t.one_minus_cos.end(), std::less_equal<>()))
    throw std::domain_error("the angles of a phase function must rise from 0 to pi");
  for (const RGB& v : t.values)
    for (int c = 0; c < 3; ++c)
      if (!(v[c] >= 0 && std::isfinite(v[c])))
        throw std::domain_error("the values of a phase function must be finite and not negative");
}

/// Sampled by the mean of its channels, piece by piece.
class TablePhase final : public AxialPhase {
 public:
  explicit TablePhase(PhaseTable table) : knots_(std::move(table.one_minus_cos)) {
    values_ = std::move(table.values);
    normalize_channels();
    for (const RGB& v : values_) means_.push_back(mean(v));
    cdf_.push_back(0);
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
      cdf_.push_back(cdf_.back() + kPi * width(i) * (means_[i] + means_[i + 1]));
    for (double& c : cdf_) c /= cdf_.back();
  }

  double mean_cosine() const override {
    double sum = 0;  // Simpson's rule, exact here
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) {
      const double a = 1 - knots_[i], b = 1 - knots_[i + 1], p = means_[i], q = means_[i + 1];
      sum += width(i) * (a * p + (a + b) * (p + q) + b * q) * kPi / 3;
    }
    return sum;
  }

 private:
  double width(std::size_t i) const { return knots_[i + 1] - knots_[i]; }
  /// The piece where 1 − cosθ lies.
  std::size_t piece(double one_minus_cos) const {
    const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, one_minus_cos);
    return static_cast<std::size_t>(above - knots_.begin()) - 1;
  }
  template <class T>
  T interpolate(const std::vector<T>& at, const warp::PolarAngle& angle) const {
    const std::size_t i = piece(angle.one_minus_cos);
    const double t = std::clamp((angle.one_minus_cos - knots_[i]) / width(i), 0.0, 1.0);
    return (1 - t) * at[i] + t * at[i + 1];
  }
  void normalize_channels() {
    RGB mass(0);
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i)
      mass += kPi * width(i) * (values_[i] + values_[i + 1]);
    for (int c = 0; c < 3; ++c)
      if (!(mass[c] > 0 && std::isfinite(mass[c])))
        throw std::domain_error("the values of a phase function must not all be zero");
    for (RGB& v : values_) v /= mass;
  }

  RGB value(const warp::PolarAngle& angle, double) const override {
    return interpolate(values_, angle);
  }
  double density(const warp::PolarAngle& angle) const override {
    return interpolate(means_, angle);
  }
  warp::PolarAngle sample_angle(double u) const override {
    auto above = std::upper_bound(cdf_.begin() + 1, cdf_.end() - 1, u);
    while (*above == *(above - 1)) --above;  // rounding may land on an empty last piece
    const std::size_t i = static_cast<std::size_t>(above - cdf_.begin()) - 1;
    const double p = means_[i], slope = (means_[i + 1] - p) / width(i);
    const double mass = std::max(u - cdf_[i], 0.0) * (0.5 * kInvPi);
    const double root = p + std::sqrt(std::max(p * p + 2 * slope * mass, 0.0));
    const double d = root > 0 ? knots_[i] + 2 * mass / root : knots_[i];
    return {std::min(d, knots_[i + 1]), 2 - std::min(d, knots_[i + 1])};
  }
  double invert_angle(const warp::PolarAngle& angle) const override {
    const std::size_t i = piece(angle.one_minus_cos);
    const double t = std::min(angle.one_minus_cos - knots_[i], width(i));
    const double slope = (means_[i + 1] - means_[i]) / width(i);
    return warp::clamp_unit(cdf_[i] + 2 * kPi * t * (means_[i] + 0.5 * slope * t));
  }

  std::vector<double> knots_, means_, cdf_;  // 1 − cosθ; density; its integral
  std::vector<RGB> values_;
};

}  // namespace

std::shared_ptr<const PhaseFunction> make_table_phase(PhaseTable table) {
  check(table);
  return std::make_shared<TablePhase>(std::move(table));
}

std::shared_ptr<const PhaseFunction> make_tabulated_phase(const std::vector<double>& values) {
  PhaseTable table;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double last = static_cast<double>(values.size()) - 1;
    table.one_minus_cos.push_back(2 * static_cast<double>(i) / last);
    table.values.emplace_back(values[values.size() - 1 - i]);
  }
  return make_table_phase(std::move(table));
}

}  // namespace fogbow
