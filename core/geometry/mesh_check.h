// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/geometry/shape.h"

namespace fogbow {

/// What is wrong with a would-be medium boundary, in the words of a warning.
struct BoundaryDefect {
  enum class Kind { Open, InconsistentOrientation, InsideOut, SelfIntersecting, NonManifold };
  Kind kind;
  std::size_t shape;  ///< index into the group
  std::string message;
};

/// Where a boundary ends.
struct BorderEdge {
  std::size_t shape;  ///< index into the group
  Vec3 a, b;
  Vec3 inward, normal;  ///< unit: along its triangle, away from the edge; of the triangle
};

/// The union of shapes that separate one interior from one exterior medium.
class BoundaryGroup {
 public:
  /// Welds coincident vertices of the group's tessellations and checks closedness, orientation and
  /// self-intersection.
  explicit BoundaryGroup(std::span<const Shape* const> shapes);
  ~BoundaryGroup();
  BoundaryGroup(BoundaryGroup&&) noexcept;
  BoundaryGroup& operator=(BoundaryGroup&&) noexcept;

  const std::vector<BoundaryDefect>& defects() const;
  const std::vector<BorderEdge>& borders() const;
  bool closed() const;
  /// Enclosed volume, world units cubed; only for closed groups.
  double volume() const;
  /// Whether the point lies strictly inside; only for closed groups. A sphere answers exactly.
  bool contains(const Vec3& p) const;
  /// Whether this boundary runs partly inside and partly outside of `other`, which is closed; told
  /// from points spread over it, so that a slight touch may escape.
  bool crosses(const BoundaryGroup& other) const;
  /// Whether this boundary lies within a distance from that of `other` somewhere; told in the same
  /// way.
  bool touches(const BoundaryGroup& other, double distance) const;
  /// Whether no part of this boundary lies outside of `other`; told in the same way.
  bool lies_within(const BoundaryGroup& other) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace fogbow
