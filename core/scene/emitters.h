// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>

#include "core/math/transform.h"
#include "core/scene/emitter.h"
#include "core/scene/medium.h"
#include "core/scene/texture.h"

namespace fogbow {

struct Image;

// All throw std::domain_error on negative or non-finite numbers.

/// Radiance from the front (n_g side) of a shape; directions cosine-distributed, positions uniform
/// or, of a texture, as it is bright.
std::shared_ptr<Emitter> make_area_emitter(std::shared_ptr<const Shape> shape,
                                           const Textured<RGB>& radiance);
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
/// The same at the origin of `to_world` along +z, times a picture whose u and v grow along +x and
/// +y and which spans the cone, as in Mitsuba 3.
std::shared_ptr<Emitter> make_spot_emitter(const Transform& to_world, const RGB& intensity,
                                           double cutoff_degrees, double beam_degrees,
                                           const Textured<RGB>& slide);
/// A picture thrown from the origin of `to_world` along +z, upright as a pinhole camera would see
/// it: a plane across the axis at distance one gets π times the picture's values; the field of view
/// is the picture's horizontal one.
std::shared_ptr<Emitter> make_projector_emitter(const Textured<RGB>& irradiance,
                                                const Transform& to_world, double fov_x_degrees,
                                                double scale = 1);
/// Radiance from beyond the scene as a picture in latitude and longitude: the first row is +y of
/// `to_world`, the middle column +z, and columns to the right of it lie at −x.
std::shared_ptr<Emitter> make_environment_emitter(const Image& image, const Transform& to_world,
                                                  double scale = 1);
struct SunSkySettings {
  double turbidity = 3;         ///< from 1, clear, to 10, hazy
  RGB albedo{0.3};              ///< of the ground
  Vec3 sun_direction{0, 0, 1};  ///< towards it, in the world
  Transform to_world;           ///< its z axis points to the zenith
  double sky_scale = 1, sun_scale = 1;
  double sun_aperture_degrees = 0.5358;
  bool limb_darkening = false;  ///< else the disk is of one color
};
/// The clear sky without its sun, and the sun alone; W/(m² sr nm). Nothing shines from below the
/// horizon; the sun must not stand there.
std::shared_ptr<Emitter> make_sky_emitter(const SunSkySettings& settings);
std::shared_ptr<Emitter> make_sun_emitter(const SunSkySettings& settings);
/// Emission of a medium: positions uniform in `bounds`, or where the medium is heterogeneous as its
/// emission is bounded; nothing where `medium_at` says another medium; directions isotropic. Only
/// points of the medium may be asked about; its pdf_position is 0 outside `bounds`.
std::shared_ptr<Emitter> make_volume_emitter(std::shared_ptr<const Medium> medium,
                                             const Bounds& bounds,
                                             std::function<const Medium*(const Vec3&)> medium_at);

}  // namespace fogbow
