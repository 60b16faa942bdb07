// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <optional>

#include "core/math/ray.h"
#include "core/math/vec.h"

/// Values of light transport known without Monte Carlo. Nothing here calls the engine's layers
/// above math: the oracles share no formula with the code that they judge.
///
/// Two laws need no function.
/// Isothermal cavity: in a closed room where all radiates as a black body of radiance B — surfaces
/// emit (1 − ρ(ω_o)) n² B with ρ(ω_o) = ∫ f_s(ω_i → ω_o) (n_i²/n_o²) dσ^⊥(ω_i), the exact
/// directional albedo, transmission included, and media emit σ_a n² B a unit length — L = n² B at
/// every point and direction. A lossless dielectric has ρ = 1 and emits nothing; a diffuse wall has
/// ρ = reflectance towards every ω_o. Rough conductors and dielectrics that lose energy to multiple
/// scattering between facets have no closed ρ: leave them out, and shading normals with them.
/// Truncating k breaks the law. Conservative enclosure: black walls (ρ = 0) that emit 1, and
/// contents without loss (σ_a = 0, lossless glass): L = n².
namespace fogbow::testing {

// ---- interfaces -------------------------------------------------------------------------------

/// Unpolarized Fresnel reflectance; `eta` is the index beyond the interface over the index before
/// it.
double fresnel_dielectric(double cos_incident, double eta);

struct SlabTransport {
  double reflected, transmitted;
};
/// Plane plate of index n, thickness d and absorption σ_a, all interreflections, without
/// interference. Polarization is averaged at each face, as renderers do; kept apart (Stokes 1862)
/// it would give a slightly smaller R at oblique angles.
SlabTransport fresnel_plate(double cos_incident, double n, double sigma_a_times_d);

/// The transmitted or mirrored direction; nothing at total internal reflection. `normal` either way
/// round; eta as above.
std::optional<Vec3> refract_direction(const Vec3& direction, const Vec3& normal, double eta);
Vec3 mirror_direction(const Vec3& direction, const Vec3& normal);

/// Irradiance (I cosθ/d²) at p with normal n from a point light; zero from behind.
double point_irradiance(const Vec3& p, const Vec3& n, const Vec3& light, double intensity);
/// Image source of a plane mirror.
Vec3 mirror_image(const Vec3& p, const Vec3& plane_point, const Vec3& plane_normal);

// ---- reduced contribution of specular chains: J = |dσ_a / dA⊥_b|, dA⊥ across the last ray ------

struct SpecularLink {
  double jacobian;  ///< J_{a→b}
  Vec3 vertex;      ///< where the chain meets the interface
};
/// a on the positive side of the plane (index n_a), b beyond it (index n_b). Exact to rounding.
SpecularLink flat_refraction(const Vec3& a, const Vec3& b, const Vec3& plane_point,
                             const Vec3& plane_normal, double n_a, double n_b);
SpecularLink flat_mirror(const Vec3& a, const Vec3& b, const Vec3& plane_point,
                         const Vec3& plane_normal);
/// J of any chain by central differences, extrapolated (relative error about 1e-9): `last_ray` maps
/// a direction at a to the ray after the chain, nothing where the chain breaks off; the ray of
/// `direction` passes b.
double jacobian_by_differences(const std::function<std::optional<Ray>(const Vec3&)>& last_ray,
                               const Vec3& direction, const Vec3& b);

// ---- a ball: caustics with known values ---------------------------------------------------------

/// Glass ball (index n over its surroundings), a point light outside and, on the far side of the
/// centre, a plane across the axis.
struct BallCaustic {
  double radius, index;   ///< index ≠ 1
  double light_distance;  ///< from the centre, > radius
  double plane_distance;  ///< from the centre, > radius
  double intensity;       ///< W/sr

  /// Orders of light: kOutside is the reflection at the outer face; m ≥ 0 enters, is reflected m
  /// times inside, and leaves.
  static constexpr int kOutside = -1;

  struct Landing {
    double r;            ///< distance from the axis on the plane, negative beyond the axis
    double dr;           ///< dr/di
    double cos_landing;  ///< with the plane's normal
    double weight;       ///< product of the Fresnel factors
  };
  /// Of the ray that meets the ball under incidence angle i in [0, π/2]; nothing where it never
  /// meets the plane.
  std::optional<Landing> trace(double incidence, int order) const;
  /// Angle from the axis under which that ray leaves the light: sin α = radius/light_distance · sin
  /// i.
  double angle_at_light(double incidence) const;
  /// sinα dα/di: solid angle at the light per incidence and azimuth.
  double solid_angle_density(double incidence) const;

  /// Flux on the disk r < `reach` of one order. Error 1e-9 of the flux that meets the ball.
  double flux_within(double reach, int order) const;
  /// Flux of light that misses the ball.
  double direct_flux_within(double reach) const;
  /// All light, orders up to `max_order`; a ring's mean irradiance is a difference of this over its
  /// area.
  double total_flux_within(double reach, int max_order) const;
  /// Irradiance at r > 0: Σ I w sinα (dα/di) / (r |dr/di|) over all i that land there; infinite on
  /// a fold.
  double irradiance(double r, int order) const;
  /// Light tracing without chance: the middles of `rings` × `azimuths` cells of the lit face, each
  /// with where it lands and the flux of its cell. Sums over a region of the plane or of a picture
  /// converge as 1/rings.
  void visit_landings(int order, int rings, int azimuths,
                      const std::function<void(double x, double y, double flux)>& visit) const;
  /// Of the light that misses the ball, the ball's shadow included.
  double direct_irradiance(double r) const;
};

// ---- single scattering --------------------------------------------------------------------------

/// Henyey–Greenstein, in 1/sr, of the cosine between the directions of propagation.
double henyey_greenstein(double cos_theta, double g);

struct Airlight {
  double sigma_t, sigma_s, g;
  Vec3 light;
  double intensity;

  /// Radiance scattered exactly once towards ray.o from the part (t0, t1) of the ray; light is
  /// attenuated from the point at t0, where the camera ray starts on the near plane. t1 may be
  /// infinite; the light must lie off the ray. Relative error 1e-10.
  double radiance(const Ray& ray, double t0, double t1) const;
};

// ---- film ---------------------------------------------------------------------------------------

/// Mitsuba's perspective film: `fov` horizontal, in degrees; z forward, x to the right and y down
/// the picture; square pixels.
struct PixelGrid {
  double fov_x_degrees;
  int width, height;

  /// Unit direction through a raster position.
  Vec3 direction(double x, double y) const;
  /// The raster position of a direction with z > 0.
  Vec2 raster(const Vec3& direction) const;
  /// Response of the mean of the pixel through which the direction passes, per solid angle:
  /// 1/(pixel area · cos³).
  double importance(const Vec3& direction) const;
  /// Box-filtered pixel by n × n Gauss–Legendre nodes; for radiance that is smooth inside the
  /// pixel.
  double pixel_mean(int x, int y, const std::function<double(const Vec3& direction)>& radiance,
                    int n = 8) const;
};

}  // namespace fogbow::testing
