// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/mesh_check.h"
#include "core/scene/scene.h"

namespace fogbow {

/// "shape 'id' (file:line:column)", "medium 'id'", "vacuum".
std::string describe(const Surface& surface);
std::string describe(const Medium* medium);

/// The boundaries between media, grouped by the media on their two sides, and what is wrong with
/// them. Refers to the surfaces it was made from.
struct Scene::BoundaryReport {
 public:
  explicit BoundaryReport(const std::vector<Surface>& surfaces);

  /// Defects, one line each with shape and place.
  std::vector<std::string>& messages() { return messages_; }
  /// Whether the boundary that a surface is part of is closed.
  bool closed(std::uint32_t surface) const;
  /// The medium within the smallest boundary around p; nothing if no closed boundary is around it.
  std::optional<const Medium*> medium_around(const Vec3& p) const;

 private:
  struct Group {
    const Medium* interior;
    const Medium* exterior;
    std::vector<std::uint32_t> surfaces;
    std::optional<BoundaryGroup> boundary;
  };
  void report_defects(const std::vector<Surface>& surfaces, const Group& group);
  void report_overlaps(const std::vector<Surface>& surfaces);

  std::vector<Group> groups_;
  std::vector<std::string> messages_;
};

}  // namespace fogbow
