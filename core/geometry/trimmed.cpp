// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/trimmed.h"

namespace fogbow {

namespace {

/// Analytic for Embree, whatever the whole is: each candidate is to be asked for.
class Trimmed final : public Shape {
 public:
  Trimmed(std::shared_ptr<const Shape> whole, Kept kept)
      : whole_(std::move(whole)), kept_(std::move(kept)) {}

  PrimitiveKind primitive_kind() const override { return PrimitiveKind::Analytic; }
  std::uint32_t primitive_count() const override { return whole_->primitive_count(); }
  PrimitiveBuffers buffers() const override { return {}; }
  Bounds bounds() const override { return whole_->bounds(); }
  Bounds primitive_bounds(std::uint32_t primitive) const override {
    return whole_->primitive_bounds(primitive);
  }
  bool polygonal() const override { return false; }

  std::optional<PrimitiveHit> intersect(std::uint32_t primitive, const Ray& ray,
                                        bool leaving) const override {
    Ray rest = ray;
    for (;;) {
      const auto hit = whole_->intersect(primitive, rest, leaving);
      if (!hit || kept_(primitive, hit->local)) return hit;
      rest.t_min = hit->t;
      leaving = true;
    }
  }

  bool avoids(std::uint32_t primitive, const Bounds& box) const override {
    return whole_->avoids(primitive, box);
  }
  SurfacePoint surface_point(std::uint32_t primitive, const Vec2& local) const override {
    return whole_->surface_point(primitive, local);
  }
  SurfaceDerivatives derivatives(const SurfacePoint& x) const override {
    return whole_->derivatives(x);
  }
  std::array<Vec2, 2> uv_derivatives(const SurfacePoint& x) const override {
    return whole_->uv_derivatives(x);
  }
  double area() const override { return whole_->area(); }
  SurfacePoint sample(const Vec2& u) const override { return whole_->sample(u); }
  Vec2 invert(const SurfacePoint& x) const override { return whole_->invert(x); }
  Tessellation tessellate() const override { return whole_->tessellate(); }

 private:
  std::shared_ptr<const Shape> whole_;
  Kept kept_;
};

}  // namespace

std::shared_ptr<const Shape> make_trimmed(std::shared_ptr<const Shape> whole, Kept kept) {
  return std::make_shared<Trimmed>(std::move(whole), std::move(kept));
}

}  // namespace fogbow
