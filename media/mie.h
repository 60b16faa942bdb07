// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <complex>
#include <span>
#include <utility>
#include <vector>

#include "core/math/vec.h"
#include "media/table_phase.h"

namespace fogbow {

/// Cross sections over that of the sphere's disk, and the mean cosine of scattering.
struct MieEfficiencies {
  double extinction, scattering, backscattering, asymmetry;
};

/// Scattering of a plane wave by a homogeneous sphere (Bohren and Huffman 1983, ch. 4).
class MieSphere {
 public:
  /// x = 2πr/λ > 0; the index relative to the surroundings, with a positive imaginary part where
  /// the sphere absorbs. Throws std::domain_error on anything else.
  MieSphere(double x, std::complex<double> index);

  double x() const { return x_; }
  const MieEfficiencies& efficiencies() const { return efficiencies_; }
  /// S₁ and S₂, eq. 4.74.
  std::pair<std::complex<double>, std::complex<double>> amplitudes(double cos_theta) const;

  /// cₙ(aₙ + bₙ) and cₙ(aₙ − bₙ), cₙ = (2n + 1)/(n(n + 1)), from n = 1 on: factors of πₙ + τₙ in
  /// S₁ + S₂ and of πₙ − τₙ in S₁ − S₂.
  struct Term {
    std::complex<double> sum, difference;
  };
  std::span<const Term> terms() const { return terms_; }

 private:
  double x_;
  std::vector<Term> terms_;
  MieEfficiencies efficiencies_{};
};

/// Droplets of one substance; radii are lognormal in number: ln r is normal with mean ln radius and
/// standard deviation spread.
struct DropletSettings {
  double radius = 10;   ///< median, µm
  double spread = 0.2;  ///< 0: all of one size
  /// Wavelengths of the three bands in air, nm: the dominant wavelengths of Rec. 709's primaries
  /// with respect to D65.
  RGB wavelengths{611, 549, 464};
  std::complex<double> index[3];  ///< relative to air, by channel
};

/// Index of refraction of water relative to air, 20 °C (Sellmeier's formula by Daimon and Masumura
/// `wavelength` in nm, from 182 to 1129.
double water_index(double wavelength);
inline constexpr double kWaterShortest = 182, kWaterLongest = 1129;
/// With water's index at the wavelengths. Water absorbs next to nothing in the visible: k is 2e-9
/// at 550 nm (Hale and Querry 1973), a droplet of 10 µm scatters all but a millionth.
DropletSettings water_droplets(double radius, double spread);

/// Means over the sizes, each weighted by its cross section.
struct DropletOptics {
  RGB extinction;  ///< mean cross section over mean disk
  RGB albedo, asymmetry;
};

/// The scattering by droplets of all sizes; throws std::domain_error on impossible settings and on
/// droplets too large to be added up in reasonable time.
class Droplets {
 public:
  explicit Droplets(const DropletSettings& settings);

  const DropletOptics& optics() const { return optics_; }
  /// f_p at each of the angles.
  std::vector<RGB> f_p(std::span<const double> one_minus_cos) const;
  /// Angles so close that linear interpolation in cosθ errs by less than 1e-3 of f_p, or of 1e-5
  /// where f_p is smaller yet.
  PhaseTable table() const;

 private:
  struct Size {
    MieSphere sphere;
    double weight;  ///< in f_p = Σ weight · |S₁ ± S₂|² summed over both signs
  };
  void add_sizes(const DropletSettings& settings, int channel);

  std::vector<Size> sizes_[3];
  DropletOptics optics_{};
  double median_x_ = 0;  ///< half of the light is scattered by greater droplets
};

}  // namespace fogbow
