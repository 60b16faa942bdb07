// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/mesh_check.h"
#include "core/scene/scene.h"

namespace fogbow {

/// "shape 'id' (file:line:column)", "medium 'id'", "vacuum".
std::string describe(const Surface& surface);
std::string describe(const Medium* medium);

/// Whether the surface lies between two indices of refraction.
inline bool refracts(const Surface& surface) { return surface.bsdf->eta() != 1; }

/// What closed boundaries hold: a medium, an index of refraction, or both.
struct EnclosedVolume {
  std::vector<std::uint32_t> surfaces;  ///< of the scene's description
  std::shared_ptr<const BoundaryGroup> boundary;
  std::shared_ptr<const Medium> interior, exterior;
  bool sets_medium = false;  ///< else light inside is in the medium that is there anyway
  double n = 0;              ///< index of refraction; 0 where the boundary does not refract
  double n_exterior = 1;     ///< around it, where it refracts
  int priority = 0;
  bool meets_itself = false;  ///< its pieces overlap
  /// Why overlaps with others cannot be resolved; empty where they can.
  std::string obstacle;

  /// Whether not both can be as they are where both are.
  bool disputes(const EnclosedVolume& other) const {
    return (sets_medium && other.sets_medium) || (n != 0 && other.n != 0);
  }
};

}  // namespace fogbow
