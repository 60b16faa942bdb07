// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "core/util/error.h"

namespace fogbow {

/// A measured value at a wavelength in nm.
struct SpectrumSample {
  double wavelength, value;
};

// Spectra to linear sRGB through the standard observer, as Mitsuba 3 does it in its rgb variants.
// Results may be negative: not all spectra are colours that a screen shows.

/// "400:0.1, 500:0.2", wavelengths increasing; throws Error(Scene) at `where`.
std::vector<SpectrumSample> parse_spectrum(std::string_view text, const SourceLocation& where);
/// Lines of a wavelength and a value, "#" begins a comment; throws Error(Scene) with the line.
std::vector<SpectrumSample> parse_spd(std::string_view text, const std::string& file);

/// Linear between the samples, zero beyond them. What reflects, absorbs or refracts is seen in the
/// light of D65, what shines (`emission`) as it is.
RGB spectrum_to_rgb(const std::vector<SpectrumSample>& samples, bool emission);
/// Light of equal power at all wavelengths, which is not white: (1.205, 0.948, 0.909) of it.
RGB equal_energy_to_rgb(double value);
/// Spectral radiance of a black body [W/(m² sr nm)] of that temperature in kelvin.
RGB blackbody_to_rgb(double temperature);

}  // namespace fogbow
