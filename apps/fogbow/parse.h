// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <utility>

namespace fogbow::cli {

// Values of flags. All throw Error(Usage) that says what was expected.

/// "90", "90s", "2m", "1h30m" in seconds.
double parse_duration(const std::string& text);
/// A finite number; `positive`: above zero.
double parse_number(const std::string& text, bool positive);
/// A whole number below 2^64.
std::uint64_t parse_seed(const std::string& text);
/// "WIDTHxHEIGHT".
std::pair<int, int> parse_size(const std::string& text);
/// "x,y,width,height" in pixels.
std::array<int, 4> parse_rectangle(const std::string& text);
/// "r,g,b", finite; or one number for all three.
std::array<double, 3> parse_triple(const std::string& text);
/// "seed:chain:step".
std::array<std::uint64_t, 3> parse_replay(const std::string& text);
/// "name=value"; the value may be empty and may hold further '='.
std::pair<std::string, std::string> parse_definition(const std::string& text);
/// "integrator.KEY=VALUE" as KEY and VALUE.
std::pair<std::string, std::string> parse_override(const std::string& text);

}  // namespace fogbow::cli
