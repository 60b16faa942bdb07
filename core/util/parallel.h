// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>
#include <functional>

namespace fogbow {

/// Bounds the threads used by `parallel_for` until destroyed; 0 means all of the machine's.
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

/// Calls task(i) once for every i in [0, count), in any order, from several threads; rethrows the
/// first exception.
void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& task);

int hardware_threads();

}  // namespace fogbow
