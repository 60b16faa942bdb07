// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>

#include "core/scene/overlaps.h"

namespace fogbow {

/// The boundaries between media, grouped by the media on their two sides, and what is wrong with
/// them. Refers to the surfaces it was made from.
struct Scene::BoundaryReport {
 public:
  /// Appends to `surfaces` what they are where volumes overlap.
  explicit BoundaryReport(std::vector<Surface>& surfaces);

  /// What is wrong, one line each with shape and place. Borders that walls in `accel` close are
  /// not.
  std::vector<std::string> warnings(const Accel& accel) const;
  /// How overlaps were resolved.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Null where nothing overlaps, or what does cannot be resolved.
  std::unique_ptr<const Overlaps>& overlaps() { return overlaps_; }
  /// Whether the boundary that a surface is part of is closed.
  bool closed(std::uint32_t surface) const;
  /// The medium within the smallest boundary around p; nothing if no closed boundary is around it.
  std::optional<const Medium*> medium_around(const Vec3& p) const;

 private:
  struct Group {
    std::shared_ptr<const Medium> interior, exterior;
    int priority;
    std::vector<std::uint32_t> surfaces;
    std::shared_ptr<const BoundaryGroup> boundary;
  };
  void group_surfaces();
  void list_volumes();
  std::vector<EnclosedVolume> volumes_of(const Group& group) const;
  EnclosedVolume volume_of(const Group& group, std::vector<std::uint32_t> members) const;
  std::shared_ptr<const BoundaryGroup> join(const std::vector<std::uint32_t>& members) const;
  bool dispute(const EnclosedVolume& a, const EnclosedVolume& b) const;
  void list_pairs();
  void add_glass();
  void add_glass_volume(const std::vector<std::uint32_t>& members,
                        const std::shared_ptr<const BoundaryGroup>& boundary);
  bool is_in_overlap(const Surface& surface) const;
  bool may_dispute(const Surface& glass) const;
  void resolve();
  std::string overlap_text(std::size_t a, std::size_t b) const;
  void warn_of_open_overlaps(std::vector<std::string>& messages) const;
  void warn_of_defects(const Accel& accel, std::vector<std::string>& messages) const;

  std::vector<Surface>& surfaces_;
  double touch_;  ///< distance over which surfaces touch
  std::vector<Group> groups_;
  std::vector<EnclosedVolume> volumes_;
  OverlappingPairs pairs_;
  std::vector<std::uint32_t> open_glass_;  ///< that overlaps something
  std::unique_ptr<const Overlaps> overlaps_;
  std::string obstacle_;  ///< why overlaps are not resolved
  std::vector<std::string> notes_;
};

}  // namespace fogbow
