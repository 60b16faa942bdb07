// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/geometry/shapes.h"
#include "core/util/error.h"

namespace fogbow {

// Meshes in the coordinates of their files, polygons cut into fans. `normals` is empty if the file
// has none; a vertex without one among others that have gets the zero vector. `name` is for
// messages. Throw Error(Scene) at the line (or byte) of whatever is malformed, missing, not finite
// or out of range; nothing is allocated for counts that the length of the text cannot hold.

/// Stanford PLY 1.0, ascii or binary in either byte order; unknown elements and properties are
/// skipped, but for attribute_columns().
TriangleMeshData parse_ply(std::string_view bytes, const std::string& name);
/// Wavefront OBJ: v, vt, vn and f; everything else is ignored. One vertex per distinct (v, vt, vn).
TriangleMeshData parse_obj(std::string_view text, const std::string& name);

struct SerializedMesh {
  TriangleMeshData mesh;
  bool face_normals = false;  ///< it is to be shaded flat
};
/// Mitsuba's compressed format, versions 3 and 4; the mesh of that number, from 0. Colours are
/// skipped.
SerializedMesh parse_serialized(std::string_view bytes, const std::string& name,
                                std::int64_t index);

}  // namespace fogbow
