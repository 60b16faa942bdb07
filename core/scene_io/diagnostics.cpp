// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/diagnostics.h"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <numeric>

#include "core/util/log.h"

namespace fogbow {

namespace {

constexpr std::size_t kMaxWarnings = 1000;
constexpr std::size_t kMaxShown = 80;

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i] != b[j]);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

void Diagnostics::warn(const SourceLocation& where, const std::string& message) {
  if (strict_) throw Error(ErrorKind::Scene, where, message);
  if (++count_ > kMaxWarnings) return;
  const std::string place = to_string(where);
  std::string text = place.empty() ? message : place + ": " + message;
  if (count_ == kMaxWarnings) text += " (further warnings are not shown)";
  log_warning(text);
  warnings_.push_back(std::move(text));
}

std::string quote(std::string_view text) {
  std::string result = "\"";
  for (const char c : text.substr(0, kMaxShown)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) {
      result += c;
      continue;
    }
    char escaped[5];
    std::snprintf(escaped, sizeof escaped, "\\x%02x", byte);
    result += escaped;
  }
  return result + (text.size() > kMaxShown ? "...\"" : "\"");
}

std::string listed(const std::vector<std::string>& names, std::string_view last) {
  std::string result;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) result += i + 1 == names.size() ? " " + std::string(last) + " " : ", ";
    result += "\"" + names[i] + "\"";
  }
  return result;
}

std::string number(float value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  if (name.size() > 64) return {};
  const std::string* nearest = nullptr;
  std::size_t best = std::max<std::size_t>(1, (name.size() + 1) / 3) + 1;
  for (const std::string& candidate : known)
    if (const std::size_t d = edit_distance(name, candidate); d < best) {
      best = d;
      nearest = &candidate;
    }
  return nearest ? " (did you mean \"" + *nearest + "\"?)" : std::string();
}

}  // namespace fogbow
