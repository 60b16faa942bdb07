// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/util/parallel.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>

namespace fogbow {

namespace {
using Control = oneapi::tbb::global_control;
}

ThreadLimit::ThreadLimit(int threads)
    : control_(threads > 0 ? new Control(Control::max_allowed_parallelism,
                                         static_cast<std::size_t>(threads))
                           : nullptr) {}

ThreadLimit::~ThreadLimit() { delete static_cast<Control*>(control_); }

void parallel_for(std::int64_t count, const std::function<void(std::int64_t)>& task) {
  // Tasks are long and uneven (a whole chain, a tile): no grouping.
  oneapi::tbb::parallel_for(
      oneapi::tbb::blocked_range<std::int64_t>(0, count, 1),
      [&](const auto& range) {
        for (auto i = range.begin(); i != range.end(); ++i) task(i);
      },
      oneapi::tbb::simple_partitioner());
}

int hardware_threads() { return oneapi::tbb::info::default_concurrency(); }

}  // namespace fogbow
