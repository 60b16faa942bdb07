// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>
#include <utility>

#include "core/scene/bsdf/bsdfs.h"

namespace fogbow {
namespace {

/// A BSDF with holes: what is not covered passes.
class Mask final : public Bsdf {
 public:
  Mask(std::shared_ptr<const Bsdf> nested, const Textured<double>& opacity)
      : nested_(std::move(nested)), opacity_(opacity) {
    if (!nested_) throw std::domain_error("mask needs a nested BSDF");
    if (const auto range = opacity.range(); !(range.least >= 0 && range.greatest <= 1))
      throw std::domain_error("an opacity must lie in [0, 1]");
  }

  bool has_smooth() const override { return nested_->has_smooth(); }
  bool has_dirac() const override { return nested_->has_dirac(); }
  bool has_passage() const override { return true; }
  RGB passage(const SurfacePoint& x, const Vec3& w) const override {
    const double a = opacity_(x);
    return a * nested_->passage(x, w) + RGB(1 - a);
  }

  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return opacity_(x) * nested_->f_s(x, w_light, w_eye);
  }
  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return opacity_(x) * nested_->f_dirac(x, w_light, w_eye);
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    return nested_->pdf_sigma(x, from, to);
  }
  double pdf_dirac(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    return nested_->pdf_dirac(x, from, to);
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    return nested_->sample(x, from, u);
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    return nested_->invert(x, from, to, dirac, auxiliary);
  }

  double eta() const override { return nested_->eta(); }
  double roughness() const override { return nested_->roughness(); }
  RGB albedo(const SurfacePoint& x) const override { return opacity_(x) * nested_->albedo(x); }
  const char* name() const override { return "mask"; }

 private:
  std::shared_ptr<const Bsdf> nested_;
  Textured<double> opacity_;
};

}  // namespace

std::shared_ptr<const Bsdf> make_mask(std::shared_ptr<const Bsdf> nested,
                                      const Textured<double>& opacity) {
  return std::make_shared<Mask>(std::move(nested), opacity);
}

}  // namespace fogbow
