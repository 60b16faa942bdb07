// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <source_location>
#include <string_view>

namespace fogbow {

/// Prints the broken law with its place and aborts.
[[noreturn]] void check_failed(std::string_view expression,
                               std::source_location where = std::source_location::current());

}  // namespace fogbow

/// Internal laws; bad input throws fogbow::Error instead.
#define FOGBOW_CHECK(condition) ((condition) ? void(0) : ::fogbow::check_failed(#condition))
