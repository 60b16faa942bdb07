// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/console.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace fogbow::cli {

namespace {

LogLevel printed_level = LogLevel::Debug;

const char* level_name(LogLevel level) {
  switch (level) {
    case LogLevel::Debug: return "debug";
    case LogLevel::Info: return "info";
    case LogLevel::Warning: return "warning";
    case LogLevel::Error: return "error";
  }
  return "error";
}

}  // namespace

void print_message(LogLevel level, std::string_view message) {
  if (level < printed_level) return;
  const std::string line = std::string(level_name(level)) + ": " + std::string(message) + "\n";
  std::fputs(line.c_str(), stderr);  // one call, so that lines of several threads stay whole
}

void set_printed_level(LogLevel level) { printed_level = level; }

std::string format(const char* pattern, ...) {
  std::va_list arguments, again;
  va_start(arguments, pattern);
  va_copy(again, arguments);
  std::string text(
      static_cast<std::size_t>(std::max(0, std::vsnprintf(nullptr, 0, pattern, arguments))), '\0');
  std::vsnprintf(text.data(), text.size() + 1, pattern, again);
  va_end(again);
  va_end(arguments);
  return text;
}

std::string count_of(std::uint64_t n, const std::string& noun) {
  return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
}

std::string with_si_prefix(double value) {
  static constexpr const char* prefixes[] = {"", "k", "M", "G", "T", "P"};
  std::size_t i = 0;
  while (std::fabs(value) >= 999.5 && i + 1 < std::size(prefixes)) {
    value /= 1000;
    ++i;
  }
  return format("%.3g%s", value, prefixes[i]);
}

std::string byte_size(double bytes) {
  static constexpr const char* units[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  std::size_t i = 0;
  while (bytes >= 1000 && i + 1 < std::size(units)) {
    bytes /= 1024;
    ++i;
  }
  return format(i == 0 ? "%.0f %s" : "%.1f %s", bytes, units[i]);
}

std::string duration(double seconds) {
  if (seconds < 59.95) return format("%.1f s", seconds);
  const auto whole = static_cast<long long>(std::llround(seconds));
  if (whole < 3600) return format("%lld:%02lld", whole / 60, whole % 60);
  return format("%lld:%02lld:%02lld", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string with_error(double value, double standard_error) {
  if (!(standard_error > 0) || !std::isfinite(standard_error) || !std::isfinite(value))
    return format("%.6g ± %.2g", value, standard_error);
  const double size = std::max(std::fabs(value), standard_error);
  const int digits =
      static_cast<int>(std::floor(std::log10(size)) - std::floor(std::log10(standard_error))) + 2;
  if (digits > 15 || size >= 1e6 || size < 1e-4)
    return format("%.*e ± %.1e", std::min(digits, 15) - 1, value, standard_error);
  const int decimals = std::max(0, 1 - static_cast<int>(std::floor(std::log10(standard_error))));
  return format("%.*f ± %.*f", decimals, value, decimals, standard_error);
}

}  // namespace fogbow::cli
