// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/ior.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

std::shared_ptr<const Bsdf> diffuse(Properties& p) {
  return make_diffuse(p.color("reflectance", RGB(0.5), 1));
}

std::shared_ptr<const Bsdf> twosided(Properties& p) {
  const auto nested = p.take<Bsdf>();
  if (nested.empty() || nested.size() > 2)
    throw Error(
        ErrorKind::Scene, p.where(),
        "\"twosided\" needs one or two nested bsdfs, found " + std::to_string(nested.size()));
  return make_twosided(nested.front(), nested.size() == 2 ? nested.back() : nullptr);
}

double relative_index(Properties& p) {
  const double interior = index_of_refraction(p, "int_ior", "bk7");
  return interior / index_of_refraction(p, "ext_ior", "air");
}

std::shared_ptr<const Bsdf> dielectric(Properties& p) {
  const double eta = relative_index(p);
  const RGB reflectance = p.color("specular_reflectance", RGB(1), 1);
  return make_dielectric(eta, reflectance, p.color("specular_transmittance", RGB(1), 1));
}

struct ComplexIndex {
  RGB eta, k;
};

/// A perfect mirror unless eta or k are given.
ComplexIndex complex_index(Properties& p) {
  const bool explicit_index = p.has("eta") || p.has("k");
  if (p.has("material")) {
    if (explicit_index) p.fail("material", "give either \"material\", or \"eta\" and \"k\"");
    const std::string material = p.string("material", "none");
    if (material != "none")
      p.fail("material", "the conductor " + quote(material) +
                             " is not supported yet; known: \"none\" (or give \"eta\" and \"k\")");
  }
  const RGB eta = p.color("eta", RGB(0));
  return {eta, p.color("k", RGB(1))};
}

std::shared_ptr<const Bsdf> conductor(Properties& p) {
  const ComplexIndex index = complex_index(p);
  return make_conductor(index.eta, index.k, p.color("specular_reflectance", RGB(1), 1));
}

RoughnessSettings roughness(Properties& p) {
  RoughnessSettings result;
  std::string distribution = p.string("distribution", "beckmann");
  for (char& c : distribution)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (distribution != "beckmann" && distribution != "ggx")
    p.fail("distribution", "expected \"beckmann\" or \"ggx\", found " + quote(distribution));
  result.kind = distribution == "ggx" ? MicrofacetKind::Ggx : MicrofacetKind::Beckmann;
  const bool anisotropic = p.has("alpha_u") || p.has("alpha_v");
  if (anisotropic && (p.has("alpha") || !p.has("alpha_u") || !p.has("alpha_v")))
    p.fail(p.has("alpha_u") ? "alpha_u" : "alpha_v",
           "give either \"alpha\", or both \"alpha_u\" and \"alpha_v\"");
  result.alpha_u = p.positive_number(anisotropic ? "alpha_u" : "alpha", 0.1);
  result.alpha_v = p.positive_number(anisotropic ? "alpha_v" : "alpha", 0.1);
  if (!p.boolean("sample_visible", true))
    p.warn("sample_visible",
           "visible normals are sampled always: \"sample_visible\" has no effect");
  return result;
}

std::shared_ptr<const Bsdf> roughconductor(Properties& p) {
  const RoughnessSettings rough = roughness(p);
  const ComplexIndex index = complex_index(p);
  return make_rough_conductor(rough, index.eta, index.k,
                              p.color("specular_reflectance", RGB(1), 1));
}

std::shared_ptr<const Bsdf> roughdielectric(Properties& p) {
  const RoughnessSettings rough = roughness(p);
  const double eta = relative_index(p);
  if (eta == 1) p.fail("int_ior", "the indices of refraction on both sides must differ");
  const RGB reflectance = p.color("specular_reflectance", RGB(1), 1);
  return make_rough_dielectric(rough, eta, reflectance,
                               p.color("specular_transmittance", RGB(1), 1));
}

std::shared_ptr<const Bsdf> null(Properties&) { return make_null(); }

}  // namespace

const PluginTable<std::shared_ptr<const Bsdf>(Properties&)>& bsdf_plugins() {
  static const PluginTable<std::shared_ptr<const Bsdf>(Properties&)> table{
      {"diffuse", diffuse},
      {"twosided", twosided},
      {"dielectric", dielectric},
      {"conductor", conductor},
      {"roughconductor", roughconductor},
      {"roughdielectric", roughdielectric},
      {"null", null},
  };
  return table;
}

}  // namespace fogbow
