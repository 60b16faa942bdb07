// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>

#include "core/geometry/shape.h"
#include "core/math/vec.h"

namespace fogbow {

struct BsdfSample {
  Vec3 w;            ///< sampled direction, local
  bool dirac;        ///< sampled from the Dirac part
  double pdf_sigma;  ///< what pdf_sigma or pdf_dirac answers for it
};

/// Everything that scattering between two directions takes.
struct BsdfValue {
  RGB f{0};
  double pdf_to_light = 0, pdf_to_eye = 0;  ///< of w_light given w_eye and of w_eye given w_light
};

/// Scattering at a surface. Directions are unit vectors in the local shading frame (n = +z,
/// exterior side), both pointing away from the surface; `w_light` goes towards the light, `w_eye`
/// towards the eye, `from`/`to` name them where a formula does not care which is which. Values are
/// those of radiance: f_s(w_light → w_eye) carries the (n_eye/n_light)² of refraction whatever the
/// direction of sampling. Sampling does not depend on the direction of transport. The correction
/// for shading normals is not the BSDF's (see measurement.h).
class Bsdf {
 public:
  virtual ~Bsdf() = default;

  /// Which parts are there; a `null` surface has neither.
  virtual bool has_smooth() const = 0;
  virtual bool has_dirac() const { return false; }
  /// Whether light can pass straight through: a factor on edges, never a vertex.
  virtual bool has_passage() const { return false; }
  /// That factor, in [0, 1], the same for w and −w; f_s and f_dirac hold what does not pass. Free
  /// flight stops here with probability 1 − passage, channel by channel.
  virtual RGB passage(const SurfacePoint&, const Vec3& /*w*/) const { return RGB(0); }

  /// The part that is a function, 1/sr, without cosine.
  virtual RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const = 0;
  /// Density of `to` by sample() given `from` in solid angle, the choice of lobe included; the
  /// Dirac part is left out.
  virtual double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const = 0;

  /// The Dirac part, with the deltas cancelled: f_s = C n_eye² δ and pdf = P n_to² |cosθ_to| δ with
  /// one and the same δ, where C is F or 1 − F times the tint, P the probability of the event, and
  /// n the index of refraction on the side of the direction (relative: exterior 1, interior η).
  /// Ratios of paths with the same degenerate vertices, hence MIS weights and f/p, are then exact.
  /// `w_light`, `w_eye` are assumed to be related by reflection (same side) or refraction.
  virtual RGB f_dirac(const SurfacePoint&, const Vec3& /*w_light*/, const Vec3& /*w_eye*/) const {
    return RGB(0);
  }
  virtual double pdf_dirac(const SurfacePoint&, const Vec3& /*from*/, const Vec3& /*to*/) const {
    return 0;
  }

  /// All three of the smooth part, or of the Dirac part, at once; densities may be left out where f
  /// is black.
  virtual BsdfValue evaluate(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const {
    const RGB f = f_s(x, w_light, w_eye);
    if (is_black(f)) return {};
    return {f, pdf_sigma(x, w_eye, w_light), pdf_sigma(x, w_light, w_eye)};
  }
  BsdfValue evaluate_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const {
    const RGB f = f_dirac(x, w_light, w_eye);
    if (is_black(f)) return {};
    return {f, pdf_dirac(x, w_eye, w_light), pdf_dirac(x, w_light, w_eye)};
  }

  /// u.x chooses lobe or event, u.y and u.z the direction; nothing where no direction comes out
  /// (absorbed).
  virtual std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                           const Vec3& u) const = 0;
  /// Some u with sample(from, u) = to, of the Dirac or of the smooth part, drawn by the uniform
  /// auxiliaries from its exact conditional law given (from, to); nothing where the density is
  /// zero.
  virtual std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to,
                                     bool dirac, const Vec3& auxiliary) const = 0;

  /// Index of refraction of the interior over that of the exterior; 1 where nothing refracts.
  virtual double eta() const { return 1; }
  /// Index of refraction of the exterior itself, where the BSDF knows it.
  virtual double n_exterior() const { return 1; }
  /// The same surface between other (different) indices of refraction; null where that is not
  /// defined.
  virtual std::shared_ptr<const Bsdf> between(double /*n_interior*/, double /*n_exterior*/) const {
    return nullptr;
  }
  /// Of the microfacets that all smooth scattering comes from; 1 where it does not come from such.
  virtual double roughness() const { return 1; }
  /// Hemispherical reflectance or tint, for albedo layers and hints only.
  virtual RGB albedo(const SurfacePoint& x) const = 0;
  /// Name of the plugin, for reports.
  virtual const char* name() const = 0;
};

}  // namespace fogbow
