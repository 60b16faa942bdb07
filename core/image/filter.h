// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "core/math/vec.h"

namespace fogbow {

/// A separable reconstruction filter in pixel units, symmetric, with integral one.
/// The constructors below throw std::domain_error on a width that is not positive.
class ReconstructionFilter {
 public:
  virtual ~ReconstructionFilter() = default;
  virtual double radius() const = 0;
  virtual double evaluate(double x) const = 0;  ///< one dimension
  /// ∫ evaluate from −infinity to x.
  virtual double integral(double x) const = 0;
  virtual const char* name() const = 0;
};

std::unique_ptr<ReconstructionFilter> make_box_filter(double radius = 0.5);
std::unique_ptr<ReconstructionFilter> make_tent_filter(double radius = 1);
/// Radius four standard deviations.
std::unique_ptr<ReconstructionFilter> make_gaussian_filter(double stddev = 0.5);

}  // namespace fogbow
