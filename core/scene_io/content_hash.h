// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <bit>
#include <cstdint>
#include <cstring>
#include <string_view>

#include "core/math/transform.h"

namespace fogbow {

/// A 64-bit hash of content, not for security: words are xored in, multiplied by an odd constant
/// and folded.
class ContentHash {
 public:
  void add(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15u;
    state_ ^= state_ >> 32;
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0 ? 0.0 : value)); }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  void add(const Transform& t) {
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) add(t.matrix()[c][r]);
  }
  void add(std::string_view bytes) {
    add(static_cast<std::uint64_t>(bytes.size()));
    for (; bytes.size() >= 8; bytes.remove_prefix(8)) add(word(bytes.substr(0, 8)));
    if (!bytes.empty()) add(word(bytes));
  }
  std::uint64_t value() const { return state_; }

 private:
  static std::uint64_t word(std::string_view bytes) {
    std::uint64_t result = 0;
    std::memcpy(&result, bytes.data(), bytes.size());
    return result;
  }
  std::uint64_t state_ = 0xcbf29ce484222325u;
};

}  // namespace fogbow
