// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <stdexcept>
#include <string>

namespace fogbow {

/// A place in an input file; line and column count from 1, 0 when unknown.
struct SourceLocation {
  std::string file;
  int line = 0;
  int column = 0;
};

/// "file:line:column", without the parts that are unknown.
std::string to_string(const SourceLocation& where);

/// Values are the exit codes of the command line.
enum class ErrorKind {
  Usage = 2,
  Scene = 3,
  InputOutput = 4,
  NoLight = 5,
  Numerical = 6,
  Memory = 33,
};

/// Bad input; what() is "file:line:column: message".
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message);
  Error(ErrorKind kind, const SourceLocation& where, const std::string& message);
  ErrorKind kind() const { return kind_; }
  const SourceLocation& where() const { return where_; }

 private:
  ErrorKind kind_;
  SourceLocation where_;
};

}  // namespace fogbow
