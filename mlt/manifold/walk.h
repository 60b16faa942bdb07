// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "mlt/mutations/retrace.h"

namespace fogbow {

/// From `anchor` through degenerate and glossy vertices to the first that is neither; nothing where
/// there is none.
std::optional<Segment> held_chain_from(const Scene& scene, const MeasuredPath& x, int anchor,
                                       Side toward);

/// Lets the specular chain of a segment follow its end: the vertices of y between the anchor and
/// the end, which has moved, become those through which light goes from the one to the other, by
/// the same events. Newton's method with backtracking on the direction at the anchor; every iterate
/// is a traced chain, and the derivatives are ray differentials. A function of y alone, without any
/// restart. False where it fails. The last edge is left to be connected.
bool walk(const Scene& scene, MeasuredPath& y, const Segment& segment);

/// Whether walking back from y leads to x: the chain of y, whose end has been moved to that of x,
/// must become x's.
bool returns(const Scene& scene, const MeasuredPath& x, const MeasuredPath& y,
             const Segment& segment);

/// Log of what turns f's factors along the segment into those of the reduced f, which knows of no
/// vertices between its ends.
double log_reduction(const Scene& scene, const MeasuredPath& x, const Segment& segment);

}  // namespace fogbow
