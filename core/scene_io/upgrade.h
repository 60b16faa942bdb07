// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/scene_io/xml_document.h"

namespace fogbow {

/// Below it, names and defaults are those of Mitsuba 0.4 to 0.6.
inline constexpr double kFirstVersionOfToday = 2;

/// Turns what was written for Mitsuba 0.4 to 0.6 into what Mitsuba 3 means by it. Every kind of
/// change is told once, by log_info(); what no rule knows is left to be warned of.
void upgrade_scene(XmlNode& root);

/// "toWorld" → "to_world", "intIOR" → "int_ior".
std::string snake_case(std::string name);

}  // namespace fogbow
