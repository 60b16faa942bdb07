// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <istream>
#include <ostream>
#include <span>
#include <type_traits>
#include <vector>

#include "core/util/error.h"

namespace fogbow {

/// Bytes of trivially copyable values, in the machine's order (a checkpoint is read where it was
/// written).
template <class T>
void write_binary(std::ostream& out, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Throws Error(InputOutput) where the stream ends early.
template <class T>
T read_binary(std::istream& in) {
  static_assert(std::is_trivially_copyable_v<T>);
  T value{};
  if (!in.read(reinterpret_cast<char*>(&value), sizeof value))
    throw Error(ErrorKind::InputOutput, "saved state ends before it should");
  return value;
}

template <class T>
void write_binary_vector(std::ostream& out, const std::vector<T>& values) {
  write_binary(out, static_cast<std::uint64_t>(values.size()));
  for (const T& v : values) write_binary(out, v);
}

/// Throws Error(InputOutput) where more than `max_size` values are announced.
template <class T>
std::vector<T> read_binary_vector(std::istream& in, std::uint64_t max_size) {
  const auto size = read_binary<std::uint64_t>(in);
  if (size > max_size)
    throw Error(ErrorKind::InputOutput, "saved state announces " + std::to_string(size) +
                                            " values where at most " + std::to_string(max_size) +
                                            " are possible");
  std::vector<T> values;
  for (std::uint64_t i = 0; i < size; ++i) values.push_back(read_binary<T>(in));
  return values;
}

}  // namespace fogbow
