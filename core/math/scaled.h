// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>

#include "core/math/vec.h"

namespace fogbow {

/// A product of many non-negative factors, mantissa · 2^exponent: paths of hundreds of vertices, in
/// any unit of length, neither overflow nor vanish. T is double or RGB.
template <class T>
class ScaledProduct {
 public:
  ScaledProduct() = default;
  explicit ScaledProduct(const T& value) : mantissa_(value) { settle(); }

  ScaledProduct& operator*=(const T& factor) {
    mantissa_ *= factor;
    settle();
    return *this;
  }
  friend ScaledProduct operator*(ScaledProduct a, const ScaledProduct& b) {
    a.mantissa_ *= b.mantissa_;
    a.exponent_ += b.exponent_;
    a.settle();
    return a;
  }

  const T& mantissa() const { return mantissa_; }
  int exponent() const { return exponent_; }

 private:
  static double size(double v) { return v; }
  static double size(const RGB& v) { return v.x + v.y + v.z; }
  /// Zero and what is not finite stay as they are.
  void settle() {
    constexpr double kLarge = 0x1p+200, kSmall = 0x1p-200;
    const double s = size(mantissa_);
    if ((s >= kSmall && s <= kLarge) || !(s > 0) || std::isinf(s)) return;
    const int e = std::ilogb(s), half = e / 2;
    mantissa_ *= std::ldexp(1.0, -half);  // 2^−e itself overflows where s is subnormal
    mantissa_ *= std::ldexp(1.0, half - e);
    exponent_ += e;
  }

  T mantissa_{1};
  int exponent_ = 0;
};

inline double log(const ScaledProduct<double>& p) {
  return std::log(p.mantissa()) + p.exponent() * 0x1.62e42fefa39efp-1;  // ln 2
}

/// A sum of such products.
class ScaledSum {
 public:
  void add(const ScaledProduct<double>& p, double weight = 1) {
    if (!(weight * p.mantissa() > 0)) return;
    if (sum_ == 0 || p.exponent() > exponent_) {
      sum_ = sum_ == 0 ? 0 : std::ldexp(sum_, exponent_ - p.exponent());
      exponent_ = p.exponent();
    }
    sum_ += std::ldexp(weight * p.mantissa(), p.exponent() - exponent_);
  }
  /// −∞ for nothing.
  double log() const { return std::log(sum_) + exponent_ * 0x1.62e42fefa39efp-1; }
  bool empty() const { return sum_ == 0; }

 private:
  double sum_ = 0;
  int exponent_ = 0;
};

}  // namespace fogbow
