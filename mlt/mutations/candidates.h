// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace fogbow {

/// How often `for_each(visit)` calls visit.
template <class ForEach>
int count_candidates(ForEach&& for_each) {
  int n = 0;
  for_each([&](const auto&) { ++n; });
  return n;
}

/// What visit is called with the time number `chosen`, from 0.
template <class Candidate, class ForEach>
Candidate candidate(int chosen, ForEach&& for_each) {
  Candidate found{};
  int n = 0;
  for_each([&](const Candidate& c) {
    if (n++ == chosen) found = c;
  });
  return found;
}

}  // namespace fogbow
