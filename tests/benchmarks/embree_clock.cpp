// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/benchmarks/embree_clock.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <chrono>
#include <thread>

namespace fogbow {

namespace {

#if defined(__x86_64__)
std::uint64_t ticks() { return __builtin_ia32_rdtsc(); }
double measure_seconds_per_tick() {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const std::uint64_t first = ticks();
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  const std::chrono::duration<double> passed = Clock::now() - start;
  return passed.count() / static_cast<double>(ticks() - first);
}
#else
std::uint64_t ticks() {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}
double measure_seconds_per_tick() {
  using Period = std::chrono::steady_clock::period;
  return static_cast<double>(Period::num) / Period::den;
}
#endif

double seconds_per_tick() {
  static const double value = measure_seconds_per_tick();
  return value;
}

thread_local std::uint64_t inside = 0, calls = 0;

/// Counts the time between construction and destruction in, or out.
class Stopwatch {
 public:
  explicit Stopwatch(std::int64_t sign) : sign_(sign), start_(ticks()) {}
  ~Stopwatch() { inside += static_cast<std::uint64_t>(sign_) * (ticks() - start_); }

 private:
  std::int64_t sign_;
  std::uint64_t start_;
};

thread_local RTCFilterFunctionN asked_filter = nullptr;
void timed_filter(const RTCFilterFunctionNArguments* arguments) {
  const Stopwatch outside(-1);
  asked_filter(arguments);
}

/// Of all analytic shapes there is one such function each.
RTCIntersectFunctionN asked_intersect = nullptr;
RTCOccludedFunctionN asked_occluded = nullptr;
void timed_intersect(const RTCIntersectFunctionNArguments* arguments) {
  const Stopwatch outside(-1);
  asked_intersect(arguments);
}
void timed_occluded(const RTCOccludedFunctionNArguments* arguments) {
  const Stopwatch outside(-1);
  asked_occluded(arguments);
}

/// A query whose filter is timed.
template <class Carrier, class Query>
void trace(Carrier& carrier, Query&& query) {
  ++calls;
  asked_filter = carrier.filter;
  if (asked_filter) carrier.filter = timed_filter;
  const Stopwatch in(1);
  query();
}

}  // namespace

EmbreeClock EmbreeClock::now() {
  return {static_cast<double>(static_cast<std::int64_t>(inside)) * seconds_per_tick(), calls};
}

double precise_seconds() { return static_cast<double>(ticks()) * seconds_per_tick(); }

// The linker's names.
extern "C" {
#if RTC_VERSION_MAJOR >= 4
void __real_rtcIntersect1(RTCScene, RTCRayHit*, RTCIntersectArguments*);
void __wrap_rtcIntersect1(RTCScene scene, RTCRayHit* ray, RTCIntersectArguments* arguments) {
  trace(*arguments, [&] { __real_rtcIntersect1(scene, ray, arguments); });
}
void __real_rtcOccluded1(RTCScene, RTCRay*, RTCOccludedArguments*);
void __wrap_rtcOccluded1(RTCScene scene, RTCRay* ray, RTCOccludedArguments* arguments) {
  trace(*arguments, [&] { __real_rtcOccluded1(scene, ray, arguments); });
}
#else
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* ray) {
  trace(*context, [&] { __real_rtcIntersect1(scene, context, ray); });
}
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);
void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
  trace(*context, [&] { __real_rtcOccluded1(scene, context, ray); });
}
#endif
void __real_rtcSetGeometryIntersectFunction(RTCGeometry, RTCIntersectFunctionN);
void __wrap_rtcSetGeometryIntersectFunction(RTCGeometry geometry, RTCIntersectFunctionN function) {
  asked_intersect = function;
  __real_rtcSetGeometryIntersectFunction(geometry, timed_intersect);
}
void __real_rtcSetGeometryOccludedFunction(RTCGeometry, RTCOccludedFunctionN);
void __wrap_rtcSetGeometryOccludedFunction(RTCGeometry geometry, RTCOccludedFunctionN function) {
  asked_occluded = function;
  __real_rtcSetGeometryOccludedFunction(geometry, timed_occluded);
}
}

}  // namespace fogbow
