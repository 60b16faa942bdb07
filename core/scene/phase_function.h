// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "core/math/vec.h"

namespace fogbow {

/// What scattering by one angle takes.
struct PhaseValue {
  RGB f_p;
  double pdf_sigma;
};

/// Scattering in a medium. Directions are unit vectors in world space, both pointing away from the
/// vertex: the cosine of the scattering angle is −dot(from, to). Value and density are the same
/// with `from` and `to` exchanged.
class PhaseFunction {
 public:
  virtual ~PhaseFunction() = default;
  /// 1/sr; each channel integrates to one over the sphere.
  virtual RGB f_p(const Vec3& from, const Vec3& to) const = 0;
  virtual double pdf_sigma(const Vec3& from, const Vec3& to) const = 0;
  /// Both at once.
  virtual PhaseValue evaluate(const Vec3& from, const Vec3& to) const {
    return {f_p(from, to), pdf_sigma(from, to)};
  }
  /// u.x chooses the lobe, u.y and u.z the direction.
  virtual Vec3 sample(const Vec3& from, const Vec3& u) const = 0;
  /// Some u with sample(from, u) = to, drawn by the uniform auxiliaries from its exact conditional
  /// law given (from, to); nothing where the density is zero.
  virtual std::optional<Vec3> invert(const Vec3& from, const Vec3& to,
                                     const Vec3& auxiliary) const = 0;
  /// Mean cosine of the scattering angle, averaged over the channels.
  virtual double mean_cosine() const = 0;
};

}  // namespace fogbow
