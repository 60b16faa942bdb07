// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/class_tally.h"

#include "core/util/binary_io.h"

namespace fogbow {

PathClass path_class(const MeasuredPath& path) {
  PathClass result{path.size(), 0};
  if (path.size() > 32) return result;
  for (int i = 0; i < path.size(); ++i) result.c |= std::uint32_t{path[i].in_medium()} << i;
  return result;
}

void ClassTally::add(const PathClass& path_class, double weight) {
  constexpr std::size_t kProbes = 32;
  const std::uint64_t hash =
      (static_cast<std::uint64_t>(path_class.k) << 32 | path_class.c) * 0x9e3779b97f4a7c15u;
  // Slot 0 takes what finds no room.
  for (std::size_t i = 0; i < kProbes; ++i) {
    Slot& slot = slots_[1 + ((hash >> 40) + i) % (kSlots - 1)];
    if (slot.path_class.k == 0) slot.path_class = path_class;
    if (slot.path_class != path_class) continue;
    slot.share += weight;
    return;
  }
  slots_[0].share += weight;
}

void ClassTally::add_to(std::map<PathClass, double>& sums) const {
  for (const Slot& slot : slots_)
    if (slot.share > 0) sums[slot.path_class] += slot.share;
}

void ClassTally::serialize(std::ostream& out) const { write_binary_vector(out, slots_); }

ClassTally ClassTally::deserialize(std::istream& in) {
  ClassTally tally;
  tally.slots_ = read_binary_vector<Slot>(in, kSlots);
  if (tally.slots_.size() != kSlots)
    throw Error(ErrorKind::InputOutput, "a saved table of path classes has another size");
  return tally;
}

std::string configuration_text(const PathClass& c) {
  if (c.k == 0) return "all others";
  if (c.k > 32) return "k = " + std::to_string(c.k);
  std::string text;
  for (int i = 0; i < c.k; ++i) text += (c.c >> i & 1) ? 'M' : 'S';
  return text;
}

}  // namespace fogbow
