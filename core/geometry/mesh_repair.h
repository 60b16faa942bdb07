// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "core/geometry/shapes.h"

namespace fogbow {

/// What was done to a mesh to make it a closed boundary.
struct MeshRepair {
  std::size_t stitched = 0;   ///< border edges that now have a neighbour
  std::size_t removed = 0;    ///< triangles without area, or there twice
  std::size_t flipped = 0;    ///< triangles
  std::size_t filled = 0;     ///< holes
  std::size_t added = 0;      ///< triangles in those
  std::size_t left_open = 0;  ///< holes that are too large to be a fault
  bool closed = false;        ///< in the end

  bool changed() const { return stitched + removed + flipped + filled > 0; }
  std::string text() const;
};

/// Joins borders that nearly meet, removes triangles without area and doubles, turns the rest one
/// way (outwards, once closed) and fills small holes. Vertices keep their normals, texture
/// coordinates and attributes, triangles theirs; holes take those of their rims; a sound mesh comes
/// back as it is.
TriangleMeshData repair_mesh(TriangleMeshData mesh, MeshRepair& done);

}  // namespace fogbow
