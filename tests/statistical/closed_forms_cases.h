// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/math/vec.h"

namespace fogbow::testing {

/// Row-major; nothing where the closed form says nothing of the pixel.
using ExpectedPixels = std::vector<std::optional<RGB>>;

/// An estimator that samples every class of a closed form.
struct Sampler {
  /// The long test goes on to an error of 0.1%, or where that is dear only to 0.3%.
  enum class Price { kCheap, kCostly, kLongOnly };

  std::string integrator;
  double samples;  ///< thousands, after which all errors that are bounded are about 0.7%
  Price price = Price::kCheap;
};

/// A scene whose pixels are known without rendering.
struct ClosedForm {
  std::string name, scene;
  std::map<std::string, std::string> definitions;
  std::function<ExpectedPixels(int width, int height)> expected;
  /// Paths of all lengths belong to it: what max_depth cuts off must be negligible.
  bool all_lengths;
  std::vector<Sampler> samplers;
  std::string not_sampled;  ///< which estimators are left out, and why
};

const std::vector<ClosedForm>& closed_forms();

}  // namespace fogbow::testing
