// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/emitter_radiance.h"
#include "core/scene/emitters.h"
#include "core/scene/point_light.h"

namespace fogbow {
namespace {

/// Directions are uniform in the cone that is lit.
class SpotEmitter final : public PointLight {
 public:
  SpotEmitter(const Vec3& position, const Vec3& axis, const RGB& intensity, double cutoff_degrees,
              double beam_degrees)
      : PointLight(position),
        intensity_(require_radiance(intensity)),
        cutoff_(cutoff_degrees * kPi / 180),
        beam_(beam_degrees * kPi / 180),
        one_minus_cos_(2 * sqr(std::sin(cutoff_ / 2))) {
    if (!is_finite(position) || !is_finite(axis) || !(length(axis) > 0))
      throw std::domain_error("a spot light must be somewhere, and point somewhere");
    if (!(cutoff_degrees > 0 && cutoff_degrees <= 180))
      throw std::domain_error("a spot light's cutoff angle must lie between 0 and 180 degrees");
    if (!(beam_degrees >= 0 && beam_degrees <= cutoff_degrees))
      throw std::domain_error(
          "a spot light's beam width must lie between 0 degrees and the cutoff angle");
    frame_ = Frame(normalize(axis));
  }

  /// A picture to shine through, that spans the cone on a plane across the axis.
  void insert(const Textured<RGB>& slide, const Vec3& u, const Vec3& v) {
    slide_ = require_radiance(slide);
    u_ = normalize(u);
    v_ = normalize(v);
  }

  /// 2π ∫ falloff sinθ dθ: 1 − (sin c − sin b)/(c − b) where it falls.
  RGB power() const override {
    const double width = cutoff_ - beam_;
    // Near enough for a choice among emitters: of a narrow edge one half counts.
    const double solid_angle = width > 1e-6 ? 1 - (std::sin(cutoff_) - std::sin(beam_)) / width
                                            : 1 - std::cos(0.5 * (cutoff_ + beam_));
    return 2 * kPi * solid_angle * slide_.mean() * intensity_;
  }

  EmitterDirection sample_direction(const EmitterPoint&, const Vec2& u) const override {
    const Vec3 w = warp::sample_cone(u, one_minus_cos_);
    return {frame_.to_world(w), position(), 1 / (2 * kPi * one_minus_cos_)};
  }
  double pdf_direction(const EmitterPoint&, const Vec3& w) const override {
    return warp::pdf_cone(frame_.to_local(w), one_minus_cos_);
  }
  std::optional<Vec2> invert_direction(const EmitterPoint&,
                                       const EmitterDirection& d) const override {
    const Vec3 w = frame_.to_local(d.w);
    if (!(warp::pdf_cone(w, one_minus_cos_) > 0)) return std::nullopt;
    return warp::invert_cone(w, one_minus_cos_);
  }

  /// Full within the beam, from there linear in the angle down to nothing at the cutoff.
  RGB L_e(const EmitterPoint&, const Vec3& w) const override {
    const Vec3 local = frame_.to_local(w);
    const double angle = std::atan2(length(Vec3(local.x, local.y, 0)), local.z);
    if (angle <= beam_) return intensity_ * slide(w, local.z);
    if (!(angle < cutoff_)) return RGB(0);
    return (cutoff_ - angle) / (cutoff_ - beam_) * intensity_ * slide(w, local.z);
  }

 private:
  RGB slide(const Vec3& w, double cos_axis) const {
    if (slide_.constant()) return slide_.mean();
    SurfacePoint x;
    x.uv = Vec2(0.5) + 0.5 / (cos_axis * std::tan(cutoff_)) * Vec2(dot(w, u_), dot(w, v_));
    return slide_(x);
  }

  Frame frame_;
  RGB intensity_;
  Textured<RGB> slide_ = RGB(1);
  Vec3 u_{1, 0, 0}, v_{0, 1, 0};  ///< in which its coordinates grow
  double cutoff_, beam_;
  double one_minus_cos_;  ///< of the cutoff angle
};

}  // namespace

std::shared_ptr<Emitter> make_spot_emitter(const Vec3& position, const Vec3& axis,
                                           const RGB& intensity, double cutoff_degrees,
                                           double beam_degrees) {
  return std::make_shared<SpotEmitter>(position, axis, intensity, cutoff_degrees, beam_degrees);
}

std::shared_ptr<Emitter> make_spot_emitter(const Transform& to_world, const RGB& intensity,
                                           double cutoff_degrees, double beam_degrees,
                                           const Textured<RGB>& slide) {
  auto spot = std::make_shared<SpotEmitter>(to_world.point(Vec3(0)), to_world.vector({0, 0, 1}),
                                            intensity, cutoff_degrees, beam_degrees);
  spot->insert(slide, to_world.vector({1, 0, 0}), to_world.vector({0, 1, 0}));
  return spot;
}

}  // namespace fogbow
