// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <vector>

#include "core/geometry/shape.h"
#include "core/scene/properties.h"

namespace fogbow {

/// An attribute whose values stand in these columns of a row of a PLY file.
struct AttributeColumns {
  MeshAttribute attribute;
  std::vector<int> columns;

  /// Appends the row's values.
  void take(const std::vector<double>& row);
};

/// As Mitsuba 3.9.1 names them: r, g and b (or red, green and blue) make "color"; NAME_r, NAME_g
/// and NAME_b make "NAME_color"; NAME_x and so on, or NAME_0 to NAME_2, or NAME_0 alone, make
/// "NAME"; with "vertex_" or "face_" in front. What is empty in `names` is no number; the rest is
/// skipped.
std::vector<AttributeColumns> attribute_columns(const std::vector<std::string>& names,
                                                bool of_faces);

/// Throws Error(Scene) where a texture asks for what the shape does not have, or not within bounds.
void check_attributes(const Shape& shape, const std::vector<Properties::AttributeNeed>& needs);

}  // namespace fogbow
