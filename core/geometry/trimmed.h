// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <memory>

#include "core/geometry/shape.h"

namespace fogbow {

/// Which points of a shape are there.
using Kept = std::function<bool(std::uint32_t primitive, const Vec2& local)>;

/// The part of a shape that is kept, for rays; area, samples and tessellation are those of the
/// whole shape.
std::shared_ptr<const Shape> make_trimmed(std::shared_ptr<const Shape> whole, Kept kept);

}  // namespace fogbow
