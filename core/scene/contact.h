// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/scene/scene.h"

namespace fogbow {

/// Whether a surface lets nothing through.
bool is_opaque(const Surface& surface);

/// Distance over which surfaces touch: what single precision, to which files and meshes round,
/// leaves undecided.
double touch_distance(const std::vector<Surface>& surfaces);

/// Places where an opaque surface lies upon one that lets light through (the table under a glass,
/// the walls at which the fog of a room ends), or a lamp upon either. Rounding would decide which
/// of the two a ray meets first; here it is always the opaque one, in what is on the ray's side of
/// it, and always the lamp.
class Contacts {
 public:
  /// `met`: what rays are to meet in place of each surface.
  Contacts(const std::vector<Surface>& surfaces,
           const std::vector<std::shared_ptr<const Shape>>& met);

  /// `met` without the places at which another is met.
  const std::vector<std::shared_ptr<const Shape>>& free_parts() const { return free_parts_; }
  /// Which surfaces lose such places.
  const std::vector<std::uint32_t>& covered() const { return covered_; }

 private:
  class Cover;
  enum class Rank;
  static std::optional<Rank> rank(const Surface& surface);
  void trim_all(const std::vector<std::optional<Rank>>& ranks, Rank lower);
  bool touches(const Cover& cover, const std::shared_ptr<const Shape>& shape,
               const std::vector<std::shared_ptr<const Shape>>& near) const;
  void trim(std::uint32_t surface, const std::shared_ptr<const Cover>& cover);

  std::vector<std::shared_ptr<const Shape>> free_parts_;
  std::vector<std::uint32_t> covered_;
  double touch_;
};

}  // namespace fogbow
