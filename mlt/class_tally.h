// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/path/measured_path.h"

namespace fogbow {

/// One P_k^c: k, and bit i of c set where x[i] lies in a medium. Paths of more than 32 vertices are
/// told apart by k alone.
struct PathClass {
  int k = 0;
  std::uint32_t c = 0;
  auto operator<=>(const PathClass&) const = default;
};
PathClass path_class(const MeasuredPath& path);
/// From light to eye, "SMS…".
std::string configuration_text(const PathClass& c);

/// Expected value of luminance / f* of the classes that a chain has seen; room for a fixed number
/// of them, what is beyond is summed under the class {0, 0}.
class ClassTally {
 public:
  static constexpr std::size_t kSlots = 512;

  void add(const PathClass& path_class, double weight);
  void add_to(std::map<PathClass, double>& sums) const;

  void serialize(std::ostream& out) const;
  static ClassTally deserialize(std::istream& in);

 private:
  struct Slot {
    PathClass path_class;
    double share = 0;
  };
  std::vector<Slot> slots_ = std::vector<Slot>(kSlots);
};

}  // namespace fogbow
