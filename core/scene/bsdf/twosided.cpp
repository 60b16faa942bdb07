// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

Vec3 flip(const Vec3& w) { return {w.x, w.y, -w.z}; }

/// Seen from behind, a surface is that of its back, mirrored at the tangent plane.
class TwoSided final : public ReflectingBsdf {
 public:
  TwoSided(std::shared_ptr<const Bsdf> front, std::shared_ptr<const Bsdf> back)
      : front_(std::move(front)), back_(back ? std::move(back) : front_) {
    for (const auto& side : {front_, back_})
      if (dynamic_cast<const ReflectingBsdf*>(side.get()) == nullptr)
        throw std::domain_error("twosided needs a BSDF that only reflects");
  }

  bool has_smooth() const override { return front_->has_smooth() || back_->has_smooth(); }
  bool has_dirac() const override { return front_->has_dirac() || back_->has_dirac(); }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return w_light.z > 0 ? front_->f_s(x, w_light, w_eye)
                         : back_->f_s(x, flip(w_light), flip(w_eye));
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    return from.z > 0 ? front_->pdf_sigma(x, from, to) : back_->pdf_sigma(x, flip(from), flip(to));
  }
  /// Nothing is transmitted: where f is not black both directions are on one side.
  BsdfValue evaluate(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return w_light.z > 0 ? front_->evaluate(x, w_light, w_eye)
                         : back_->evaluate(x, flip(w_light), flip(w_eye));
  }
  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return w_light.z > 0 ? front_->f_dirac(x, w_light, w_eye)
                         : back_->f_dirac(x, flip(w_light), flip(w_eye));
  }
  double pdf_dirac(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    return from.z > 0 ? front_->pdf_dirac(x, from, to) : back_->pdf_dirac(x, flip(from), flip(to));
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    if (from.z > 0) return front_->sample(x, from, u);
    auto sample = back_->sample(x, flip(from), u);
    if (sample) sample->w = flip(sample->w);
    return sample;
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    return from.z > 0 ? front_->invert(x, from, to, dirac, auxiliary)
                      : back_->invert(x, flip(from), flip(to), dirac, auxiliary);
  }

  RGB albedo(const SurfacePoint& x) const override { return front_->albedo(x); }
  const char* name() const override { return "twosided"; }

 private:
  std::shared_ptr<const Bsdf> front_, back_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_twosided(std::shared_ptr<const Bsdf> front,
                                          std::shared_ptr<const Bsdf> back) {
  return std::make_shared<TwoSided>(std::move(front), std::move(back));
}

}  // namespace fogbow
