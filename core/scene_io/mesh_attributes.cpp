// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/mesh_attributes.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/scene_io/diagnostics.h"

namespace fogbow {

namespace {

int column_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::ranges::find(names, name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

/// The columns with these three names, or the first alone where the others are missing and one will
/// do.
std::vector<int> columns_of(const std::vector<std::string>& names, const std::string& stem,
                            const std::array<std::string, 3>& ends, bool one_will_do) {
  std::vector<int> columns;
  for (const std::string& end : ends) columns.push_back(column_of(names, stem + end));
  if (columns[1] < 0 && columns[2] < 0 && one_will_do) columns.resize(1);
  return std::ranges::min(columns) < 0 ? std::vector<int>() : columns;
}

}  // namespace

void AttributeColumns::take(const std::vector<double>& row) {
  for (const int c : columns)
    attribute.values.push_back(static_cast<float>(row[static_cast<std::size_t>(c)]));
}

std::vector<AttributeColumns> attribute_columns(const std::vector<std::string>& names,
                                                bool of_faces) {
  std::vector<AttributeColumns> all;
  const auto add = [&](const std::string& name, const std::vector<int>& columns) {
    if (columns.empty()) return;
    const std::string full = (of_faces ? "face_" : "vertex_") + name;
    for (const AttributeColumns& other : all)
      if (other.attribute.name == full) return;
    AttributeColumns& added = all.emplace_back();
    added.attribute.name = full;
    added.attribute.channels = static_cast<int>(columns.size());
    added.attribute.per_primitive = of_faces;
    added.columns = columns;
  };
  add("color", columns_of(names, "", {"r", "g", "b"}, false));
  add("color", columns_of(names, "", {"red", "green", "blue"}, false));
  for (const std::string& name : names) {
    const std::size_t bar = name.rfind('_');
    if (bar == std::string::npos || bar == 0) continue;
    const std::string stem = name.substr(0, bar), end = name.substr(bar);
    if (end == "_r") add(stem + "_color", columns_of(names, stem, {"_r", "_g", "_b"}, false));
    if (end == "_x") add(stem, columns_of(names, stem, {"_x", "_y", "_z"}, false));
    if (end == "_0") add(stem, columns_of(names, stem, {"_0", "_1", "_2"}, true));
  }
  return all;
}

void check_attributes(const Shape& shape, const std::vector<Properties::AttributeNeed>& needs) {
  for (const auto& need : needs) {
    const MeshAttribute* a = shape.find_attribute(need.use.name);
    if (!a) {
      std::vector<std::string> known;
      for (const MeshAttribute& other : shape.attributes()) known.push_back(other.name);
      throw Error(ErrorKind::Scene, need.where,
                  "the shape has no attribute " + quote(need.use.name) +
                      suggestion(need.use.name, known) +
                      (known.empty() ? "; it has none at all" : "; it has " + listed(known)));
    }
    const auto [least, greatest] = std::ranges::minmax(a->values);
    const double lo = need.use.scale * least, hi = need.use.scale * greatest;
    if (lo < need.min || hi > need.max)
      throw Error(ErrorKind::Scene, need.where,
                  "the values of the mesh attribute " + quote(a->name) + " run from " +
                      std::to_string(lo) + " to " + std::to_string(hi) + ", but must " +
                      (need.max == kInfinity ? "not be less than " + std::to_string(need.min)
                                             : "lie between " + std::to_string(need.min) + " and " +
                                                   std::to_string(need.max)) +
                      " (whole numbers are taken as they are)");
  }
}

}  // namespace fogbow
