// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "core/scene/bsdf.h"
#include "core/scene/texture.h"

namespace fogbow {

enum class MicrofacetKind { Beckmann, Ggx };

/// Roughness below 1e-4 is taken as 1e-4, as in Mitsuba 3.
struct RoughnessSettings {
  MicrofacetKind kind = MicrofacetKind::Beckmann;
  Textured<double> alpha_u = 0.1, alpha_v = 0.1;
};

// All throw std::domain_error on reflectances or tints outside [0, 1], roughness or indices that
// are negative or not finite, and nesting that makes no sense.

/// One-sided, as all reflecting BSDFs: black from behind.
std::shared_ptr<const Bsdf> make_diffuse(const Textured<RGB>& reflectance);
/// The same on both sides, or two; both must reflect only.
std::shared_ptr<const Bsdf> make_twosided(std::shared_ptr<const Bsdf> front,
                                          std::shared_ptr<const Bsdf> back = nullptr);
/// `eta`: interior over exterior index; the exterior's own counts where volumes overlap.
std::shared_ptr<const Bsdf> make_dielectric(double eta,
                                            const Textured<RGB>& specular_reflectance = RGB(1),
                                            const Textured<RGB>& specular_transmittance = RGB(1),
                                            double n_exterior = 1);
/// Complex index eta + i k per channel, relative to the exterior; eta = 0 and k = 1 in all channels
/// is a perfect mirror (material "none").
std::shared_ptr<const Bsdf> make_conductor(const Textured<RGB>& eta, const Textured<RGB>& k,
                                           const Textured<RGB>& specular_reflectance = RGB(1));
std::shared_ptr<const Bsdf> make_rough_conductor(
    const RoughnessSettings& roughness, const Textured<RGB>& eta, const Textured<RGB>& k,
    const Textured<RGB>& specular_reflectance = RGB(1));
/// `eta` must not be 1.
std::shared_ptr<const Bsdf> make_rough_dielectric(
    const RoughnessSettings& roughness, double eta,
    const Textured<RGB>& specular_reflectance = RGB(1),
    const Textured<RGB>& specular_transmittance = RGB(1), double n_exterior = 1);
/// Diffuse under a smooth coat of relative index `eta`; `nonlinear` tints every reflection between
/// the two.
std::shared_ptr<const Bsdf> make_plastic(double eta, bool nonlinear = false,
                                         const Textured<RGB>& diffuse_reflectance = RGB(0.5),
                                         const Textured<RGB>& specular_reflectance = RGB(1));
/// The same under a rough coat; the roughness must be one number.
std::shared_ptr<const Bsdf> make_rough_plastic(const RoughnessSettings& roughness, double eta,
                                               bool nonlinear = false,
                                               const Textured<RGB>& diffuse_reflectance = RGB(0.5),
                                               const Textured<RGB>& specular_reflectance = RGB(1));
/// A pane: reflects, and passes the rest straight through.
std::shared_ptr<const Bsdf> make_thin_dielectric(
    double eta, const Textured<RGB>& specular_reflectance = RGB(1),
    const Textured<RGB>& specular_transmittance = RGB(1));
/// Passes 1 − opacity.
std::shared_ptr<const Bsdf> make_mask(std::shared_ptr<const Bsdf> nested,
                                      const Textured<double>& opacity = 0.5);
/// (1 − weight) of the first and `weight` of the second.
std::shared_ptr<const Bsdf> make_blend(std::shared_ptr<const Bsdf> first,
                                       std::shared_ptr<const Bsdf> second,
                                       const Textured<double>& weight = 0.5);
/// Lambertian and a lobe cosⁿ around the mirror image, (n + 2)/2π in height (Lafortune and Willems
/// 1994).
std::shared_ptr<const Bsdf> make_phong(const Textured<double>& exponent = 30.0,
                                       const Textured<RGB>& diffuse_reflectance = RGB(0.5),
                                       const Textured<RGB>& specular_reflectance = RGB(0.2));
/// Lambertian facets of Gaussian slopes, alpha their standard deviation times √2 (Oren and Nayar
/// 1994).
std::shared_ptr<const Bsdf> make_rough_diffuse(const Textured<RGB>& reflectance = RGB(0.5),
                                               const Textured<double>& alpha = 0.2,
                                               bool fast_approximation = false);
/// All but eta in [0, 1]; eta is the relative index, not 1.
struct PrincipledSettings {
  Textured<RGB> base_color = RGB(0.5);
  Textured<double> roughness = 0.5, anisotropic = 0.0, metallic = 0.0, spec_trans = 0.0;
  double eta = 1.5;
  Textured<double> spec_tint = 0.0, sheen = 0.0, sheen_tint = 0.0, flatness = 0.0, clearcoat = 0.0,
                   clearcoat_gloss = 0.0;
};
/// Reflects only, unless there is spec_trans. Sheen, and diffuse at grazing angles, can add energy.
std::shared_ptr<const Bsdf> make_principled(const PrincipledSettings& settings = {});
struct PerturbationSettings {
  bool flip_invalid_normals = true;  ///< those that look away from the viewer
  bool shadowing = true;
};
/// Normals from the colors of a texture, x = 2c − 1 along ∂p/∂u. Scattering must be smooth.
std::shared_ptr<const Bsdf> make_normal_map(std::shared_ptr<const Bsdf> nested,
                                            std::shared_ptr<const Texture> normals,
                                            const PerturbationSettings& settings = {});
/// Normals of the surface with a texture times `scale` as height, in units of the world.
std::shared_ptr<const Bsdf> make_bump_map(std::shared_ptr<const Bsdf> nested,
                                          std::shared_ptr<const Texture> height, double scale = 1,
                                          const PerturbationSettings& settings = {});
/// Passes light untouched: an index-matched boundary.
std::shared_ptr<const Bsdf> make_null();

}  // namespace fogbow
