// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/util/error.h"

#include <cstdio>
#include <cstdlib>

#include "core/util/check.h"

namespace fogbow {

std::string to_string(const SourceLocation& where) {
  std::string text = where.file;
  if (where.line > 0) text += ":" + std::to_string(where.line);
  if (where.line > 0 && where.column > 0) text += ":" + std::to_string(where.column);
  return text;
}

Error::Error(ErrorKind kind, const std::string& message)
    : std::runtime_error(message), kind_(kind) {}

Error::Error(ErrorKind kind, const SourceLocation& where, const std::string& message)
    : std::runtime_error(where.file.empty() ? message : to_string(where) + ": " + message),
      kind_(kind),
      where_(where) {}

void check_failed(std::string_view expression, std::source_location where) {
  std::fprintf(stderr, "%s:%u: check failed: %.*s\n", where.file_name(),
               static_cast<unsigned>(where.line()), static_cast<int>(expression.size()),
               expression.data());
  std::abort();
}

}  // namespace fogbow
