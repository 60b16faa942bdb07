// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/brightness_grid.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"

namespace fogbow {
namespace {

/// Shines from the front of a shape; directions are cosine-distributed.
class AreaLight : public Emitter {
 public:
  explicit AreaLight(std::shared_ptr<const Shape> shape) : shape_(std::move(shape)) {}

  EmitterKind kind() const final { return EmitterKind::Area; }
  void bind_shape(std::uint32_t shape) final { shape_id_ = shape; }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const final {
    const Vec3 w = warp::sample_cosine_hemisphere(u);
    return {Frame(x.surface.n_g).to_world(w), x.surface.position, warp::pdf_cosine_hemisphere(w)};
  }
  double pdf_direction(const EmitterPoint& x, const Vec3& w) const final {
    return std::max(dot(w, x.surface.n_g), 0.0) * kInvPi;
  }
  std::optional<Vec2> invert_direction(const EmitterPoint& x,
                                       const EmitterDirection& d) const final {
    const Vec3 w = Frame(x.surface.n_g).to_local(d.w);
    if (!(w.z > 0)) return std::nullopt;
    return warp::invert_cosine_hemisphere(w);
  }

 protected:
  const Shape& shape() const { return *shape_; }
  EmitterPoint point(const Vec2& u, double pdf_position) const {
    EmitterPoint x;
    x.surface = shape_->sample(u);
    x.surface.shape = shape_.get();
    x.id = {shape_id_, x.surface.primitive};
    x.pdf_position = pdf_position;
    return x;
  }

 private:
  std::shared_ptr<const Shape> shape_;
  std::uint32_t shape_id_ = PrimitiveId::kNone;
};

class UniformAreaLight final : public AreaLight {
 public:
  UniformAreaLight(std::shared_ptr<const Shape> shape, const RGB& radiance)
      : AreaLight(std::move(shape)), radiance_(require_radiance(radiance)) {}

  RGB power() const override { return kPi * shape().area() * radiance_; }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    return point(Vec2(u), 1 / shape().area());
  }
  double pdf_position(const EmitterPoint&) const override { return 1 / shape().area(); }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    return Vec3(shape().invert(x.surface), auxiliary.z);
  }

  RGB L_e(const EmitterPoint& x, const Vec3& w) const override {
    return dot(w, x.surface.n_g) > 0 ? radiance_ : RGB(0);
  }

 private:
  RGB radiance_;
};

/// Bright places are likely: the law is one on the square of primary samples that the shape itself
/// maps to its surface evenly, so it fits all shapes.
class TexturedAreaLight final : public AreaLight {
 public:
  TexturedAreaLight(std::shared_ptr<const Shape> shape, Textured<RGB> radiance)
      : AreaLight(std::move(shape)),
        radiance_(std::move(radiance)),
        grid_([this](const Vec2& u) { return radiance_(point(u, 0).surface); }) {}

  RGB power() const override { return kPi * shape().area() * grid_.mean(); }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    EmitterPoint x = point(grid_.sample(Vec2(u)), 0);
    x.pdf_position = pdf_position(x);
    return x;
  }
  double pdf_position(const EmitterPoint& x) const override {
    return grid_.pdf(shape().invert(x.surface)) / shape().area();
  }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    return Vec3(grid_.invert(shape().invert(x.surface)), auxiliary.z);
  }

  RGB L_e(const EmitterPoint& x, const Vec3& w) const override {
    return dot(w, x.surface.n_g) > 0 ? radiance_(x.surface) : RGB(0);
  }

 private:
  Textured<RGB> radiance_;
  BrightnessGrid grid_;
};

}  // namespace

std::shared_ptr<Emitter> make_area_emitter(std::shared_ptr<const Shape> shape,
                                           const Textured<RGB>& radiance) {
  if (radiance.constant())
    return std::make_shared<UniformAreaLight>(std::move(shape), radiance.mean());
  return std::make_shared<TexturedAreaLight>(std::move(shape), require_radiance(radiance));
}

}  // namespace fogbow
