// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "core/math/frame.h"
#include "core/math/vec.h"

/// The laws of every sampling routine: sample, pdf and invert are one triple (validation.md, item
/// 1).
namespace fogbow::testing {

/// ∫f over the box [lo, hi], adaptively, to about `tolerance`.
double integrate(const std::function<double(const Vec2&)>& f, const Vec2& lo, const Vec2& hi,
                 double tolerance);

/// The space that is sampled, seen as the unit square; points are Vec3, their unused coordinates
/// zero.
struct Chart {
  std::function<Vec3(const Vec2&)> point;
  std::function<Vec2(const Vec3&)> coordinates;
  std::function<double(const Vec2&)> jacobian;  ///< measure of the space over area of the square
  int columns = 32, rows = 32;                  ///< of the grid on which samples are counted
};

/// Directions around the frame's z axis: the equator is a grid line, cells are of equal solid
/// angle.
Chart sphere_chart(const Frame& frame = Frame());
/// The same, half of the grid within 1 − cosθ < `width` of the axis (1 is the sphere_chart): for
/// lobes around it.
Chart lobe_chart(const Frame& frame, double width);
Chart box_chart(const Vec2& lo, const Vec2& hi);
/// One dimension; hi may be infinite, then half of the cells lie within `scale` of lo.
Chart interval_chart(double lo, double hi, double scale = 1);

struct Triple {
  int dimensions;  ///< of u that are used: the first 1, 2 or 3
  std::function<std::optional<Vec3>(const Vec3& u)> sample;
  std::function<double(const Vec3& x)> pdf;
  std::function<std::optional<Vec3>(const Vec3& x, const Vec3& auxiliary)> invert;
};

struct TripleOptions {
  /// What the density integrates to; nothing: at most one, and samples are lost at the rate that it
  /// says.
  std::optional<double> mass = 1;
  int samples = 200000;
  /// Of sample(invert(x)) = x, relative to max(1, |x|), beyond what a few units in the last place
  /// of u move x.
  double tolerance = 1e-11;
};

/// What is wrong with a triple, in words; empty if nothing is. Checked are: the mass of the
/// density, the counts of samples against it cell by cell, samples where it is zero,
/// sample(invert(x)) = x for samples and for points spread over the space, and the law of
/// invert(sample(u)) with fresh auxiliaries.
std::string check_triple(const std::string& name, const Triple& triple, const Chart& chart,
                         const TripleOptions& options = {});

}  // namespace fogbow::testing
