// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>

#include "core/scene/emitter.h"
#include "core/scene/medium.h"

namespace fogbow {

// All throw std::domain_error on negative or non-finite numbers.

/// Constant radiance from the front (n_g side) of a shape; directions cosine-distributed.
std::shared_ptr<Emitter> make_area_emitter(std::shared_ptr<const Shape> shape, const RGB& radiance);
/// Isotropic, intensity in W/sr.
std::shared_ptr<Emitter> make_point_emitter(const Vec3& position, const RGB& intensity);
/// The same radiance from everywhere beyond the scene. invert_direction takes any point of the ray
/// as its origin.
std::shared_ptr<Emitter> make_constant_emitter(const RGB& radiance);
/// Emission of a medium: positions uniform in `bounds`, or where the medium is heterogeneous as its
/// emission is bounded; nothing where `medium_at` says another medium; directions isotropic. Only
/// points of the medium may be asked about; its pdf_position is 0 outside `bounds`.
std::shared_ptr<Emitter> make_volume_emitter(std::shared_ptr<const Medium> medium,
                                             const Bounds& bounds,
                                             std::function<const Medium*(const Vec3&)> medium_at);

}  // namespace fogbow
