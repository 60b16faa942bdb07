// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/warp.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

class Diffuse final : public ReflectingBsdf {
 public:
  explicit Diffuse(const Textured<RGB>& reflectance)
      : reflectance_(checked_reflectance(reflectance)) {}

  bool has_smooth() const override { return true; }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return w_light.z > 0 && w_eye.z > 0 ? reflectance_(x) * kInvPi : RGB(0);
  }
  double pdf_sigma(const SurfacePoint&, const Vec3& from, const Vec3& to) const override {
    return from.z > 0 ? warp::pdf_cosine_hemisphere(to) : 0.0;
  }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3& from,
                                   const Vec3& u) const override {
    if (!(from.z > 0)) return std::nullopt;
    const Vec3 to = warp::sample_cosine_hemisphere({u.y, u.z});
    if (!(to.z > 0)) return std::nullopt;
    return BsdfSample{to, false, warp::pdf_cosine_hemisphere(to)};
  }
  std::optional<Vec3> invert(const SurfacePoint&, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    if (dirac || !(from.z > 0 && to.z > 0)) return std::nullopt;
    const Vec2 u = warp::invert_cosine_hemisphere(to);
    return Vec3(auxiliary.x, u.x, u.y);
  }

  RGB albedo(const SurfacePoint& x) const override { return reflectance_(x); }
  const char* name() const override { return "diffuse"; }

 private:
  Textured<RGB> reflectance_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_diffuse(const Textured<RGB>& reflectance) {
  return std::make_shared<Diffuse>(reflectance);
}

}  // namespace fogbow
