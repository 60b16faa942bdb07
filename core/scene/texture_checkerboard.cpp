// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>

#include "core/scene/textures.h"

namespace fogbow {
namespace {

class Checkerboard final : public Texture {
 public:
  Checkerboard(const Textured<RGB>& color0, const Textured<RGB>& color1, const Transform& to_uv)
      : color0_(color0), color1_(color1), to_uv_(to_uv) {}

  RGB color(const SurfacePoint& x) const override { return (first(x) ? color0_ : color1_)(x); }
  double number(const SurfacePoint& x) const override {
    return luminance((first(x) ? color1_ : color0_)(x));
  }
  Range range() const override {
    const Range a = color0_.range(), b = color1_.range();
    return {std::min(a.least, b.least), std::max(a.greatest, b.greatest)};
  }
  RGB mean() const override { return 0.5 * (color0_.mean() + color1_.mean()); }

 private:
  /// In a square of the origin's color.
  bool first(const SurfacePoint& x) const {
    const Vec3 p = to_uv_.point(Vec3(x.uv, 0));
    const auto upper = [](double t) { return t - std::floor(t) > 0.5; };
    return upper(p.x) == upper(p.y);
  }

  Textured<RGB> color0_, color1_;
  Transform to_uv_;
};

}  // namespace

std::shared_ptr<const Texture> make_checkerboard_texture(const Textured<RGB>& color0,
                                                         const Textured<RGB>& color1,
                                                         const Transform& to_uv) {
  return std::make_shared<Checkerboard>(color0, color1, to_uv);
}

}  // namespace fogbow
