// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <glm/common.hpp>
#include <unordered_map>
#include <vector>

#include "core/math/vec.h"

namespace fogbow {

/// Makes one vertex of all those within `tolerance` of the first of them.
class Welder {
 public:
  explicit Welder(double tolerance) : tolerance_(tolerance), cell_(64 * tolerance) {}

  std::uint32_t add(const Vec3& p) {
    // Nearly always all corners of the search box lie in one cell.
    const Vec3 lo = glm::floor((p - tolerance_) / cell_), hi = glm::floor((p + tolerance_) / cell_);
    for (double x = lo.x; x <= hi.x; ++x)
      for (double y = lo.y; y <= hi.y; ++y)
        for (double z = lo.z; z <= hi.z; ++z)
          if (const auto cell = cells_.find({x, y, z}); cell != cells_.end())
            for (const std::uint32_t i : cell->second)
              if (length(vertices[i] - p) <= tolerance_) return i;
    const auto index = static_cast<std::uint32_t>(vertices.size());
    cells_[glm::floor(p / cell_)].push_back(index);
    vertices.push_back(p);
    return index;
  }

  std::vector<Vec3> vertices;

 private:
  struct Hash {
    std::size_t operator()(const Vec3& c) const {
      std::size_t h = 0;
      for (int i = 0; i < 3; ++i)
        h = h * 0x9E3779B97F4A7C15u + std::hash<double>{}(c[i]);  // odd constant: mixes all bits
      return h;
    }
  };
  double tolerance_, cell_;
  std::unordered_map<Vec3, std::vector<std::uint32_t>, Hash> cells_;
};

}  // namespace fogbow
