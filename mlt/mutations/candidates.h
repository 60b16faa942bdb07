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

/// Σ of the weights that `for_each(visit)` passes to visit(candidate, weight).
template <class ForEach>
double total_weight(ForEach&& for_each) {
  double sum = 0;
  for_each([&](const auto&, double weight) { sum += weight; });
  return sum;
}

/// The candidate at `position` of the total weight.
template <class Candidate, class ForEach>
Candidate weighted_candidate(double position, ForEach&& for_each) {
  Candidate found{};
  for_each([&](const Candidate& c, double weight) {
    if (position >= 0) found = c;
    position -= weight;
  });
  return found;
}

}  // namespace fogbow
