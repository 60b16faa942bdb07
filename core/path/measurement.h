// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/path/transport.h"
#include "core/path/vertex.h"

namespace fogbow {

// The factors of f_j, each a function of the path alone [Jakob2013, ch. 3].

/// |N_g·w| on surfaces and lenses, 1 in media, at pinholes, point lights, at infinity and on films
/// that see parallel rays.
double D(const Scene& scene, const Vertex& x, const Vec3& w);

/// D_a D_b / ‖a−b‖², with w from a to b; visibility and transmittance are the edge's. At an
/// infinite or parallel end D_b alone, the measure there being one of directions.
double geometric_term(const Scene& scene, const Vertex& a, const Vertex& b, const Edge& a_to_b);

/// f̂: BSDF with the correction for shading normals [Veach1997, eq. 5.17], or σ_s f_p; both
/// directions away from x. For `degenerate` scattering the Dirac value whose delta cancels in
/// ratios (see bsdf.h).
RGB f_hat(const Scene& scene, const Vertex& x, const Vec3& w_light, const Vec3& w_eye,
          bool degenerate);

/// Emitted radiance of x₁ along w; for an infinite light `w` is where its light travels.
RGB L_e(const Scene& scene, const Vertex& x, const Vec3& w);

/// W_e without the pixel filter, along w away from the sensor.
double W_e(const Scene& scene, const Vertex& x, const Vec3& w);

/// Everything that sampling needs to know of scattering at x: f̂ and the densities in solid angle of
/// going on to either side.
struct Scattering {
  RGB f_hat{0};
  double pdf_to_light = 0;                            ///< of w_light given w_eye, roulette included
  double pdf_to_eye = 0;                              ///< of w_eye given w_light, roulette included
  double survival_to_light = 0, survival_to_eye = 0;  ///< the roulette's part of them
};
/// `behind_specular`: the neighbour on the eye's side is degenerate. Only the eye's subpath can
/// have gone on from x then, no connection could replace it, and its roulette spares it.
Scattering scatter(const Scene& scene, const Vertex& x, const Vec3& w_light, const Vec3& w_eye,
                   bool degenerate, bool behind_specular);

/// Which end a subpath starts from.
enum class Side : std::uint8_t { Light, Eye };

/// A direction drawn at x; absorption and roulette have been survived.
struct DirectionSample {
  Vec3 w;
  bool degenerate;
  Scattering scattering;
};
/// `from` is the direction to the previous vertex; u = (lobe, direction, direction), v the
/// roulette's.
std::optional<DirectionSample> sample_direction(const Scene& scene, const Vertex& x,
                                                const Vec3& from, Side side, const Vec3& u,
                                                double v, bool behind_specular);

/// Index of refraction on the side of x to which w points, relative to the exterior; 1 off
/// surfaces.
double relative_index(const Scene& scene, const Vertex& x, const Vec3& w);

/// Whether x scatters by microfacets of little roughness, so that a walk may hold the facet as it
/// holds the normal of a mirror.
bool is_glossy(const Scene& scene, const Vertex& x);

/// The facet that scatters w_light into w_eye: its unit normal in the shading frame, on the
/// exterior side.
Vec3 facet_normal(const Scene& scene, const Vertex& x, const Vec3& w_light, const Vec3& w_eye);

/// Where a facet sends what comes from `from`, by reflection or by transmission; nothing where it
/// cannot.
std::optional<Vec3> facet_direction(const Scene& scene, const Vertex& x, const Vec3& from,
                                    bool transmit, const Vec3& facet);

/// |do/dσ(to)| of o = (facet.x, facet.y), `from` being fixed.
double facet_jacobian(const Scene& scene, const Vertex& x, const Vec3& from, const Vec3& to);

/// Where the Dirac part of x's BSDF sends what comes from `from`, by reflection or by transmission;
/// nothing where it has no such part or reflects totally.
std::optional<Vec3> specular_direction(const Scene& scene, const Vertex& x, const Vec3& from,
                                       bool transmit);

/// Whether a subpath may end at x to be connected there.
bool connectible(const Scene& scene, const Vertex& x);

/// From density in solid angle at x (across the ray where x is parallel) to density in μ at y (dA,
/// dV; dσ at infinity), the edge leading from x to y; the distance along the ray is not included.
double to_measure(const Scene& scene, const Vertex& x, const Vertex& y, const Edge& x_to_y,
                  double pdf);

/// Density in μ of y when x₁ emits along the edge (distance along the ray not included).
double pdf_emission(const Scene& scene, const Vertex& x, const Vertex& y, const Edge& x_to_y);

/// Puts a parallel sensor's vertex where it sees `target` from; others stay.
void look_at(const Scene& scene, Vertex& sensor, const Vec3& target);
/// Of a point of the sensor along w away from it: dσ, or dA across the ray where it is parallel.
double pdf_importance(const Scene& scene, const Vertex& x, const Vec3& w);

/// x₁ as its emitter sees it.
EmitterPoint emitter_point(const Vertex& x);
/// Density in μ of choosing this emitter and this position on it (dσ of the direction for infinite
/// lights, 1 where it is Dirac).
double pdf_emitter_position(const Scene& scene, const Vertex& x);

}  // namespace fogbow
