// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "core/geometry/shape.h"

namespace fogbow {

/// Names a primitive; `kNoPrimitive` for points that lie on none (media, cameras, point lights).
struct PrimitiveId {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::uint32_t shape = kNone;
  std::uint32_t primitive = kNone;
  bool operator==(const PrimitiveId&) const = default;
};
inline constexpr PrimitiveId kNoPrimitive{};

struct Hit {
  double t;
  PrimitiveId id;
  Vec2 local;
};

/// Lets one shape bear several names, depending on the place that is hit.
class HitNames {
 public:
  virtual ~HitNames() = default;
  /// What a hit answers in `id.shape`, in place of the shape that is there now.
  virtual std::uint32_t name(const Hit& hit) const = 0;
  /// The shape behind a name.
  virtual std::uint32_t shape(std::uint32_t name) const = 0;
};

/// Ray queries over shapes; the index of a shape in the list given is its id. Thread-safe once
/// built. Every candidate near either end of the ray is decided in double precision, so that a ray
/// neither meets the primitive it leaves nor the one it goes to.
class Accel {
 public:
  /// The shapes must outlive the accelerator, and so must the names where there are some.
  explicit Accel(std::span<const Shape* const> shapes, const HitNames* names = nullptr);
  ~Accel();
  Accel(Accel&&) noexcept;
  Accel& operator=(Accel&&) noexcept;

  /// Nearest hit in (ray.t_min, ray.t_max) that is not the point of `from` the ray starts on. A
  /// non-finite ray is a broken law (CHECK).
  std::optional<Hit> intersect(const Ray& ray, PrimitiveId from = kNoPrimitive) const;
  /// True iff anything lies strictly between the two ends; `from` and `to` name the primitives of
  /// the end points.
  bool occluded(const Vec3& a, const Vec3& b, PrimitiveId from = kNoPrimitive,
                PrimitiveId to = kNoPrimitive) const;

  Bounds bounds() const;
  std::size_t memory_bytes() const;

 private:
  std::optional<Hit> intersect_shape(const Ray& ray, PrimitiveId from) const;

  struct Impl;
  std::unique_ptr<Impl> impl_;
  const HitNames* names_;
};

}  // namespace fogbow
