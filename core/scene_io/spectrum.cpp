// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/spectrum.h"

#include <algorithm>
#include <cmath>

#include "core/scene_io/cie_tables.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/parse_values.h"

namespace fogbow {

namespace {

constexpr std::size_t kMaxSamples = 1 << 20;
/// Mitsuba's quadrature: points, ∫ȳ dλ, and D65 in units of its own white.
constexpr int kSteps = 1000;
constexpr double kLuminousIntegral = 106.7502593994140625, kD65 = 98.9974228;
constexpr std::string_view kSpace = " \t\r\n";

RGB xyz_to_rgb(const Vec3& c) {
  return {3.240479 * c.x - 1.537150 * c.y - 0.498535 * c.z,
          -0.969256 * c.x + 1.875991 * c.y + 0.041556 * c.z,
          0.055648 * c.x - 0.204043 * c.y + 1.057311 * c.z};
}

cie::Row observer(double wavelength) {
  const double at = (wavelength - cie::kFirst) / cie::kStep;
  const auto i = std::min(static_cast<std::size_t>(at), cie::kTable.size() - 2);
  const double f = at - static_cast<double>(i);
  const cie::Row &a = cie::kTable[i], &b = cie::kTable[i + 1];
  const auto mix = [f](double p, double q) { return p + f * (q - p); };
  return {mix(a.x, b.x), mix(a.y, b.y), mix(a.z, b.z), mix(a.d65, b.d65)};
}

/// Of a function of the wavelength.
template <class Spectrum>
RGB integrate(Spectrum&& value, bool emission) {
  Vec3 xyz(0);
  for (int i = 0; i < kSteps; ++i) {
    const double wavelength = cie::kFirst + i * (cie::kLast - cie::kFirst) / (kSteps - 1);
    const cie::Row row = observer(wavelength);
    const double light = emission ? 1 : row.d65 / kD65;
    xyz += value(wavelength) * light * Vec3(row.x, row.y, row.z);
  }
  return xyz_to_rgb(xyz * ((cie::kLast - cie::kFirst) / kSteps / kLuminousIntegral));
}

void append(std::vector<SpectrumSample>& samples, const SpectrumSample& next,
            const SourceLocation& where) {
  if (!(next.wavelength > 0))
    throw Error(ErrorKind::Scene, where, "a wavelength must be greater than zero");
  if (!samples.empty() && !(next.wavelength > samples.back().wavelength))
    throw Error(ErrorKind::Scene, where, "the wavelengths of a spectrum must increase");
  if (samples.size() >= kMaxSamples)
    throw Error(ErrorKind::Scene, where,
                "a spectrum of more than " + std::to_string(kMaxSamples) + " values");
  samples.push_back(next);
}

void skip(std::string_view& text, std::string_view characters) {
  text.remove_prefix(std::min(text.find_first_not_of(characters), text.size()));
}

}  // namespace

std::vector<SpectrumSample> parse_spectrum(std::string_view text, const SourceLocation& where) {
  std::vector<SpectrumSample> samples;
  std::string_view rest = text;
  skip(rest, kSpace);
  while (!rest.empty()) {
    SpectrumSample sample{};
    bool good = consume_number(rest, sample.wavelength);
    skip(rest, kSpace);
    good = good && rest.starts_with(':');
    if (good) rest.remove_prefix(1);
    skip(rest, kSpace);
    if (!good || !consume_number(rest, sample.value))
      throw Error(ErrorKind::Scene, where,
                  "expected pairs \"wavelength:value\", found " + quote(text));
    append(samples, sample, where);
    skip(rest, " \t\r\n,");
  }
  if (samples.empty()) throw Error(ErrorKind::Scene, where, "a spectrum without values");
  return samples;
}

std::vector<SpectrumSample> parse_spd(std::string_view text, const std::string& file) {
  std::vector<SpectrumSample> samples;
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view rest = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const SourceLocation where{file, line, 1};
    rest = rest.substr(0, rest.find('#'));
    if (rest.find_first_not_of(kSpace) == std::string_view::npos) continue;
    const std::vector<double> numbers = parse_numbers(rest, where);
    if (numbers.size() != 2)
      throw Error(ErrorKind::Scene, where,
                  "expected a wavelength and a value, found " + quote(rest));
    append(samples, {numbers[0], numbers[1]}, where);
  }
  if (samples.empty())
    throw Error(ErrorKind::Scene, SourceLocation{file, 1, 1}, "a spectrum without values");
  return samples;
}

RGB spectrum_to_rgb(const std::vector<SpectrumSample>& samples, bool emission) {
  std::size_t next = 0;  // the first sample beyond the wavelength, which increases
  return integrate(
      [&](double wavelength) {
        while (next < samples.size() && samples[next].wavelength < wavelength) ++next;
        if (next == samples.size()) return 0.0;
        const SpectrumSample& b = samples[next];
        if (b.wavelength == wavelength) return b.value;
        if (next == 0) return 0.0;
        const SpectrumSample& a = samples[next - 1];
        return a.value +
               (wavelength - a.wavelength) / (b.wavelength - a.wavelength) * (b.value - a.value);
      },
      emission);
}

RGB equal_energy_to_rgb(double value) { return xyz_to_rgb(Vec3(value)); }

/// Planck's law, CODATA 2018.
RGB blackbody_to_rgb(double temperature) {
  constexpr double kPlanck = 6.62607015e-34, kLight = 299792458, kBoltzmann = 1.380649e-23;
  return integrate(
      [&](double nanometres) {
        const double wavelength = 1e-9 * nanometres;
        const double x = kPlanck * kLight / (wavelength * kBoltzmann * temperature);
        return 1e-9 * 2 * kPlanck * sqr(kLight) / (std::pow(wavelength, 5) * std::expm1(x));
      },
      true);
}

}  // namespace fogbow
