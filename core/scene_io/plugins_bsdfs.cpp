// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene_io/conductors.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/ior.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

std::shared_ptr<const Bsdf> diffuse(Properties& p) {
  return make_diffuse(p.textured_color("reflectance", RGB(0.5), 1));
}

std::shared_ptr<const Bsdf> twosided(Properties& p) {
  const auto nested = p.take<Bsdf>();
  if (nested.empty() || nested.size() > 2)
    throw Error(
        ErrorKind::Scene, p.where(),
        "\"twosided\" needs one or two nested bsdfs, found " + std::to_string(nested.size()));
  return make_twosided(nested.front(), nested.size() == 2 ? nested.back() : nullptr);
}

double exterior_index(Properties& p) { return index_of_refraction(p, "ext_ior", "air"); }

double relative_index(Properties& p, const char* fallback = "bk7") {
  const double interior = index_of_refraction(p, "int_ior", fallback);
  return interior / exterior_index(p);
}

std::shared_ptr<const Bsdf> dielectric(Properties& p) {
  const double eta = relative_index(p);
  const auto reflectance = p.textured_color("specular_reflectance", RGB(1), 1);
  return make_dielectric(eta, reflectance, p.textured_color("specular_transmittance", RGB(1), 1),
                         exterior_index(p));
}

struct ComplexIndex {
  Textured<RGB> eta, k;
};

ComplexIndex named_index(Properties& p, const std::string& material) {
  std::vector<std::string> known{"none"};
  for (const NamedConductor& c : named_conductors()) {
    // A channel in which both are clamped to zero reflects all, as in the limit.
    constexpr double kLeast = 1e-6;
    if (material == c.name) return {glm::max(c.eta, RGB(kLeast)), c.k};
    known.emplace_back(c.name);
  }
  p.fail("material", "no index of refraction is known for " + quote(material) +
                         suggestion(material, known) + "; known: " + listed(known));
}

/// A perfect mirror unless a material, or eta or k, are given.
ComplexIndex complex_index(Properties& p) {
  const bool explicit_index = p.given("eta") || p.given("k");
  if (p.has("material")) {
    if (explicit_index) p.fail("material", "give either \"material\", or \"eta\" and \"k\"");
    const std::string material = p.string("material", "none");
    if (material != "none") return named_index(p, material);
  }
  const auto eta = p.textured_color("eta", RGB(0));
  return {eta, p.textured_color("k", RGB(1))};
}

std::shared_ptr<const Bsdf> conductor(Properties& p) {
  const ComplexIndex index = complex_index(p);
  return make_conductor(index.eta, index.k, p.textured_color("specular_reflectance", RGB(1), 1));
}

RoughnessSettings roughness(Properties& p) {
  RoughnessSettings result;
  std::string distribution = p.string("distribution", "beckmann");
  for (char& c : distribution)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (distribution != "beckmann" && distribution != "ggx")
    p.fail("distribution", "expected \"beckmann\" or \"ggx\", found " + quote(distribution));
  result.kind = distribution == "ggx" ? MicrofacetKind::Ggx : MicrofacetKind::Beckmann;
  const bool anisotropic = p.given("alpha_u") || p.given("alpha_v");
  if (anisotropic && (p.given("alpha") || !p.given("alpha_u") || !p.given("alpha_v")))
    p.fail(p.given("alpha_u") ? "alpha_u" : "alpha_v",
           "give either \"alpha\", or both \"alpha_u\" and \"alpha_v\"");
  const auto alpha = [&](const std::string& name) {
    if (!p.given(name) || p.has(name)) return Textured<double>(p.positive_number(name, 0.1));
    return p.textured_number(name, 0.1);
  };
  result.alpha_u = alpha(anisotropic ? "alpha_u" : "alpha");
  result.alpha_v = alpha(anisotropic ? "alpha_v" : "alpha");
  if (!p.boolean("sample_visible", true))
    p.warn("sample_visible",
           "visible normals are sampled always: \"sample_visible\" has no effect");
  return result;
}

std::shared_ptr<const Bsdf> roughconductor(Properties& p) {
  const RoughnessSettings rough = roughness(p);
  const ComplexIndex index = complex_index(p);
  return make_rough_conductor(rough, index.eta, index.k,
                              p.textured_color("specular_reflectance", RGB(1), 1));
}

std::shared_ptr<const Bsdf> roughdielectric(Properties& p) {
  const RoughnessSettings rough = roughness(p);
  const double eta = relative_index(p);
  if (eta == 1) p.fail("int_ior", "the indices of refraction on both sides must differ");
  const auto reflectance = p.textured_color("specular_reflectance", RGB(1), 1);
  return make_rough_dielectric(rough, eta, reflectance,
                               p.textured_color("specular_transmittance", RGB(1), 1),
                               exterior_index(p));
}

std::shared_ptr<const Bsdf> thindielectric(Properties& p) {
  const double eta = relative_index(p);
  const auto reflectance = p.textured_color("specular_reflectance", RGB(1), 1);
  return make_thin_dielectric(eta, reflectance,
                              p.textured_color("specular_transmittance", RGB(1), 1));
}

std::shared_ptr<const Bsdf> plastic(Properties& p) {
  const double eta = relative_index(p, "polypropylene");
  const bool nonlinear = p.boolean("nonlinear", false);
  const auto diffuse = p.textured_color("diffuse_reflectance", RGB(0.5), 1);
  return make_plastic(eta, nonlinear, diffuse, p.textured_color("specular_reflectance", RGB(1), 1));
}

