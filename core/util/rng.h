// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <bit>
#include <cstdint>

namespace fogbow {

/// Separate streams for separate purposes, so that no two ever share numbers.
enum class RngDomain : std::uint32_t { Bootstrap, WarmUp, Chain, Film, Sampling, Test };

/// xoshiro256++ (Blackman and Vigna 2021), seeded by one Philox block (Salmon et al. 2011).
class Rng {
 public:
  /// The stream of (seed, domain, stream, step); any two distinct keys give independent streams.
  Rng(std::uint64_t seed, RngDomain domain, std::uint64_t stream, std::uint64_t step);

  std::uint64_t next() {
    const std::uint64_t result = std::rotl(s_[0] + s_[3], 23) + s_[0];
    const std::uint64_t t = s_[1] << 17;
    s_[2] ^= s_[0];
    s_[3] ^= s_[1];
    s_[1] ^= s_[2];
    s_[0] ^= s_[3];
    s_[2] ^= t;
    s_[3] = std::rotl(s_[3], 45);
    return result;
  }

  /// Uniform on [0, 1), 53 bits.
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }

 private:
  std::array<std::uint64_t, 4> s_;
};

}  // namespace fogbow
