// SPDX-License-Identifier: GPL-3.0-or-later
#include "apps/fogbow/parse.h"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "core/util/error.h"

namespace fogbow::cli {

namespace {

[[noreturn]] void refuse(const std::string& text, const std::string& expected) {
  throw Error(ErrorKind::Usage, "expected " + expected + ", found '" + text + "'");
}

/// The whole of `text` as a number; nothing if anything is left over.
template <class T>
std::optional<T> number(std::string_view text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [rest, status] = std::from_chars(text.data(), end, value);
  if (status != std::errc() || rest != end) return std::nullopt;
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto at = text.find(separator);
    parts.push_back(text.substr(0, at));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

/// Exactly N numbers between separators.
template <class T, std::size_t N>
std::optional<std::array<T, N>> numbers(std::string_view text, char separator) {
  const auto parts = split(text, separator);
  if (parts.size() != N) return std::nullopt;
  std::array<T, N> values;
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = number<T>(parts[i]);
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  return values;
}

double seconds_in(char unit) {
  switch (unit) {
    case 's': return 1;
    case 'm': return 60;
    case 'h': return 3600;
    case 'd': return 86400;
  }
  return 0;
}

}  // namespace

double parse_duration(const std::string& text) {
  const std::string expected = "a time such as 90, 90s, 2m or 1h30m";
  double total = 0;
  double last_unit = INFINITY;
  std::string_view rest = text;
  while (!rest.empty()) {
    const auto digits = rest.find_first_not_of("0123456789.");
    const auto value = number<double>(rest.substr(0, digits));
    const bool bare = digits == std::string_view::npos;
    const double unit = bare ? 1 : seconds_in(rest[digits]);
    // Units fall from left to right, and a number without a unit stands alone.
    if (!value || unit == 0 || unit >= last_unit || (bare && rest.size() != text.size()))
      refuse(text, expected);
    total += *value * unit;
    last_unit = unit;
    rest.remove_prefix(bare ? rest.size() : digits + 1);
  }
  if (!(total > 0) || !std::isfinite(total)) refuse(text, expected + ", more than zero");
  return total;
}

double parse_number(const std::string& text, bool positive) {
  const auto value = number<double>(text);
  if (!value || !std::isfinite(*value)) refuse(text, "a number");
  if (positive && !(*value > 0)) refuse(text, "a number above zero");
  return *value;
}

std::uint64_t parse_seed(const std::string& text) {
  const auto value = number<std::uint64_t>(text);
  if (!value) refuse(text, "a whole number from 0 to 2^64 - 1");
  return *value;
}

std::pair<int, int> parse_size(const std::string& text) {
  const auto values = numbers<int, 2>(text, 'x');
  if (!values || (*values)[0] < 1 || (*values)[1] < 1)
    refuse(text, "a picture size WIDTHxHEIGHT in pixels, such as 640x480");
  return {(*values)[0], (*values)[1]};
}

std::array<int, 4> parse_rectangle(const std::string& text) {
  const auto values = numbers<int, 4>(text, ',');
  if (!values || (*values)[0] < 0 || (*values)[1] < 0 || (*values)[2] < 1 || (*values)[3] < 1)
    refuse(text, "a rectangle x,y,width,height in pixels, such as 64,32,128,96");
  return *values;
}

std::array<double, 3> parse_triple(const std::string& text) {
  const auto values = numbers<double, 3>(text, ',');
  if (values && std::isfinite((*values)[0] + (*values)[1] + (*values)[2])) return *values;
  const auto value = number<double>(text);
  if (!value || !std::isfinite(*value)) refuse(text, "one number, or three between commas");
  return {*value, *value, *value};
}

std::array<std::uint64_t, 3> parse_replay(const std::string& text) {
  const auto values = numbers<std::uint64_t, 3>(text, ':');
  if (!values) refuse(text, "three whole numbers seed:chain:step, such as 1:0:4711");
  return *values;
}

std::pair<std::string, std::string> parse_definition(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) refuse(text, "name=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

std::pair<std::string, std::string> parse_override(const std::string& text) {
  constexpr std::string_view prefix = "integrator.";
  const auto equals = text.find('=');
  if (!text.starts_with(prefix) || equals == std::string::npos || equals <= prefix.size())
    refuse(text, "integrator.KEY=VALUE");
  return {text.substr(prefix.size(), equals - prefix.size()), text.substr(equals + 1)};
}

}  // namespace fogbow::cli
