// SPDX-License-Identifier: GPL-3.0-or-later
// Bump and normal maps: the nested BSDF in another shading frame.
#include <stdexcept>
#include <utility>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// The axes that normal maps refer to, in the shading frame.
Frame map_axes(const SurfacePoint& x) {
  const Vec2 u = u_axis(x);
  return {Vec3(u, 0), Vec3(-u.y, u.x, 0), Vec3(0, 0, 1)};
}

/// The unit normal that a normal map encodes.
struct NormalMap {
  std::shared_ptr<const Texture> texture;
  static constexpr const char* kName = "normalmap";

  Vec3 operator()(const SurfacePoint& x) const {
    const Vec3 n = 2.0 * texture->color(x) - Vec3(1);
    return length(n) > 0 ? map_axes(x).to_world(normalize(n)) : Vec3(0, 0, 1);
  }
};

/// That of the surface with a height added along its normal, whose own curvature is left out.
struct BumpMap {
  std::shared_ptr<const Texture> texture;
  double scale;
  static constexpr const char* kName = "bumpmap";

  Vec3 operator()(const SurfacePoint& x) const {
    if (!x.shape) return {0, 0, 1};
    const Vec2 slope = scale * texture->gradient(x);
    const auto tangents = x.shape->uv_tangents(x);
    const Vec3& n = x.shading.n;
    const Vec3 u = tangents[0] + n * (slope.x - dot(n, tangents[0]));
    const Vec3 v = tangents[1] + n * (slope.y - dot(n, tangents[1]));
    const Vec3 across = cross(u, v);
    if (!(length(across) > 0) || !is_finite(across)) return {0, 0, 1};
    const Vec3 bumped = normalize(across);
    return x.shading.to_local(dot(bumped, x.n_g) < 0 ? -bumped : bumped);
  }
};

/// A BSDF around the normal that Map gives, in the shading frame. With `flip`, one that looks away
/// from the viewer is turned about the shading normal; with `shadowing`, light at grazing angles is
/// dimmed as by microfacets that are as steep (Conty Estevez et al. 2019). Both as in
/// Mitsuba 3.9.1.
template <class Map, class Base>
class Perturbed final : public Base {
 public:
  Perturbed(std::shared_ptr<const Bsdf> nested, Map map, const PerturbationSettings& settings)
      : nested_(std::move(nested)), map_(std::move(map)), settings_(settings) {}

  bool has_smooth() const override { return true; }
  bool has_passage() const override { return nested_->has_passage(); }
  RGB passage(const SurfacePoint& x, const Vec3& w) const override {
    return nested_->passage(x, w);
  }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    const Frame frame = frame_of(x, w_eye);
    const Vec3 light = frame.to_local(w_light), eye = frame.to_local(w_eye);
    if (!(light.z * w_light.z > 0 && eye.z * w_eye.z > 0)) return RGB(0);
    // Light arrives at the perturbed surface: its cosine in place of the other's.
    return nested_->f_s(within(x, frame), light, eye) *
           (light.z / w_light.z * shadowing(frame.n, w_light));
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    const Frame frame = frame_of(x, from);
    const Vec3 a = frame.to_local(from), b = frame.to_local(to);
    return a.z * from.z > 0 && b.z * to.z > 0 ? nested_->pdf_sigma(within(x, frame), a, b) : 0.0;
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    const Frame frame = frame_of(x, from);
    const Vec3 a = frame.to_local(from);
    if (!(a.z * from.z > 0)) return std::nullopt;
    auto result = nested_->sample(within(x, frame), a, u);
    if (!result) return std::nullopt;
    const Vec3 to = frame.to_world(result->w);
    if (!(to.z * result->w.z > 0)) return std::nullopt;
    return BsdfSample{to, false, pdf_sigma(x, from, to)};
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (dirac || !(pdf_sigma(x, from, to) > 0)) return std::nullopt;
    const Frame frame = frame_of(x, from);
    return nested_->invert(within(x, frame), frame.to_local(from), frame.to_local(to), false,
                           auxiliary);
  }

  double eta() const override { return nested_->eta(); }
  RGB albedo(const SurfacePoint& x) const override { return nested_->albedo(x); }
  const char* name() const override { return Map::kName; }

 private:
  Frame frame_of(const SurfacePoint& x, const Vec3& viewer) const {
    Vec3 n = map_(x);
    if (settings_.flip_invalid_normals && !(dot(n, viewer) * viewer.z > 0)) n = {-n.x, -n.y, n.z};
    return Frame(n);
  }
  /// The point as the nested BSDF sees it.
  static SurfacePoint within(SurfacePoint x, const Frame& frame) {
    x.shading = {x.shading.to_world(frame.s), x.shading.to_world(frame.t),
                 x.shading.to_world(frame.n)};
    return x;
  }
  double shadowing(const Vec3& n, const Vec3& w) const {
    if (!settings_.shadowing) return 1;
    const double n2 = sqr(n.z), w2 = sqr(w.z);
    const double alpha2 = std::min(0.125 * (1 - n2) / n2, 1.0);
    return 2 / (1 + std::sqrt(1 + alpha2 * (1 - w2) / w2));
  }

  std::shared_ptr<const Bsdf> nested_;
  Map map_;
  PerturbationSettings settings_;
};

template <class Map>
std::shared_ptr<const Bsdf> make_perturbed(std::shared_ptr<const Bsdf> nested, Map map,
                                           const PerturbationSettings& settings) {
  if (!nested || !map.texture)
    throw std::domain_error("a bump or normal map needs a BSDF and a texture");
  // Whoever traces specular vertices takes the normal from the shape.
  if (nested->has_dirac())
    throw std::domain_error(std::string("perfectly specular scattering cannot stand inside ") +
                            Map::kName + " yet: give it a small roughness (\"rough...\")");
  if (dynamic_cast<const ReflectingBsdf*>(nested.get()))
    return std::make_shared<Perturbed<Map, ReflectingBsdf>>(std::move(nested), std::move(map),
                                                            settings);
  return std::make_shared<Perturbed<Map, Bsdf>>(std::move(nested), std::move(map), settings);
}

}  // namespace

std::shared_ptr<const Bsdf> make_normal_map(std::shared_ptr<const Bsdf> nested,
                                            std::shared_ptr<const Texture> normals,
                                            const PerturbationSettings& settings) {
  return make_perturbed(std::move(nested), NormalMap{std::move(normals)}, settings);
}

std::shared_ptr<const Bsdf> make_bump_map(std::shared_ptr<const Bsdf> nested,
                                          std::shared_ptr<const Texture> height, double scale,
                                          const PerturbationSettings& settings) {
  if (!std::isfinite(scale)) throw std::domain_error("the scale of a bump map must be finite");
  return make_perturbed(std::move(nested), BumpMap{std::move(height), scale}, settings);
}

}  // namespace fogbow
