// SPDX-License-Identifier: GPL-3.0-or-later
#include "media/registry.h"

#include "media/media.h"

namespace fogbow {

namespace {

std::shared_ptr<const PhaseFunction> isotropic(Properties&) { return make_isotropic_phase(); }

std::shared_ptr<const PhaseFunction> hg(Properties& p) {
  const double g = p.number("g", 0.8);
  if (!(g > -1 && g < 1)) p.fail("g", "\"g\" must lie strictly between -1 and 1");
  return make_henyey_greenstein(g);
}

/// `scale` multiplies sigma_t alone. `emission` is ours (Mitsuba 3.9.1 has none): emitted radiance
/// per unit length, not scaled.
std::shared_ptr<const Medium> homogeneous(Properties& p) {
  for (const char* absent : {"material", "sigma_s", "sigma_a"})
    if (p.has(absent))
      p.fail(absent, std::string("\"") + absent +
                         "\" is not supported yet: give \"sigma_t\" and \"albedo\"");
  const double scale = p.number("scale", 1);
  if (!(scale >= 0)) p.fail("scale", "\"scale\" must not be negative");
  const RGB sigma_t = scale * p.color("sigma_t", RGB(1));
  const RGB albedo = p.color("albedo", RGB(0.75), 1);
  const RGB emission = p.color("emission", RGB(0));
  // How Mitsuba samples; it changes no picture.
  p.boolean("sample_emitters", true);
  p.boolean("has_spectral_extinction", true);
  auto phase = p.take_one<PhaseFunction>();
  if (!phase) phase = make_isotropic_phase();
  return make_homogeneous_medium(sigma_t, albedo, std::move(phase), emission, p.id());
}

}  // namespace

const MediaRegistry& builtin_media() {
  static const MediaRegistry registry{
      {{"homogeneous", homogeneous}},
      {{"isotropic", isotropic}, {"hg", hg}},
  };
  return registry;
}

}  // namespace fogbow
