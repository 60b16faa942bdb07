// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <vector>

namespace fogbow::testing {

/// Chandrasekhar's H of an isotropically scattering, index-matched half space (Chandrasekhar 1960,
/// ch. IV); error below 1e-10. Single-scattering albedo in [0, 1).
class ChandrasekharH {
 public:
  explicit ChandrasekharH(double albedo);

  double operator()(double mu) const;
  /// f_r = ϖ/(4π) H(μ)H(μ₀)/(μ+μ₀), in 1/sr.
  double brdf(double mu, double mu0) const;
  /// Reflectance for collimated light at μ₀; by reciprocity the radiance seen at μ₀ where radiance
  /// 1 falls in from everywhere.
  double plane_albedo(double mu0) const;

 private:
  double albedo_;
  std::vector<double> nodes_, weights_, h_;
};

/// A plane layer without azimuth: operators on radiances at direction cosines `mu` (Gauss nodes
/// with weights, then nodes of weight 0 where only results are wanted). Row i of `reflect` and
/// `transmit` gives the radiance that leaves at mu[i]; `transmit` holds the ballistic part. Layers
/// are homogeneous, so both faces are alike.
class PlaneLayer {
 public:
  /// Doubling of a layer so thin that it scatters once (van de Hulst 1980). Henyey–Greenstein with
  /// g; optical thickness; albedo ϖ. `split` puts a Gauss panel's end there (a critical cosine).
  /// Errors below 1e-6 for |g| ≤ 0.75.
  PlaneLayer(double albedo, double g, double thickness, std::vector<double> view_cosines,
             double split = 0);

  /// Radiance seen at view cosine i under radiance 1 from all of the viewer's side. By reciprocity
  /// (f_r is symmetric) this is the total reflectance for collimated light falling in along the
  /// view.
  double reflected(int view) const;
  /// The same from the far side, the ballistic exp(−τ/μ) included.
  double transmitted(int view) const;
  /// Radiance seen from outside at normal incidence where the layer is a half space of index n
  /// under radiance 1 from everywhere, Fresnel (unpolarized) at its face; needs view cosine 1 as
  /// view 0 and `split` at critical_cosine(n). By reciprocity the total reflectance. Error below
  /// 3e-6.
  double reflected_under_glass(double n) const;

 private:
  using Matrix = std::vector<double>;
  void start(double albedo, double g, double thickness);
  void double_up();

  int size_ = 0, first_view_ = 0;
  std::vector<double> mu_, weight_;
  Matrix reflect_, transmit_;
};

/// Cosine inside an index-n medium at which internal reflection becomes total.
double critical_cosine(double n);

}  // namespace fogbow::testing
