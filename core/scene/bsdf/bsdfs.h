// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>

#include "core/scene/bsdf.h"

namespace fogbow {

enum class MicrofacetKind { Beckmann, Ggx };

/// Roughness below 1e-4 is taken as 1e-4, as in Mitsuba 3.
struct RoughnessSettings {
  MicrofacetKind kind = MicrofacetKind::Beckmann;
  double alpha_u = 0.1, alpha_v = 0.1;
};

// All throw std::domain_error on reflectances or tints outside [0, 1], roughness or indices that
// are negative or not finite, and nesting that makes no sense.

/// One-sided, as all reflecting BSDFs: black from behind.
std::shared_ptr<const Bsdf> make_diffuse(const RGB& reflectance);
/// The same on both sides, or two; both must reflect only.
std::shared_ptr<const Bsdf> make_twosided(std::shared_ptr<const Bsdf> front,
                                          std::shared_ptr<const Bsdf> back = nullptr);
/// `eta`: interior over exterior index.
std::shared_ptr<const Bsdf> make_dielectric(double eta, const RGB& specular_reflectance = RGB(1),
                                            const RGB& specular_transmittance = RGB(1));
/// Complex index eta + i k per channel, relative to the exterior; eta = 0 and k = 1 in all channels
/// is a perfect mirror (material "none").
std::shared_ptr<const Bsdf> make_conductor(const RGB& eta, const RGB& k,
                                           const RGB& specular_reflectance = RGB(1));
std::shared_ptr<const Bsdf> make_rough_conductor(const RoughnessSettings& roughness, const RGB& eta,
                                                 const RGB& k,
                                                 const RGB& specular_reflectance = RGB(1));
/// `eta` must not be 1.
std::shared_ptr<const Bsdf> make_rough_dielectric(const RoughnessSettings& roughness, double eta,
                                                  const RGB& specular_reflectance = RGB(1),
                                                  const RGB& specular_transmittance = RGB(1));
/// Passes light untouched: an index-matched boundary.
std::shared_ptr<const Bsdf> make_null();

}  // namespace fogbow
