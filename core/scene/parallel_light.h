// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/math/frame.h"
#include "core/math/warp.h"
#include "core/scene/emitter.h"
#include "core/util/check.h"

namespace fogbow {

/// What emitters at infinity share: light of one direction comes evenly through a disk across it,
/// which hides the scene.
class ParallelLight {
 public:
  void bind(const Vec3& scene_center, double scene_radius) {
    FOGBOW_CHECK(is_finite(scene_center) && scene_radius > 0 && std::isfinite(scene_radius));
    center_ = scene_center;
    radius_ = scene_radius;
  }
  /// Of the disk.
  double area() const { return kPi * sqr(radius_); }

  /// Without its density.
  EmitterPoint point(const Vec3& direction) const {
    EmitterPoint x;
    x.surface.n_g = direction;
    x.surface.position = center_ - kStandOff * radius_ * direction;
    return x;
  }
  EmitterDirection sample(const EmitterPoint& x, const Vec2& u) const {
    const Frame frame(x.surface.n_g);
    const Vec2 p = radius_ * warp::sample_disk(u);
    return {frame.n, center_ + frame.to_world(Vec3(p, -kStandOff * radius_)), pdf()};
  }
  double pdf() const { return kInvPi / sqr(radius_); }
  /// Any point of the ray will do as its origin.
  std::optional<Vec2> invert(const EmitterPoint& x, const EmitterDirection& d) const {
    const Vec2 p = Vec2(Frame(x.surface.n_g).to_local(d.origin - center_)) / radius_;
    if (!(dot(p, p) <= 1)) return std::nullopt;
    return warp::invert_disk(p);
  }

 private:
  /// Origins lie this many scene radii before the disk's plane through the scene's centre.
  static constexpr double kStandOff = 2;

  Vec3 center_{0};
  double radius_ = 0;
};

}  // namespace fogbow
