// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "apps/fogbow/commands.h"
#include "apps/fogbow/console.h"
#include "apps/fogbow/parse.h"
#include "media/mie.h"
#include "media/phase_fit.h"

namespace fogbow::cli {

namespace {

/// A line's two numbers; nothing where there is but space or a comment.
std::optional<Vec2> parse_line(const std::string& line, const SourceLocation& where) {
  std::istringstream words(line.substr(0, line.find('#')));
  std::string angle, value, rest;
  if (!(words >> angle)) return std::nullopt;
  try {
    if (!(words >> value) || words >> rest) throw Error(ErrorKind::Usage, "");
    return Vec2(parse_number(angle, false), parse_number(value, false));
  } catch (const Error&) {
    throw Error(ErrorKind::Scene, where,
                "expected an angle in degrees and a value, found '" + line.substr(0, 80) + "'");
  }
}

/// Angles must rise from 0 to 180; between them values are linear in cosθ.
PhaseTable read_table(const std::string& path) {
  constexpr std::size_t kMostLines = 1 << 20;
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::InputOutput, path + ": cannot be read");
  PhaseTable table;
  SourceLocation where{path, 0, 1};
  double last = -1;
  for (std::string line; std::getline(file, line);) {
    ++where.line;
    if (table.values.size() >= kMostLines) throw Error(ErrorKind::Scene, where, "too many lines");
    const auto entry = parse_line(line, where);
    if (!entry) continue;
    const auto [angle, value] = std::pair(entry->x, entry->y);
    if (!(angle > last && angle <= 180) || (last < 0 && angle != 0))
      throw Error(ErrorKind::Scene, where, "the angles must rise from 0 to 180 degrees");
    last = angle;
    table.one_minus_cos.push_back(angle == 180 ? 2 : 2 * sqr(std::sin(angle * kPi / 360)));
    table.values.emplace_back(value);
  }
  if (file.bad()) throw Error(ErrorKind::InputOutput, path + ": cannot be read");
  if (last != 180)
    throw Error(ErrorKind::Scene, where, "the angles must rise from 0 to 180 degrees");
  return table;
}

DropletSettings settings_of(const FitPhaseArguments& arguments) {
  DropletSettings s;
  s.radius = arguments.radius.value_or(s.radius);
  s.spread = arguments.spread.value_or(s.spread);
  for (int c = 0; c < 3; ++c) {
    if (arguments.wavelengths) s.wavelengths[c] = (*arguments.wavelengths)[c];
    if (!(s.wavelengths[c] >= kWaterShortest && s.wavelengths[c] <= kWaterLongest))
      throw std::domain_error("wavelengths must lie between 182 and 1129 nm");
    s.index[c] = {arguments.index.value_or(water_index(s.wavelengths[c])), arguments.k.value_or(0)};
  }
  return s;
}

void print_droplets(const DropletSettings& s, const DropletOptics& optics) {
  std::printf("droplets         median radius %g um, deviation of ln radius %g\n", s.radius,
              s.spread);
  const auto line = [](const char* name, const RGB& value) {
    std::printf("%-16s %.6g, %.6g, %.6g\n", name, value.x, value.y, value.z);
  };
  line("wavelengths", s.wavelengths);
  line("index", {s.index[0].real(), s.index[1].real(), s.index[2].real()});
  line("extinction", optics.extinction);  // cross section over disk
  line("albedo", optics.albedo);
  line("mean cosine", optics.asymmetry);
}

void print_fit(const PhaseFit& fit) {
  std::printf("fit              %.6g HG(g %.6g) + %.6g Draine(g %.6g, alpha %.6g)\n",
              1 - fit.weight, fit.g_hg, fit.weight, fit.g_draine, fit.alpha);
  std::printf("error            %.4f rms of ln over angles; HG(g %.6g) alone: %.4f\n", fit.error,
              fit.hg_alone, fit.hg_error);
}

void print_xml(const PhaseFit& fit) {
  std::printf(
      "<phase type=\"blendphase\"><float name=\"weight\" value=\"%.9g\"/>\n"
      "  <phase type=\"hg\"><float name=\"g\" value=\"%.9g\"/></phase>\n"
      "  <phase type=\"draine\"><float name=\"g\" value=\"%.9g\"/><float name=\"alpha\" "
      "value=\"%.9g\"/></phase>\n"
      "</phase>\n",
      fit.weight, fit.g_hg, fit.g_draine, fit.alpha);
}

PhaseFit fit(const FitPhaseArguments& arguments) {
  if (!arguments.table.empty()) return fit_phase(*make_table_phase(read_table(arguments.table)));
  const DropletSettings settings = settings_of(arguments);
  const Droplets droplets(settings);
  if (!arguments.xml) print_droplets(settings, droplets.optics());
  return fit_phase(*make_table_phase(droplets.table()));
}

}  // namespace

ExitCode run_fit_phase(const FitPhaseArguments& arguments) try {
  const PhaseFit result = fit(arguments);
  if (!arguments.xml) print_fit(result);
  print_xml(result);
  return ExitCode::Done;
} catch (const std::domain_error& error) {
  if (arguments.table.empty()) throw Error(ErrorKind::Usage, error.what());
  throw Error(ErrorKind::Scene, arguments.table + ": " + error.what());
}

}  // namespace fogbow::cli
