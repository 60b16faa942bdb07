// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/parse_values.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/scene_io/diagnostics.h"

namespace fogbow {

namespace {

constexpr std::string_view kSpace = " \t\r\n";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

[[noreturn]] void fail(const SourceLocation& where, const char* expected, std::string_view found) {
  throw Error(ErrorKind::Scene, where,
              std::string("expected ") + expected + ", found " + quote(found));
}

/// std::from_chars knows no leading plus.
void skip_plus(std::string_view& text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
}

}  // namespace

bool consume_number(std::string_view& text, double& value) {
  std::string_view rest = text;
  skip_plus(rest);
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  const auto length = static_cast<std::size_t>(end - rest.data());
  if (error == std::errc::result_out_of_range) {
    // Too large and too small are told apart by the sign of the exponent, or by leading zeros.
    const std::string_view digits = rest.substr(0, length);
    const std::size_t exponent = digits.find_first_of("eE");
    const bool tiny = exponent != std::string_view::npos
                          ? digits.substr(exponent + 1).starts_with('-')
                          : digits.find_first_not_of("-0") == digits.find('.');
    if (!tiny) return false;
    value = 0;
  } else if (error != std::errc() || !std::isfinite(value)) {
    return false;
  }
  rest.remove_prefix(length);
  text = rest;
  return true;
}

double parse_number(std::string_view text, const SourceLocation& where) {
  std::string_view rest = trimmed(text);
  double value = 0;
  if (!consume_number(rest, value) || !rest.empty()) fail(where, "a finite number", text);
  return value;
}

std::int64_t parse_integer(std::string_view text, const SourceLocation& where) {
  std::string_view rest = trimmed(text);
  skip_plus(rest);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
  if (error != std::errc() || end != rest.data() + rest.size()) fail(where, "a whole number", text);
  return value;
}

bool parse_boolean(std::string_view text, const SourceLocation& where) {
  std::string lower(trimmed(text).substr(0, 8));
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (lower != "true" && lower != "false") fail(where, "\"true\" or \"false\"", text);
  return lower == "true";
}

std::vector<double> parse_numbers(std::string_view text, const SourceLocation& where) {
  std::vector<double> result;
  std::string_view rest = trimmed(text);
  while (!rest.empty()) {
    double value = 0;
    if (!consume_number(rest, value)) fail(where, "finite numbers", text);
    result.push_back(value);
    const std::size_t next = rest.find_first_not_of(kSpace);
    if (next == std::string_view::npos) break;
    const bool comma = rest[next] == ',';
    if (!comma && next == 0) fail(where, "numbers with a comma or space between them", text);
    rest.remove_prefix(comma ? next + 1 : next);
    rest.remove_prefix(std::min(rest.find_first_not_of(kSpace), rest.size()));
    if (comma && rest.empty()) fail(where, "a number after the last comma", text);
  }
  return result;
}

Vec3 parse_triple(std::string_view text, const SourceLocation& where) {
  const std::vector<double> numbers = parse_numbers(text, where);
  if (numbers.size() == 1) return Vec3(numbers[0]);
  if (numbers.size() != 3) fail(where, "one or three numbers", text);
  return {numbers[0], numbers[1], numbers[2]};
}

}  // namespace fogbow
