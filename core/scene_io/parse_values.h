// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/math/vec.h"
#include "core/util/error.h"

namespace fogbow {

// Values as Mitsuba writes them. Space around is ignored, anything else left over is Error(Scene)
// at `where`, as are non-finite numbers.

double parse_number(std::string_view text, const SourceLocation& where);
std::int64_t parse_integer(std::string_view text, const SourceLocation& where);
/// true or false, in any case.
bool parse_boolean(std::string_view text, const SourceLocation& where);
/// Separated by commas, space or both.
std::vector<double> parse_numbers(std::string_view text, const SourceLocation& where);
/// Three numbers, or one for all three.
Vec3 parse_triple(std::string_view text, const SourceLocation& where);

/// Reads the number that `text` starts with and removes it; false if there is none. Values too
/// small become 0, too large or non-finite ones fail.
bool consume_number(std::string_view& text, double& value);

}  // namespace fogbow
