// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/util/error.h"

namespace fogbow {

/// Gathers warnings of one reading; with `strict` the first of them is thrown as Error(Scene).
class Diagnostics {
 public:
  Diagnostics(std::vector<std::string>& warnings, bool strict)
      : warnings_(warnings), strict_(strict) {}
  void warn(const SourceLocation& where, const std::string& message);

 private:
  std::vector<std::string>& warnings_;
  bool strict_;
  std::size_t count_ = 0;
};

/// In quotes, shortened, control characters as \xNN: what a message may show of a file.
std::string quote(std::string_view text);
/// "a", "b" and "c".
std::string listed(const std::vector<std::string>& names, std::string_view last = "and");
/// As few digits as tell it from other floats.
std::string number(float value);
/// The known name that was probably meant, as ` (did you mean "x"?)`; empty if none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

}  // namespace fogbow