std::shared_ptr<const Bsdf> roughplastic(Properties& p) {
  const RoughnessSettings rough = roughness(p);
  const double eta = relative_index(p, "polypropylene");
  const bool nonlinear = p.boolean("nonlinear", false);
  const auto diffuse = p.textured_color("diffuse_reflectance", RGB(0.5), 1);
  return make_rough_plastic(rough, eta, nonlinear, diffuse,
                            p.textured_color("specular_reflectance", RGB(1), 1));
}

std::shared_ptr<const Bsdf> nested_bsdf(Properties& p) {
  auto nested = p.take_one<Bsdf>();
  if (!nested)
    throw Error(ErrorKind::Scene, p.where(), "\"" + p.plugin() + "\" needs a nested bsdf");
  return nested;
}

PerturbationSettings perturbation(Properties& p) {
  const bool flip = p.boolean("flip_invalid_normals", true);
  return {flip, p.boolean("use_shadowing_function", true)};
}

/// Maps of normals and heights need a picture.
void refuse_attribute(Properties& p, const Texture& texture) {
  if (texture.attribute())
    throw Error(ErrorKind::Scene, p.where(),
                "\"" + p.plugin() + "\" cannot be made of a mesh attribute");
}

std::shared_ptr<const Bsdf> normalmap(Properties& p) {
  const auto normals = p.take<Texture>("normalmap");
  if (!normals)
    throw Error(ErrorKind::Scene, p.where(), "\"normalmap\" needs the texture \"normalmap\"");
  refuse_attribute(p, *normals);
  return make_normal_map(nested_bsdf(p), normals, perturbation(p));
}

std::shared_ptr<const Bsdf> bumpmap(Properties& p) {
  const auto height = p.take_one<Texture>();
  if (!height) throw Error(ErrorKind::Scene, p.where(), "\"bumpmap\" needs a nested texture");
  refuse_attribute(p, *height);
  const double scale = p.number("scale", 1);
  return make_bump_map(nested_bsdf(p), height, scale, perturbation(p));
}

std::shared_ptr<const Bsdf> mask(Properties& p) {
  return make_mask(nested_bsdf(p), p.textured_number("opacity", 0.5, 0, 1));
}

std::shared_ptr<const Bsdf> blendbsdf(Properties& p) {
  const auto nested = p.take<Bsdf>();
  if (nested.size() != 2)
    throw Error(ErrorKind::Scene, p.where(),
                "\"blendbsdf\" needs two nested bsdfs, found " + std::to_string(nested.size()));
  if (!p.given("weight"))
    throw Error(ErrorKind::Scene, p.where(), "\"blendbsdf\" needs the float or texture \"weight\"");
  return make_blend(nested[0], nested[1], p.textured_number("weight", 0, 0, 1));
}

std::shared_ptr<const Bsdf> principled(Properties& p) {
  PrincipledSettings s;
  s.base_color = p.textured_color("base_color", RGB(0.5), 1);
  const auto number = [&](const char* name, double fallback) {
    return p.textured_number(name, fallback, 0, 1);
  };
  s.roughness = number("roughness", 0.5);
  s.anisotropic = number("anisotropic", 0);
  s.metallic = number("metallic", 0);
  s.spec_trans = number("spec_trans", 0);
  s.spec_tint = number("spec_tint", 0);
  s.sheen = number("sheen", 0);
  s.sheen_tint = number("sheen_tint", 0);
  s.flatness = number("flatness", 0);
  s.clearcoat = number("clearcoat", 0);
  s.clearcoat_gloss = number("clearcoat_gloss", 0);
  if (p.has("eta") && p.has("specular")) p.fail("eta", "give either \"eta\" or \"specular\"");
  if (p.has("eta")) {
    s.eta = p.positive_number("eta", 1.5);
    if (s.eta == 1) p.fail("eta", "\"eta\" must not be 1");
    return make_principled(s);
  }
  // 0.08 times `specular` is the reflectance at normal incidence.
  const double specular = p.number("specular", 0.5);
  if (!(specular >= 0 && specular <= 1))
    p.fail("specular", "\"specular\" must lie between 0 and 1");
  s.eta = 2 / (1 - std::sqrt(0.08 * std::max(specular, 1e-3))) - 1;
  return make_principled(s);
}

// Of Mitsuba 0.6, with the names of today; Mitsuba 3 has neither.

std::shared_ptr<const Bsdf> phong(Properties& p) {
  const auto exponent = p.textured_number("exponent", 30);
  const auto diffuse = p.textured_color("diffuse_reflectance", RGB(0.5), 1);
  return make_phong(exponent, diffuse, p.textured_color("specular_reflectance", RGB(0.2), 1));
}

std::shared_ptr<const Bsdf> roughdiffuse(Properties& p) {
  const auto reflectance = p.textured_color("reflectance", RGB(0.5), 1);
  const auto alpha = p.textured_number("alpha", 0.2);
  return make_rough_diffuse(reflectance, alpha, p.boolean("use_fast_approx", false));
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
      {"thindielectric", thindielectric},
      {"plastic", plastic},
      {"roughplastic", roughplastic},
      {"mask", mask},
      {"blendbsdf", blendbsdf},
      {"normalmap", normalmap},
      {"bumpmap", bumpmap},
      {"principled", principled},
      {"phong", phong},
      {"roughdiffuse", roughdiffuse},
      {"null", null},
  };
  return table;
}

}  // namespace fogbow
