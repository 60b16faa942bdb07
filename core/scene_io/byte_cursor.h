// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/util/error.h"

namespace fogbow {

static_assert(std::endian::native == std::endian::little, "files are read as they are in memory");

/// Reads a binary file from front to back, and never beyond its end.
class ByteCursor {
 public:
  ByteCursor(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  std::size_t at() const { return at_; }
  std::size_t rest() const { return bytes_.size() - at_; }

  std::string_view take(std::uint64_t size) {
    if (size > rest())
      fail("the file ends too early: " + std::to_string(size) + " bytes expected, " +
           std::to_string(rest()) + " left");
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }
  template <class T>
  T read() {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, take(sizeof value).data(), sizeof value);
    return value;
  }
  /// Of 32 bits of length.
  std::string_view read_string() { return take(read<std::uint32_t>()); }
  /// To a byte of the file, or to its end.
  void seek(std::uint64_t at) {
    if (at > bytes_.size()) fail("the file refers to byte " + std::to_string(at) + " of itself");
    at_ = at;
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::Scene, {name_, 0, 0},
                message + " (at byte " + std::to_string(at_) + ")");
  }

 private:
  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

/// IEEE 754 binary16.
float from_half(std::uint32_t half);

}  // namespace fogbow
