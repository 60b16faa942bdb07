// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>

#include "core/math/vec.h"
#include "core/scene/bsdf/bsdfs.h"

namespace fogbow {

/// Distribution of microfacet normals around +z, with Smith's masking (Walter et al. 2007) and the
/// exact sampling of the normals that are visible from a direction.
class MicrofacetDistribution {
 public:
  /// Roughness below 1e-4 is taken as 1e-4, as in Mitsuba 3. α_u is that along the unit vector
  /// `u_axis`. Throws std::domain_error if negative or not finite.
  MicrofacetDistribution(MicrofacetKind kind, double alpha_u, double alpha_v,
                         const Vec2& u_axis = Vec2(1, 0));
  /// α_u is that along the surface's ∂p/∂u.
  MicrofacetDistribution(MicrofacetKind kind, double alpha_u, double alpha_v, const SurfacePoint& x)
      : MicrofacetDistribution(kind, alpha_u, alpha_v,
                               alpha_u == alpha_v ? Vec2(1, 0) : fogbow::u_axis(x)) {}

  /// Density of the microfacets' area by normal: ∫ D(h) h_z dσ(h) = 1.
  double D(const Vec3& normal) const;
  /// Share of the microfacets that face a direction and are not masked by others; on either side.
  double G1(const Vec3& direction) const;

  /// Of the normals seen from w (w_z > 0): D(h) G1(w) (w·h)₊ / w_z, in solid angle.
  double pdf_visible(const Vec3& w, const Vec3& h) const {
    return D(h) * G1(w) * std::max(dot(w, h), 0.0) / w.z;
  }
  /// The larger α.
  double roughness() const { return std::max(alpha_.x, alpha_.y); }
  Vec3 sample_visible(const Vec3& w, const Vec2& u) const;
  /// The u with sample_visible(w, u) = h.
  Vec2 invert_visible(const Vec3& w, const Vec3& h) const;

 private:
  /// Components along u, v and the normal, and back.
  Vec3 to_axes(const Vec3& w) const {
    return {u_.x * w.x + u_.y * w.y, u_.x * w.y - u_.y * w.x, w.z};
  }
  Vec3 from_axes(const Vec3& w) const {
    return {u_.x * w.x - u_.y * w.y, u_.x * w.y + u_.y * w.x, w.z};
  }
  /// w in the space where the surface has unit roughness.
  Vec3 stretch(const Vec3& w) const {
    const Vec3 a = to_axes(w);
    return normalize(Vec3(alpha_.x * a.x, alpha_.y * a.y, a.z));
  }

  MicrofacetKind kind_;
  Vec2 alpha_, u_;
  double normalization_;  ///< 1/(π α_u α_v)
};

/// The same where roughness may be textured, or differ with the direction along the surface.
class TexturedFacets {
 public:
  explicit TexturedFacets(const RoughnessSettings& roughness);

  MicrofacetDistribution operator()(const SurfacePoint& x) const {
    if (!varies_) [[likely]]
      return constant_;
    return {settings_.kind, settings_.alpha_u(x), settings_.alpha_v(x), x};
  }
  /// The largest α that there is.
  double roughness() const { return roughness_; }

 private:
  RoughnessSettings settings_;
  MicrofacetDistribution constant_;
  bool varies_;
  double roughness_;
};

}  // namespace fogbow
