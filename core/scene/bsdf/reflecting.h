// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <stdexcept>

#include "core/math/warp.h"
#include "core/scene/bsdf.h"
#include "core/scene/texture.h"

namespace fogbow {

/// What only reflects, hence may stand inside `twosided`; nothing refracts, and f_s is symmetric.
class ReflectingBsdf : public Bsdf {};

/// Reflects into the hemisphere of `from`, sampled by the cosine.
class CosineSampledBsdf : public ReflectingBsdf {
 public:
  bool has_smooth() const final { return true; }
  double pdf_sigma(const SurfacePoint&, const Vec3& from, const Vec3& to) const final {
    return from.z > 0 ? warp::pdf_cosine_hemisphere(to) : 0.0;
  }
  BsdfValue evaluate(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const final {
    if (!(w_light.z > 0 && w_eye.z > 0)) return {};
    return {f_s(x, w_light, w_eye), warp::pdf_cosine_hemisphere(w_light),
            warp::pdf_cosine_hemisphere(w_eye)};
  }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& from,
                                   const Vec3& u) const final {
    if (!(from.z > 0)) return std::nullopt;
    const Vec3 to = warp::sample_cosine_hemisphere({u.y, u.z});
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, warp::pdf_cosine_hemisphere(to)};
  }
  std::optional<Vec3> invert(const SurfacePoint&, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const final {
    if (dirac || !(from.z > 0 && to.z > 0)) return std::nullopt;
    const Vec2 u = warp::invert_cosine_hemisphere(to);
    return Vec3(auxiliary.x, u.x, u.y);
  }
};

/// The mirror image of w.
inline Vec3 reflect_z(const Vec3& w) { return {-w.x, -w.y, w.z}; }

/// Throws std::domain_error unless 0 ≤ c ≤ 1 in every channel, everywhere.
inline const Textured<RGB>& checked_reflectance(const Textured<RGB>& c) {
  if (const auto range = c.range(); !(range.least >= 0 && range.greatest <= 1))
    throw std::domain_error("a reflectance or transmittance must lie in [0, 1]");
  return c;
}

}  // namespace fogbow
