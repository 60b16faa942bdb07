// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/filter.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace fogbow {
namespace {

double require_positive(double value, const char* what) {
  if (!(value > 0) || !std::isfinite(value))
    throw std::domain_error(std::string(what) + " of a reconstruction filter must be positive");
  return value;
}

class BoxFilter final : public ReconstructionFilter {
 public:
  explicit BoxFilter(double radius) : radius_(require_positive(radius, "radius")) {}
  double radius() const override { return radius_; }
  /// Half open, so that with radius 0.5 every point has exactly one pixel.
  double evaluate(double x) const override {
    return x >= -radius_ && x < radius_ ? 1 / (2 * radius_) : 0.0;
  }
  double integral(double x) const override {
    return (std::clamp(x, -radius_, radius_) + radius_) / (2 * radius_);
  }
  const char* name() const override { return "box"; }

 private:
  double radius_;
};

class TentFilter final : public ReconstructionFilter {
 public:
  explicit TentFilter(double radius) : radius_(require_positive(radius, "radius")) {}
  double radius() const override { return radius_; }
  double evaluate(double x) const override {
    return std::max(0.0, 1 - std::fabs(x) / radius_) / radius_;
  }
  double integral(double x) const override {
    const double t = std::clamp(x / radius_, -1.0, 1.0);
    return t < 0 ? 0.5 * sqr(1 + t) : 1 - 0.5 * sqr(1 - t);
  }
  const char* name() const override { return "tent"; }

 private:
  double radius_;
};

/// Cut at four standard deviations and lowered by its value there, so that it ends continuously.
class GaussianFilter final : public ReconstructionFilter {
 public:
  explicit GaussianFilter(double stddev)
      : stddev_(require_positive(stddev, "stddev")),
        radius_(4 * stddev),
        offset_(std::exp(-0.5 * sqr(radius_ / stddev))),
        norm_(1 / raw_integral(radius_)) {}
  double radius() const override { return radius_; }
  double evaluate(double x) const override {
    return norm_ * std::max(0.0, std::exp(-0.5 * sqr(x / stddev_)) - offset_);
  }
  double integral(double x) const override {
    return norm_ * raw_integral(std::clamp(x, -radius_, radius_));
  }
  const char* name() const override { return "gaussian"; }

 private:
  double raw_integral(double x) const {
    const double a = 1 / (std::numbers::sqrt2 * stddev_);
    const double erfs = std::erf(a * x) + std::erf(a * radius_);
    return 0.5 * std::sqrt(kPi) / a * erfs - offset_ * (x + radius_);
  }

  double stddev_, radius_, offset_, norm_;
};

}  // namespace

std::unique_ptr<ReconstructionFilter> make_box_filter(double radius) {
  return std::make_unique<BoxFilter>(radius);
}
std::unique_ptr<ReconstructionFilter> make_tent_filter(double radius) {
  return std::make_unique<TentFilter>(radius);
}
std::unique_ptr<ReconstructionFilter> make_gaussian_filter(double stddev) {
  return std::make_unique<GaussianFilter>(stddev);
}

}  // namespace fogbow
