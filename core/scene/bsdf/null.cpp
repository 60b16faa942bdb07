// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/bsdf/bsdfs.h"

namespace fogbow {
namespace {

class Null final : public Bsdf {
 public:
  bool has_smooth() const override { return false; }
  bool has_passage() const override { return true; }
  RGB passage(const SurfacePoint&, const Vec3&) const override { return RGB(1); }
  RGB f_s(const SurfacePoint&, const Vec3&, const Vec3&) const override { return RGB(0); }
  double pdf_sigma(const SurfacePoint&, const Vec3&, const Vec3&) const override { return 0; }
  std::optional<BsdfSample> sample(const SurfacePoint&, const Vec3&, const Vec3&) const override {
    return std::nullopt;
  }
  std::optional<Vec3> invert(const SurfacePoint&, const Vec3&, const Vec3&, bool,
                             const Vec3&) const override {
    return std::nullopt;
  }
  RGB albedo(const SurfacePoint&) const override { return RGB(0); }
  const char* name() const override { return "null"; }
};

}  // namespace

std::shared_ptr<const Bsdf> make_null() { return std::make_shared<Null>(); }

}  // namespace fogbow
