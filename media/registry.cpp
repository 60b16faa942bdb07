// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/registry.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "media/media.h"
#include "media/mie.h"
#include "media/phase_fit.h"

namespace fogbow {

namespace {

std::shared_ptr<const PhaseFunction> isotropic(Properties&) { return make_isotropic_phase(); }

std::shared_ptr<const PhaseFunction> hg(Properties& p) {
  const double g = p.number("g", 0.8);
  if (!(g > -1 && g < 1)) p.fail("g", "\"g\" must lie strictly between -1 and 1");
  return make_henyey_greenstein(g);
}

std::shared_ptr<const PhaseFunction> rayleigh(Properties&) { return make_rayleigh_phase(); }

/// Ours; Mitsuba has none.
std::shared_ptr<const PhaseFunction> draine(Properties& p) {
  const double g = p.number("g", 0.8), alpha = p.number("alpha", 1);
  if (!(g > -1 && g < 1)) p.fail("g", "\"g\" must lie strictly between -1 and 1");
  if (!(alpha >= 0)) p.fail("alpha", "\"alpha\" must not be negative");
  return make_draine(g, alpha);
}

std::shared_ptr<const PhaseFunction> blendphase(Properties& p) {
  const double weight = p.required_number("weight");
  if (!(weight >= 0 && weight <= 1)) p.fail("weight", "\"weight\" must lie between 0 and 1");
  const auto parts = p.take<PhaseFunction>();
  if (parts.size() != 2)
    throw Error(ErrorKind::Scene, p.where(),
                "phase \"blendphase\" needs two nested phase functions, found " +
                    std::to_string(parts.size()));
  return make_blend_phase(parts[0], parts[1], weight);
}

/// Numbers between commas or space.
std::vector<double> numbers(Properties& p, const std::string& name) {
  constexpr std::size_t kMost = 1 << 20;
  constexpr const char* kSeparators = ", \t\r\n";
  const std::string text = p.required_string(name);
  std::vector<double> result;
  for (std::size_t at = text.find_first_not_of(kSeparators); at != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(kSeparators, at), text.size());
    double value = 0;
    const auto [rest, fault] = std::from_chars(text.data() + at, text.data() + end, value);
    if (fault != std::errc() || rest != text.data() + end)
      p.fail(name, "expected a number in \"" + name + "\", found \"" +
                       text.substr(at, std::min<std::size_t>(end - at, 40)) + "\"");
    if (result.size() == kMost) p.fail(name, "more than " + std::to_string(kMost) + " values");
    result.push_back(value);
    at = text.find_first_not_of(kSeparators, end);
  }
  return result;
}

/// From light that is thrown back to light that goes on straight.
std::shared_ptr<const PhaseFunction> tabphase(Properties& p) {
  try {
    return make_tabulated_phase(numbers(p, "values"));
  } catch (const std::domain_error& error) {
    p.fail("values", error.what());
  }
}

/// Water unless `index` says otherwise.
DropletSettings droplets(Properties& p) {
  DropletSettings s;
  s.radius = p.positive_number("radius", s.radius);
  s.spread = p.number("spread", s.spread);
  if (!(s.spread >= 0 && s.spread <= 1)) p.fail("spread", "\"spread\" must lie between 0 and 1");
  s.wavelengths = p.color("wavelengths", s.wavelengths);
  const RGB k = p.color("k", RGB(0));
  const bool water = !p.has("index");
  const RGB index = p.color("index", RGB(1));
  for (int c = 0; c < 3; ++c) {
    if (!(s.wavelengths[c] >= kWaterShortest && s.wavelengths[c] <= kWaterLongest))
      p.fail("wavelengths", "\"wavelengths\" must lie between 182 and 1129 nm");
    if (!(index[c] > 0)) p.fail("index", "\"index\" must be greater than zero");
    s.index[c] = {water ? water_index(s.wavelengths[c]) : index[c], k[c]};
  }
  return s;
}

std::shared_ptr<const PhaseFunction> mie(Properties& p) {
  const bool compact = p.boolean("compact", false);
  auto table = make_table_phase(Droplets(droplets(p)).table());
  return compact ? make_fitted_phase(fit_phase(*table)) : table;
}

struct Coefficients {
  RGB sigma_t, albedo;
};

/// As Mitsuba 0.6 wrote them, or 3.
Coefficients coefficients(Properties& p) {
  if (!p.has("sigma_s") && !p.has("sigma_a"))
    return {p.color("sigma_t", RGB(1)), p.color("albedo", RGB(0.75), 1)};
  const char* first = p.has("sigma_s") ? "sigma_s" : "sigma_a";
  if (!p.has("sigma_s") || !p.has("sigma_a") || p.has("sigma_t") || p.has("albedo"))
    p.fail(first, "give either \"sigma_t\" and \"albedo\", or \"sigma_s\" and \"sigma_a\"");
  const RGB sigma_s = p.color("sigma_s", RGB(0)), sigma_t = sigma_s + p.color("sigma_a", RGB(0));
  RGB albedo(0);
  for (int c = 0; c < 3; ++c)
    if (sigma_t[c] > 0) albedo[c] = sigma_s[c] / sigma_t[c];
  return {sigma_t, albedo};
}

/// The same extinction wherever a scene may reach, though its albedo varies.
std::shared_ptr<const Medium> with_varying_albedo(Properties& p, double scale,
                                                  std::shared_ptr<const Volume> albedo,
                                                  std::shared_ptr<const PhaseFunction> phase) {
  for (const char* name : {"sigma_s", "sigma_a", "albedo", "emission"})
    if (p.has(name))
      p.fail(name, "\"" + std::string(name) + "\" does not go with an albedo that is a volume");
  const Bounds& box = albedo->bounds();
  constexpr double kFarBeyond = 0x1p40;
  const double reach =
      kFarBeyond * std::max(max_component(glm::abs(box.lo)), max_component(glm::abs(box.hi)));
  HeterogeneousSettings s;
  s.scale = scale;
  s.sigma_t =
      std::make_shared<Volume>(p.color("sigma_t", RGB(1)), Transform::scale(Vec3(2 * reach)) *
                                                               Transform::translate(Vec3(-0.5)));
  s.albedo = std::move(albedo);
  return make_heterogeneous_medium(s, std::move(phase), p.id());
}

/// `scale` multiplies sigma_t alone. `emission` is ours (Mitsuba 3.9.1 has none): emitted radiance
/// per unit length, not scaled.
std::shared_ptr<const Medium> homogeneous(Properties& p) {
  if (p.has("material"))
    p.fail("material", "\"material\" is not supported yet: give \"sigma_t\" and \"albedo\"");
  const double scale = p.number("scale", 1);
  if (!(scale >= 0)) p.fail("scale", "\"scale\" must not be negative");
  // How Mitsuba samples; it changes no picture.
  p.boolean("sample_emitters", true);
  p.boolean("has_spectral_extinction", true);
  auto phase = p.take_one<PhaseFunction>();
  if (!phase) phase = make_isotropic_phase();
  if (auto albedo = p.take<Volume>("albedo"))
    return with_varying_albedo(p, scale, std::move(albedo), std::move(phase));
  const auto [sigma_t, albedo] = coefficients(p);
  const RGB emission = p.color("emission", RGB(0));
  return make_homogeneous_medium(scale * sigma_t, albedo, std::move(phase), emission, p.id());
}

/// A nested volume, or a colour that is the same everywhere.
std::shared_ptr<const Volume> volume(Properties& p, const std::string& name, const RGB& fallback,
                                     double max = kInfinity) {
  if (!p.has(name))
    if (auto nested = p.take<Volume>(name)) return nested;
  return std::make_shared<Volume>(p.color(name, fallback, max));
}

/// Where emission cannot be seen because nothing else tells where flights end.
void warn_of_lost_emission(Properties& p, const HeterogeneousSettings& s) {
  if (is_black(s.scale * s.sigma_t->max()))
    p.warn("emission", "the emission has no effect: sigma_t is zero everywhere");
}

/// As in Mitsuba 3.9.1, but for `emission`, which is ours: a volume or colour, not scaled.
/// `density` is what Mitsuba 0.6 calls sigma_t.
std::shared_ptr<const Medium> heterogeneous(Properties& p) {
  const double scale = p.number("scale", 1);
  if (!(scale >= 0)) p.fail("scale", "\"scale\" must not be negative");
  HeterogeneousSettings s;
  s.scale = scale;
  s.sigma_t = p.take<Volume>("density");
  if (!s.sigma_t) s.sigma_t = volume(p, "sigma_t", RGB(1));
  s.albedo = volume(p, "albedo", RGB(0.75), 1);
  if (p.has("emission") || std::ranges::any_of(p.objects(), [](const NestedObject& o) {
        return o.name == "emission";
      })) {
    s.emission = volume(p, "emission", RGB(0));
    warn_of_lost_emission(p, s);
  }
  // How Mitsuba samples; it changes no picture.
  p.boolean("sample_emitters", true);
  p.boolean("has_spectral_extinction", true);
  auto phase = p.take_one<PhaseFunction>();
  if (!phase) phase = make_isotropic_phase();
  return make_heterogeneous_medium(s, std::move(phase), p.id());
}

}  // namespace

const MediaRegistry& builtin_media() {
  static const MediaRegistry registry{
      {{"homogeneous", homogeneous}, {"heterogeneous", heterogeneous}},
      {{"isotropic", isotropic},
       {"hg", hg},
       {"rayleigh", rayleigh},
       {"draine", draine},
       {"blendphase", blendphase},
       {"tabphase", tabphase},
       {"mie", mie}},
  };
  return registry;
}

}  // namespace fogbow
