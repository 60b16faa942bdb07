// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"

namespace fogbow {
namespace {

class AreaEmitter final : public Emitter {
 public:
  AreaEmitter(std::shared_ptr<const Shape> shape, const RGB& radiance)
      : shape_(std::move(shape)), radiance_(require_radiance(radiance)) {}

  EmitterKind kind() const override { return EmitterKind::Area; }
  void bind_shape(std::uint32_t shape) override { shape_id_ = shape; }
  RGB power() const override { return kPi * shape_->area() * radiance_; }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    const SurfacePoint x = shape_->sample(Vec2(u));
    return EmitterPoint{x, {shape_id_, x.primitive}, 1 / shape_->area()};
  }
  double pdf_position(const EmitterPoint&) const override { return 1 / shape_->area(); }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    return Vec3(shape_->invert(x.surface), auxiliary.z);
  }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const override {
    const Vec3 w = warp::sample_cosine_hemisphere(u);
    return {Frame(x.surface.n_g).to_world(w), x.surface.position, warp::pdf_cosine_hemisphere(w)};
  }
  double pdf_direction(const EmitterPoint& x, const Vec3& w) const override {
    return std::max(dot(w, x.surface.n_g), 0.0) * kInvPi;
  }
  std::optional<Vec2> invert_direction(const EmitterPoint& x,
                                       const EmitterDirection& d) const override {
    const Vec3 w = Frame(x.surface.n_g).to_local(d.w);
    if (!(w.z > 0)) return std::nullopt;
    return warp::invert_cosine_hemisphere(w);
  }

  RGB L_e(const EmitterPoint& x, const Vec3& w) const override {
    return dot(w, x.surface.n_g) > 0 ? radiance_ : RGB(0);
  }

 private:
  std::shared_ptr<const Shape> shape_;
  RGB radiance_;
  std::uint32_t shape_id_ = PrimitiveId::kNone;
};

}  // namespace

std::shared_ptr<Emitter> make_area_emitter(std::shared_ptr<const Shape> shape,
                                           const RGB& radiance) {
  return std::make_shared<AreaEmitter>(std::move(shape), radiance);
}

}  // namespace fogbow
