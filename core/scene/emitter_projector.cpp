// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "core/scene/brightness_grid.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"
#include "core/scene/perspective_projection.h"
#include "core/scene/point_light.h"

namespace fogbow {
namespace {

PerspectiveSettings film_of(const Textured<RGB>& irradiance, const Transform& to_world,
                            double fov_x_degrees) {
  PerspectiveSettings s;
  s.to_world = to_world;
  s.fov_x_degrees = fov_x_degrees;
  const auto [width, height] = irradiance.resolution();
  s.width = width;
  s.height = height;
  return s;
}

/// The reverse of a pinhole camera: a plane across the axis gets what the picture says.
class ProjectorEmitter final : public PointLight {
 public:
  ProjectorEmitter(Textured<RGB> irradiance, const Transform& to_world, double fov_x_degrees,
                   double scale)
      : PointLight(to_world.point(Vec3(0))),
        irradiance_(std::move(irradiance)),
        projection_(film_of(irradiance_, to_world, fov_x_degrees)),
        // In Mitsuba 3.9.1 the irradiance at distance one of the world is π times the picture's,
        // and grows with the scale of to_world.
        scale_(kPi * scale * projection_.scale()),
        grid_([this](const Vec2& uv) { return picture(uv); }) {}

  RGB power() const override { return scale_ * grid_.mean() / projection_.pdf_sigma(1); }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const override {
    const Vec2 uv = grid_.sample(u);
    const Vec3 w = projection_.to_world(normalize(Vec3(projection_.tangent(uv), 1)));
    return {w, position(), pdf_direction(x, w)};
  }
  double pdf_direction(const EmitterPoint&, const Vec3& w) const override {
    const auto uv = on_picture(w);
    return uv ? grid_.pdf(*uv) * projection_.pdf_sigma(projection_.cos_axis(w)) : 0.0;
  }
  std::optional<Vec2> invert_direction(const EmitterPoint&,
                                       const EmitterDirection& d) const override {
    const auto uv = on_picture(d.w);
    if (!uv) return std::nullopt;
    return grid_.invert(*uv);
  }

  RGB L_e(const EmitterPoint&, const Vec3& w) const override {
    const auto uv = on_picture(w);
    const double c = projection_.cos_axis(w);
    return uv ? scale_ / (c * c * c) * picture(*uv) : RGB(0);
  }

 private:
  std::optional<Vec2> on_picture(const Vec3& w) const {
    const Vec3 c = projection_.to_camera(w);
    if (!(c.z > 0)) return std::nullopt;
    return projection_.raster(Vec2(c) / c.z);
  }
  RGB picture(const Vec2& uv) const {
    SurfacePoint x;
    x.uv = uv;
    return irradiance_(x);
  }

  Textured<RGB> irradiance_;
  PerspectiveProjection projection_;
  double scale_;
  BrightnessGrid grid_;
};

}  // namespace

std::shared_ptr<Emitter> make_projector_emitter(const Textured<RGB>& irradiance,
                                                const Transform& to_world, double fov_x_degrees,
                                                double scale) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw std::domain_error("what an emitter radiates must be finite and not negative");
  return std::make_shared<ProjectorEmitter>(require_radiance(irradiance), to_world, fov_x_degrees,
                                            scale);
}

}  // namespace fogbow
