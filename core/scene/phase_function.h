// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/vec.h"

namespace fogbow {

/// Scattering in a medium. Directions are unit vectors in world space, both pointing away from the
/// vertex: the cosine of the scattering angle is −dot(from, to). Reciprocal.
class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;
  /// 1/sr; integrates to one over the sphere.
  virtual RGB f_p(const Vec3& from, const Vec3& to) const = 0;
  virtual double pdf_sigma(const Vec3& from, const Vec3& to) const = 0;
  virtual Vec3 sample(const Vec3& from, const Vec2& u) const = 0;
  /// The u with sample(from, u) = to.
  virtual Vec2 invert(const Vec3& from, const Vec3& to) const = 0;
  /// Mean cosine of the scattering angle.
  virtual double mean_cosine() const = 0;
};

}  // namespace fogbow
