// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/math/warp.h"
#include "core/scene/brightness_grid.h"
#include "core/scene/emitters.h"
#include "core/scene/parallel_light.h"
#include "core/scene/sun_sky_model.h"

namespace fogbow {
namespace {

/// Orthonormal axes of the sky in the world, z to the zenith.
Mat3 axes_of(const Transform& to_world) {
  const double size = to_world.similarity_scale();
  if (!(size > 0))
    throw std::domain_error("a sky's \"to_world\" may rotate and mirror it, but not stretch it");
  return Mat3(to_world.matrix()) / size;
}

double elevation(const Vec3& local) { return std::atan2(local.z, std::hypot(local.x, local.y)); }

double require_scale(double scale) {
  if (!(scale > 0) || !std::isfinite(scale))
    throw std::domain_error("the scale of sun and sky must be finite and positive");
  return scale;
}

double angle_between(const Vec3& a, const Vec3& b) {
  return 2 * std::atan2(length(a - b), length(a + b));
}

/// The dome is sampled by azimuth and height, which keeps areas.
class SkyEmitter final : public ParallelLight {
 public:
  explicit SkyEmitter(const SunSkySettings& s)
      : axes_(axes_of(s.to_world)),
        sun_(normalize(s.sun_direction) * axes_),
        scale_(require_scale(s.sky_scale)),
        model_(s.turbidity, s.albedo, elevation(sun_)),
        grid_([this](const Vec2& p) { return radiance(direction(p)); }) {}

  EmitterKind kind() const override { return EmitterKind::Infinite; }
  RGB power() const override { return area() * 2.0 * kPi * grid_.mean(); }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    EmitterPoint x = point(-normalize(axes_ * direction(grid_.sample(Vec2(u)))), 0);
    x.pdf_position = pdf_position(x);
    return x;
  }
  double pdf_position(const EmitterPoint& x) const override {
    const Vec3 d = to_sky(x);
    return d.z >= 0 ? grid_.pdf(place(d)) / (2 * kPi) : 0.0;
  }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    const Vec3 d = to_sky(x);
    if (!(d.z >= 0)) return std::nullopt;
    return Vec3(grid_.invert(place(d)), auxiliary.z);
  }

  RGB L_e(const EmitterPoint& x, const Vec3&) const override { return radiance(to_sky(x)); }

 private:
  static Vec3 direction(const Vec2& p) {
    const double phi = 2 * kPi * p.x, sine = std::sqrt(1 - sqr(p.y));
    return {sine * std::cos(phi), sine * std::sin(phi), p.y};
  }
  static Vec2 place(const Vec3& d) { return {warp::invert_azimuth(d.x, d.y), d.z}; }
  Vec3 to_sky(const EmitterPoint& x) const { return -(x.surface.n_g * axes_); }
  RGB radiance(const Vec3& d) const {
    if (!(d.z >= 0)) return RGB(0);
    return scale_ * model_.radiance(d.z, angle_between(d, sun_));
  }

  Mat3 axes_;
  Vec3 sun_;  ///< in the sky's axes
  double scale_;
  SkyModel model_;
  BrightnessGrid grid_;
};

double one_minus_cos(double angle) { return 2 * sqr(std::sin(0.5 * angle)); }

/// Mean of radiance(d) over a disk of the sky.
template <class Radiance>
RGB mean_over_disk(const Vec3& center, double radius, Radiance&& radiance) {
  constexpr int n = 32;
  const Frame frame(center);
  RGB sum(0);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const Vec2 u = (Vec2(i, j) + 0.5) / double(n);
      sum += radiance(frame.to_world(warp::sample_cone(u, one_minus_cos(radius))));
    }
  return sum / double(n * n);
}

/// Cosine of the angle under which the surface of a sun of that radius is seen `angle` from its
/// middle.
double limb_cosine(double angle, double radius) {
  return std::sqrt(std::max(1 - sqr(std::sin(angle) / std::sin(radius)), 0.0));
}

