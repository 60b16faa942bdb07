// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "tests/helpers/closed_forms.h"
#include "tests/statistical/closed_forms_cases.h"

namespace fogbow::testing {

// Pixel values of the scenes in tests/statistical/scenes; derivations stand there.

/// The same everywhere.
ExpectedPixels constant_pixels(int width, int height, const RGB& value);

struct Ball {
  Vec3 center;
  double radius;
};
/// A film of Mitsuba's lookat.
struct View {
  Vec3 origin, target, up;
  double fov_x_degrees;

  /// Between world and PixelGrid's directions.
  Vec3 to_world(const Vec3& camera_direction) const;
  Vec3 to_camera(const Vec3& world_direction) const;
  /// constant_pixels without those in which one of `balls` is seen, by a scan of each pixel.
  ExpectedPixels pixels_beside(int width, int height, const RGB& value,
                               const std::vector<Ball>& balls) const;
};

ExpectedPixels half_space_pixels(int width, int height, double fov, double albedo);
enum class SlabSide { Lit, Dark };
ExpectedPixels slab_pixels(int width, int height, double fov, SlabSide side);
ExpectedPixels airlight_pixels(int width, int height, double near);
ExpectedPixels fresnel_plate_pixels(int width, int height);
/// Lit by the light, and with `mirrored` by its image as well.
ExpectedPixels plane_mirror_pixels(int width, int height, bool mirrored);
/// Of the light itself, and with `caustic` what the ball reflects and refracts once.
ExpectedPixels ball_caustic_pixels(int width, int height, bool caustic);

enum class Facets { Ggx, Beckmann };
ExpectedPixels rough_conductor_pixels(int width, int height, Facets facets);
ExpectedPixels rough_dielectric_pixels(int width, int height, Facets facets);

}  // namespace fogbow::testing
