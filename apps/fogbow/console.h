// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/util/log.h"

namespace fogbow::cli {

/// One line on standard error: "warning: …".
void print_message(LogLevel level, std::string_view message);
/// From here on print_message drops what is below `level`.
void set_printed_level(LogLevel level);

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string format(const char* pattern, ...);

/// "1 warning", "3 warnings".
std::string count_of(std::uint64_t n, const std::string& noun);
/// 1234567 → "1.23M".
std::string with_si_prefix(double value);
/// Binary: "12.3 MiB".
std::string byte_size(double bytes);
/// "4.2 s", "3:07", "1:02:03".
std::string duration(double seconds);
/// "0.12345 ± 0.00012": the error with two digits, the value to the same place.
std::string with_error(double value, double standard_error);

}  // namespace fogbow::cli