/// The real sun's mean at an elevation; between 2, 5, … and 89 degrees linear, as in Mitsuba 3.9.1.
RGB mean_of_sun(const SunModel& model, double elevation_of_center) {
  constexpr double kFirst = 2, kStep = 3;
  constexpr int kKnots = 30;
  const auto at = [&](int knot) {
    const double e = (kFirst + kStep * knot) * kPi / 180;
    const Vec3 center(std::cos(e), 0, std::sin(e));
    return mean_over_disk(center, SunModel::kRadius, [&](const Vec3& d) {
      return model.radiance(elevation(d), limb_cosine(angle_between(d, center), SunModel::kRadius));
    });
  };
  const double t =
      std::clamp((elevation_of_center * 180 / kPi - kFirst) / kStep, 0.0, kKnots - 1.0);
  const int knot = std::min(static_cast<int>(t), kKnots - 2);
  return (knot + 1 - t) * at(knot) + (t - knot) * at(knot + 1);
}

/// A disk, sampled evenly.
class SunEmitter final : public ParallelLight {
 public:
  explicit SunEmitter(const SunSkySettings& s)
      : axes_(axes_of(s.to_world)),
        frame_(normalize(s.sun_direction)),
        radius_(0.5 * s.sun_aperture_degrees * kPi / 180),
        one_minus_cos_(one_minus_cos(radius_)),
        // A sun of another size shines as much in all.
        scale_(require_scale(s.sun_scale) * one_minus_cos(SunModel::kRadius) / one_minus_cos_),
        limb_darkening_(s.limb_darkening),
        model_(s.turbidity) {
    if (!(s.sun_aperture_degrees > 0 && s.sun_aperture_degrees < 180))
      throw std::domain_error("the sun's aperture must lie between 0 and 180 degrees");
    const double e = elevation(frame_.n * axes_);
    if (!(e >= 0)) throw std::domain_error("the sun must not be below the horizon");
    mean_ = limb_darkening_ ? mean_over_disk(frame_.n, radius_,
                                             [this](const Vec3& d) { return dark_at_the_limb(d); })
                            : scale_ * mean_of_sun(model_, e);
  }

  EmitterKind kind() const override { return EmitterKind::Infinite; }
  RGB power() const override { return area() * 2.0 * kPi * one_minus_cos_ * mean_; }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    const Vec3 d = frame_.to_world(warp::sample_cone(Vec2(u), one_minus_cos_));
    return point(-d, 1 / (2 * kPi * one_minus_cos_));
  }
  double pdf_position(const EmitterPoint& x) const override {
    return warp::pdf_cone(frame_.to_local(-x.surface.n_g), one_minus_cos_);
  }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    const Vec3 local = frame_.to_local(-x.surface.n_g);
    if (!(warp::pdf_cone(local, one_minus_cos_) > 0)) return std::nullopt;
    return Vec3(warp::invert_cone(local, one_minus_cos_), auxiliary.z);
  }

  RGB L_e(const EmitterPoint& x, const Vec3&) const override {
    const Vec3 d = -x.surface.n_g;
    if (!(warp::pdf_cone(frame_.to_local(d), one_minus_cos_) > 0) || (d * axes_).z < 0)
      return RGB(0);
    return limb_darkening_ ? dark_at_the_limb(d) : mean_;
  }

 private:
  RGB dark_at_the_limb(const Vec3& d) const {
    const double cosine = limb_cosine(angle_between(d, frame_.n), radius_);
    return scale_ * model_.radiance(elevation(d * axes_), cosine);
  }

  Mat3 axes_;
  Frame frame_;  ///< around the direction towards the sun
  double radius_, one_minus_cos_, scale_;
  bool limb_darkening_;
  SunModel model_;
  RGB mean_{0};
};

}  // namespace

std::shared_ptr<Emitter> make_sky_emitter(const SunSkySettings& settings) {
  return std::make_shared<SkyEmitter>(settings);
}
std::shared_ptr<Emitter> make_sun_emitter(const SunSkySettings& settings) {
  return std::make_shared<SunEmitter>(settings);
}

}  // namespace fogbow
