// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>

#include "core/math/transform.h"
#include "core/scene/emitter.h"
#include "core/scene/medium.h"

namespace fogbow {

struct Image;

// All throw std::domain_error on negative or non-finite numbers.

/// Constant radiance from the front (n_g side) of a shape; directions cosine-distributed.
std::shared_ptr<Emitter> make_area_emitter(std::shared_ptr<const Shape> shape, const RGB& radiance);
/// Isotropic, intensity in W/sr.
std::shared_ptr<Emitter> make_point_emitter(const Vec3& position, const RGB& intensity);
/// The same radiance from everywhere beyond the scene. invert_direction takes any point of the ray
/// as its origin.
std::shared_ptr<Emitter> make_constant_emitter(const RGB& radiance);
/// Light of one direction of travel; `irradiance` is what a surface across it receives.
/// invert_direction takes any point of the ray as its origin.
std::shared_ptr<Emitter> make_directional_emitter(const Vec3& direction, const RGB& irradiance);
/// From one point; the intensity in W/sr is constant up to the beam width's angle from the axis,
/// then falls linearly with the angle to 0 at the cutoff angle.
std::shared_ptr<Emitter> make_spot_emitter(const Vec3& position, const Vec3& axis,
                                           const RGB& intensity, double cutoff_degrees,
                                           double beam_degrees);
/// Radiance from beyond the scene as a picture in latitude and longitude: the first row is +y of
/// `to_world`, the middle column +z, and columns to the right of it lie at −x.
std::shared_ptr<Emitter> make_environment_emitter(const Image& image, const Transform& to_world,
                                                  double scale = 1);
/// Emission of a medium: positions uniform in `bounds`, or where the medium is heterogeneous as its
/// emission is bounded; nothing where `medium_at` says another medium; directions isotropic. Only
/// points of the medium may be asked about; its pdf_position is 0 outside `bounds`.
std::shared_ptr<Emitter> make_volume_emitter(std::shared_ptr<const Medium> medium,
                                             const Bounds& bounds,
                                             std::function<const Medium*(const Vec3&)> medium_at);

}  // namespace fogbow
