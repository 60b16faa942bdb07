// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

namespace fogbow {

/// What this thread has spent inside Embree so far, without the functions that Embree calls back.
/// The linker leads the calls of a static library through here (--wrap); of a shared one it sees
/// none.
struct EmbreeClock {
  double seconds = 0;
  std::uint64_t rays = 0;

  static EmbreeClock now();
  EmbreeClock operator-(const EmbreeClock& before) const {
    return {seconds - before.seconds, rays - before.rays};
  }
};

/// Seconds from an arbitrary origin, by the processor's own counter where it has one: a ray takes
/// no longer than a few readings of the system's clock.
double precise_seconds();

}  // namespace fogbow
