// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "core/scene/bsdf/bsdfs.h"
#include "tests/helpers/triples.h"

namespace fogbow::testing {

/// BSDFs without textures look the same at every point.
inline const SurfacePoint kAnyPoint{};

inline Vec3 direction(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

/// The smooth part of a BSDF seen from one direction.
inline Triple bsdf_triple(std::shared_ptr<const Bsdf> bsdf, const Vec3& from) {
  return {3,
          [=](const Vec3& u) -> std::optional<Vec3> {
            const auto sample = bsdf->sample(kAnyPoint, from, u);
            if (!sample || sample->dirac) return std::nullopt;
            return sample->w;
          },
          [=](const Vec3& to) { return bsdf->pdf_sigma(kAnyPoint, from, to); },
          [=](const Vec3& to, const Vec3& auxiliary) {
            return bsdf->invert(kAnyPoint, from, to, false, auxiliary);
          }};
}

/// Fresnel's reflectance from the amplitudes as optics books write them, by angles: shares nothing
/// with the engine's.
double textbook_fresnel(double cos_i, double n_i, double n_t);

}  // namespace fogbow::testing
