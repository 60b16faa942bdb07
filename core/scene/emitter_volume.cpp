// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "core/math/warp.h"
#include "core/scene/emitters.h"

namespace fogbow {
namespace {

/// Points a side of the grid on which the mean emission is looked up.
constexpr int kPowerGrid = 4;

class VolumeEmitter final : public Emitter {
 public:
  VolumeEmitter(std::shared_ptr<const Medium> medium, const Bounds& bounds,
                std::function<const Medium*(const Vec3&)> medium_at)
      : medium_(std::move(medium)), bounds_(bounds), medium_at_(std::move(medium_at)) {
    if (!(bounds.volume() > 0) || !std::isfinite(bounds.volume()))
      throw std::domain_error("an emitting medium needs bounds with a finite volume");
  }

  EmitterKind kind() const override { return EmitterKind::Volume; }
  RGB power() const override {
    RGB sum(0);
    for (int i = 0; i < kPowerGrid; ++i)
      for (int j = 0; j < kPowerGrid; ++j)
        for (int k = 0; k < kPowerGrid; ++k)
          sum += medium_->emission(in_bounds((Vec3(i, j, k) + 0.5) / double(kPowerGrid)));
    return 4 * kPi * bounds_.volume() / std::pow(kPowerGrid, 3) * sum;
  }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    EmitterPoint x;
    x.surface.position = in_bounds(u);
    if (medium_at_(x.surface.position) != medium_.get()) return std::nullopt;
    x.pdf_position = 1 / bounds_.volume();
    return x;
  }
  double pdf_position(const EmitterPoint& x) const override {
    return contains(x.surface.position) ? 1 / bounds_.volume() : 0.0;
  }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3&) const override {
    if (!contains(x.surface.position)) return std::nullopt;
    const Vec3 u = (x.surface.position - bounds_.lo) / bounds_.diagonal();
    return Vec3(warp::clamp_unit(u.x), warp::clamp_unit(u.y), warp::clamp_unit(u.z));
  }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const override {
    return {warp::sample_sphere(u), x.surface.position, warp::pdf_sphere()};
  }
  double pdf_direction(const EmitterPoint&, const Vec3&) const override {
    return warp::pdf_sphere();
  }
  std::optional<Vec2> invert_direction(const EmitterPoint&,
                                       const EmitterDirection& d) const override {
    return warp::invert_sphere(d.w);
  }

  RGB L_e(const EmitterPoint& x, const Vec3&) const override {
    return medium_->emission(x.surface.position);
  }

 private:
  Vec3 in_bounds(const Vec3& u) const { return bounds_.lo + u * bounds_.diagonal(); }
  bool contains(const Vec3& p) const {
    return glm::all(glm::greaterThanEqual(p, bounds_.lo)) &&
           glm::all(glm::lessThanEqual(p, bounds_.hi));
  }

  std::shared_ptr<const Medium> medium_;
  Bounds bounds_;
  std::function<const Medium*(const Vec3&)> medium_at_;
};

}  // namespace

std::shared_ptr<Emitter> make_volume_emitter(std::shared_ptr<const Medium> medium,
                                             const Bounds& bounds,
                                             std::function<const Medium*(const Vec3&)> medium_at) {
  return std::make_shared<VolumeEmitter>(std::move(medium), bounds, std::move(medium_at));
}

}  // namespace fogbow
