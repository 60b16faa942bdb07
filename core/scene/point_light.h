// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/scene/emitter.h"

namespace fogbow {

/// An emitter whose light comes from one point.
class PointLight : public Emitter {
 public:
  explicit PointLight(const Vec3& position) : position_(position) {}

  EmitterKind kind() const final { return EmitterKind::Point; }
  std::optional<EmitterPoint> sample_position(const Vec3&) const final {
    EmitterPoint x;
    x.surface.position = position_;
    x.pdf_position = 1;
    return x;
  }
  double pdf_position(const EmitterPoint&) const final { return 1; }
  std::optional<Vec3> invert_position(const EmitterPoint&, const Vec3& auxiliary) const final {
    return auxiliary;
  }

 protected:
  const Vec3& position() const { return position_; }

 private:
  Vec3 position_;
};

}  // namespace fogbow
