// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/emitter.h"
#include "core/util/check.h"

namespace fogbow {

/// An emitter at infinity: light of each direction comes evenly through a disk across it, which
/// hides the scene.
class ParallelLight : public Emitter {
 public:
  void bind(const Vec3& scene_center, double scene_radius) final {
    FOGBOW_CHECK(is_finite(scene_center) && scene_radius > 0 && std::isfinite(scene_radius));
    center_ = scene_center;
    radius_ = scene_radius;
  }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const final {
    const Frame frame(x.surface.n_g);
    const Vec2 p = radius_ * warp::sample_disk(u);
    return {frame.n, center_ + frame.to_world(Vec3(p, -kStandOff * radius_)), pdf()};
  }
  double pdf_direction(const EmitterPoint&, const Vec3&) const final { return pdf(); }
  /// Any point of the ray will do as its origin.
  std::optional<Vec2> invert_direction(const EmitterPoint& x,
                                       const EmitterDirection& d) const final {
    const Vec2 p = Vec2(Frame(x.surface.n_g).to_local(d.origin - center_)) / radius_;
    if (!(dot(p, p) <= 1)) return std::nullopt;
    return warp::invert_disk(p);
  }

 protected:
  /// Of the disk.
  double area() const { return kPi * sqr(radius_); }
  EmitterPoint point(const Vec3& direction, double pdf_position) const {
    EmitterPoint x;
    x.surface.n_g = direction;
    x.surface.position = center_ - kStandOff * radius_ * direction;
    x.pdf_position = pdf_position;
    return x;
  }

 private:
  /// Origins lie this many scene radii before the disk's plane through the scene's centre.
  static constexpr double kStandOff = 2;

  double pdf() const { return kInvPi / sqr(radius_); }

  Vec3 center_{0};
  double radius_ = 0;
};

}  // namespace fogbow
