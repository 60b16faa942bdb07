// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/accel.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <string>

#include "core/geometry/decision.h"
#include "core/util/check.h"
#include "core/util/error.h"

/// Embree only proposes: whatever single precision could get wrong is decided in double precision
/// by Shape::intersect. That is, in both kinds of query, candidates near an end of the ray or seen
/// at a grazing angle; for the nearest hit also the winner; for occlusion those close to an edge of
/// their primitive. Where double precision rejects what Embree saw at the edge of a primitive, or
/// where Embree does not see the primitive that the ray starts or ends on, a neighbour may have
/// been missed, which is looked for by rays shifted sideways (`resolve`).
namespace fogbow {

namespace {

#if RTC_VERSION_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
#else
using EmbreeContext = RTCIntersectContext;
#endif

// Lengths in units of the scene's coordinates, one rounding of which is 2^-24.
/// Embree's ray starts this much behind the true start and ends as much beyond the true end.
constexpr double kShift = 0x1p-13;
/// Distance from an edge, across the ray, at which Embree may take the wrong side: what rounding
/// does to origin, direction and vertices.
constexpr double kEdge = 0x1p-21;
/// Below this cosine the error of Embree's t may exceed the shift.
constexpr double kGrazing = 0x1p-7;
/// Longest edge of a triangle over the square root of twice its area, slivers excepted.
constexpr double kStretch = 4;
/// Coordinates, and sizes of scenes, with products that single precision still holds.
constexpr double kLargest = 1e12, kSmallest = 1e-10;

enum class Purpose : std::uint8_t { Nearest, Occlusion, Resolution };

/// What the callbacks need to know of a query; Embree hands back the address of its first member.
struct Query {
  EmbreeContext context;
  detail::Decision decision;
  const char* quads;  ///< whether a shape's primitives are quads
  Purpose purpose;
  double base;         ///< t of the true ray where Embree's is 0
  double first, last;  ///< between these of Embree's t a candidate is far from the ends
  double edge;         ///< kEdge in world units

  static Query& of(EmbreeContext* context) { return *reinterpret_cast<Query*>(context); }
};

/// |Ng|² and (Ng·d)² of a candidate; |Ng| is twice the area of a triangle.
struct Facing {
  double normal2, projected2;

  Facing(const RTCRay& ray, const RTCHit& hit) {
    const Vec3 n(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    normal2 = length_squared(n);
    projected2 = sqr(dot(n, Vec3(ray.dir_x, ray.dir_y, ray.dir_z)));
  }
};

/// Whether Embree is right that the ray passes within the primitive's edges.
bool is_within(const Query& query, const Facing& facing, const RTCHit& hit) {
  const double u = hit.u, v = hit.v;
  const double inside = query.quads[hit.geomID] ? std::min(std::min(u, v), 1 - std::max(u, v))
                                                : std::min(std::min(u, v), 1 - u - v);
  // inside · |Ng·d| > strip · longest edge, and the longest edge is at most kStretch |Ng|^½.
  return inside > 0 &&
         sqr(sqr(inside) * facing.projected2) > sqr(sqr(query.edge * kStretch)) * facing.normal2;
}

/// Whether Embree is right about t, as far as its comparison with the ends is concerned.
bool is_between(const Query& query, const Facing& facing, const RTCRay& ray) {
  return ray.tfar > query.first && ray.tfar < query.last &&
         facing.projected2 > sqr(kGrazing) * facing.normal2;
}

void filter(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  Query& query = Query::of(args->context);
  detail::Decision& decision = query.decision;
  const RTCRay& ray = *reinterpret_cast<const RTCRay*>(args->ray);
  const RTCHit& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const PrimitiveId id{hit.geomID, hit.primID};
  const Facing facing(ray, hit);
  if (id == decision.from || id == decision.to) {
    args->valid[0] = 0;
    if (!is_within(query, facing, hit)) return;
    if (id == decision.from) decision.from_missed = false;
    if (id == decision.to) decision.to_missed = false;
    return;
  }
  if (query.purpose != Purpose::Resolution && is_between(query, facing, ray) &&
      (query.purpose == Purpose::Nearest || is_within(query, facing, hit)))
    return;
  if (!decision.accept(id)) args->valid[0] = 0;
}

// --- Analytic shapes

struct AnalyticGeometry {
  const Shape* shape;
  std::uint32_t id;
};

void analytic_bounds(const RTCBoundsFunctionArguments* args) {
  const auto& geometry = *static_cast<const AnalyticGeometry*>(args->geometryUserPtr);
  const Bounds b = geometry.shape->primitive_bounds(args->primID);
  // Wide enough for a ray whose origin was rounded.
  const double margin = 0x1p-20 * max_component(glm::max(glm::abs(b.lo), glm::abs(b.hi)));
  const glm::vec3 lo(b.lo - margin), hi(b.hi + margin);
  *args->bounds_o = {lo.x, lo.y, lo.z, 0, hi.x, hi.y, hi.z, 0};
}

void analytic_intersect(const RTCIntersectFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  Query& query = Query::of(args->context);
  RTCRayHit& rayhit = *reinterpret_cast<RTCRayHit*>(args->rayhit);
  const PrimitiveId id{static_cast<const AnalyticGeometry*>(args->geometryUserPtr)->id,
                       args->primID};
  const auto hit = query.decision.decide(id);
  if (!hit) return;
  const float t = static_cast<float>(hit->t - query.base);
  if (!(t < rayhit.ray.tfar)) return;
  rayhit.ray.tfar = t;
  rayhit.hit.geomID = id.shape;
  rayhit.hit.primID = id.primitive;
  query.decision.best = {hit->t, id, hit->local};
}

void analytic_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  Query& query = Query::of(args->context);
  const PrimitiveId id{static_cast<const AnalyticGeometry*>(args->geometryUserPtr)->id,
                       args->primID};
  if (query.decision.decide(id)) reinterpret_cast<RTCRay*>(args->ray)->tfar = -HUGE_VALF;
}

// --- The two calls, in both versions of Embree

#if RTC_VERSION_MAJOR >= 4
template <class Arguments>
Arguments with_filter(Query& query, Arguments arguments) {
  rtcInitRayQueryContext(&query.context);
  arguments.context = &query.context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  return arguments;
}
void trace_nearest(RTCScene scene, Query& query, RTCRayHit& rayhit) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments = with_filter(query, arguments);
  rtcIntersect1(scene, &rayhit, &arguments);
}
void trace_occlusion(RTCScene scene, Query& query, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments = with_filter(query, arguments);
  rtcOccluded1(scene, &ray, &arguments);
}
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
#else
void trace_nearest(RTCScene scene, Query& query, RTCRayHit& rayhit) {
  rtcInitIntersectContext(&query.context);
  query.context.filter = filter;
  rtcIntersect1(scene, &query.context, &rayhit);
}
void trace_occlusion(RTCScene scene, Query& query, RTCRay& ray) {
  rtcInitIntersectContext(&query.context);
  query.context.filter = filter;
  rtcOccluded1(scene, &query.context, &ray);
}
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
#endif

PrimitiveId shape_behind(const HitNames* names, PrimitiveId id) {
  if (!names || id == kNoPrimitive) return id;
  return {names->shape(id.shape), id.primitive};
}

void check_ray(const Ray& ray) {
  FOGBOW_CHECK(is_finite(ray.o) && is_finite(ray.d) && std::isfinite(ray.t_min) &&
               !std::isnan(ray.t_max));
}

}  // namespace

struct Accel::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<const Shape*> shapes;
  std::vector<char> planar, quads;  ///< of each shape
  std::vector<AnalyticGeometry> analytic;
  std::atomic<std::int64_t> memory{0};
  Bounds bounds;
  Vec3 center{0};
  double radius = 0;
  double magnitude = 0;  ///< of the coordinates that rays have, in which tolerances are counted

  explicit Impl(std::span<const Shape* const> list) : shapes(list.begin(), list.end()) {
    measure();
    device = rtcNewDevice(std::getenv("FOGBOW_EMBREE_CONFIG"));
    if (!device) fail(rtcGetDeviceError(nullptr));
    rtcSetDeviceMemoryMonitorFunction(
        device,
        [](void* self, ssize_t bytes, bool) {
          static_cast<Impl*>(self)->memory += bytes;
          return true;
        },
        this);
    scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | kFilterFlag);
    analytic.reserve(shapes.size());  // Embree keeps addresses
    for (std::uint32_t i = 0; i < shapes.size(); ++i) attach(i);
    rtcCommitScene(scene);
    const RTCError error = rtcGetDeviceError(device);
    if (error != RTC_ERROR_NONE) {
      release();
      fail(error);
    }
  }
  ~Impl() { release(); }
  Impl(const Impl&) = delete;

  void release() {
    if (scene) rtcReleaseScene(scene);
    if (device) rtcReleaseDevice(device);
    scene = nullptr;
    device = nullptr;
  }

  [[noreturn]] static void fail(RTCError error) {
    if (error == RTC_ERROR_OUT_OF_MEMORY)
      throw Error(ErrorKind::Memory, "not enough memory for the ray tracing structure");
    throw Error(ErrorKind::Scene, "Embree refused the scene: error " + std::to_string(error));
  }

  void measure() {
    for (const Shape* shape : shapes) bounds.extend(shape->bounds());
    if (shapes.empty()) return;
    const double largest = max_component(glm::max(glm::abs(bounds.lo), glm::abs(bounds.hi)));
    center = bounds.center();
    radius = bounds.radius();
    if (!(largest <= kLargest) || !(radius >= kSmallest))
      throw Error(ErrorKind::Scene,
                  "the scene's size is beyond what single precision can trace; use another unit "
                  "of length (coordinates up to 1e12, at least 1e-10 across)");
    magnitude = largest + 2 * radius;
  }

  void attach(std::uint32_t id) {
    const Shape& shape = *shapes[id];
    planar.push_back(shape.polygonal());
    quads.push_back(shape.primitive_kind() == PrimitiveKind::Quads);
    RTCGeometry geometry;
    if (shape.primitive_kind() == PrimitiveKind::Analytic) {
      geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
      analytic.push_back({&shape, id});
      rtcSetGeometryUserPrimitiveCount(geometry, shape.primitive_count());
      rtcSetGeometryUserData(geometry, &analytic.back());
      rtcSetGeometryBoundsFunction(geometry, analytic_bounds, nullptr);
      rtcSetGeometryIntersectFunction(geometry, analytic_intersect);
      rtcSetGeometryOccludedFunction(geometry, analytic_occluded);
    } else {
      const bool quad = quads[id];
      geometry = rtcNewGeometry(device, quad ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
      const PrimitiveBuffers buffers = shape.buffers();
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                 buffers.vertices.data(), 0, sizeof(glm::vec3),
                                 buffers.vertices.size());
      const std::size_t corners = quad ? 4 : 3;
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                 quad ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3, buffers.indices.data(),
                                 0, corners * sizeof(std::uint32_t),
                                 buffers.indices.size() / corners);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  bool is_planar(PrimitiveId id) const { return id != kNoPrimitive && planar[id.shape]; }

  /// Embree's version of the query's ray.
  RTCRay prepare(Query& query) const {
    const Ray& ray = *query.decision.ray;
    const double shift = kShift * magnitude;
    double start = ray.t_min;
    // From afar: begin near the scene, where single precision can tell things apart.
    if (length_squared(ray(start) - center) > sqr(4 * radius))
      start = std::min(std::max(start, dot(center - ray.o, ray.d) - 2 * radius), ray.t_max);
    query.base = start - shift;
    const glm::vec3 origin(ray(query.base)), d(ray.d);
    const float length = static_cast<float>(ray.t_max - query.base + shift);
    query.first = 2 * shift;
    query.last = length - 2 * shift;
    return {origin.x, origin.y, origin.z, 0, d.x, d.y, d.z, 0, length, ~0u, 0, 0};
  }

  Query make_query(const Ray& ray, PrimitiveId from, PrimitiveId to, Purpose purpose) const {
    Query query;
    // A segment within one plane meets that primitive nowhere else.
    query.decision = {
        shapes.data(), &ray, from, to, is_planar(from) && from != to, is_planar(to) && from != to};
    query.quads = quads.data();
    query.purpose = purpose;
    query.edge = kEdge * magnitude;
    return query;
  }

  /// Decides on all primitives that touch a ball.
  void try_around(detail::Decision& decision, const detail::Ball& place) const {
    if (!decision.doubtful->add_place(place.center, 0.25 * place.radius)) return;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const glm::vec3 p(place.center);
    RTCPointQuery ball{p.x, p.y, p.z, 0, static_cast<float>(place.radius)};
    rtcPointQuery(
        scene, &ball, &context,
        [](RTCPointQueryFunctionArguments* args) {
          detail::Decision& d = *static_cast<detail::Decision*>(args->userPtr);
          const PrimitiveId id{args->geomID, args->primID};
          if (!d.shapes[id.shape]->polygonal() || (id != d.from && id != d.to)) d.accept(id);
          return false;  // the ball keeps its size
        },
        &decision);
  }

  /// Tries what shares the edges of a planar primitive at which the ray passes.
  void try_neighbours(detail::Decision& decision, PrimitiveId id) const {
    const PrimitiveBuffers buffers = shapes[id.shape]->buffers();
    const std::size_t corners = quads[id.shape] ? 4 : 3;
    const auto corner = [&](std::size_t k) {
      return Vec3(buffers.vertices[buffers.indices[corners * id.primitive + k % corners]]);
    };
    for (std::size_t k = 0; k < corners; ++k) {
      const Vec3 a = corner(k);
      const auto place =
          detail::passage(*decision.ray, a, corner(k + 1) - a, 2 * kEdge * magnitude);
      if (place) try_around(decision, *place);
    }
  }

  RTCRayHit nearest(Query& query) const {
    RTCRayHit rayhit;
    rayhit.ray = prepare(query);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    trace_nearest(scene, query, rayhit);
    return rayhit;
  }

  /// The nearest hit when all candidates are decided in double precision, and so are the
  /// neighbours of those in doubt.
  std::optional<Hit> resolve(const Ray& ray, PrimitiveId from, PrimitiveId to) const {
    detail::Doubtful doubtful;
    Query query = make_query(ray, from, to, Purpose::Resolution);
    detail::Decision& decision = query.decision;
    decision.doubtful = &doubtful;
    nearest(query);
    if (decision.from_missed) doubtful.add(from);
    if (decision.to_missed) doubtful.add(to);
    // The list grows while the ray is in doubt about neighbours, too.
    for (std::size_t i = 0; i < doubtful.count; ++i)
      try_neighbours(decision, doubtful.primitives[i]);
    if (decision.best.id == kNoPrimitive) return std::nullopt;
    return decision.best;
  }
};

Accel::Accel(std::span<const Shape* const> shapes, const HitNames* names)
    : impl_(std::make_unique<Impl>(shapes)), names_(names) {}
Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;

std::optional<Hit> Accel::intersect(const Ray& ray, PrimitiveId from) const {
  if (!names_) [[likely]]
    return intersect_shape(ray, from);
  auto hit = intersect_shape(ray, shape_behind(names_, from));
  if (hit) hit->id.shape = names_->name(*hit);
  return hit;
}

std::optional<Hit> Accel::intersect_shape(const Ray& ray, PrimitiveId from) const {
  check_ray(ray);
  if (!(ray.t_max > ray.t_min)) return std::nullopt;
  Query query = impl_->make_query(ray, from, kNoPrimitive, Purpose::Nearest);
  const RTCRayHit rayhit = impl_->nearest(query);
  if (query.decision.uncertain()) return impl_->resolve(ray, from, kNoPrimitive);
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const PrimitiveId id{rayhit.hit.geomID, rayhit.hit.primID};
  if (query.decision.best.id == id) return query.decision.best;
  if (const auto hit = impl_->shapes[id.shape]->intersect(id.primitive, ray, false))
    return Hit{hit->t, id, hit->local};
  return impl_->resolve(ray, from, kNoPrimitive);
}

bool Accel::occluded(const Vec3& a, const Vec3& b, PrimitiveId from, PrimitiveId to) const {
  const double distance = length(b - a);
  if (distance == 0) return false;
  const Ray ray{a, (b - a) / distance, 0, distance};
  check_ray(ray);
  from = shape_behind(names_, from);
  to = shape_behind(names_, to);
  Query query = impl_->make_query(ray, from, to, Purpose::Occlusion);
  RTCRay embree_ray = impl_->prepare(query);
  trace_occlusion(impl_->scene, query, embree_ray);
  if (embree_ray.tfar < 0) return true;
  return query.decision.uncertain() && impl_->resolve(ray, from, to).has_value();
}

Bounds Accel::bounds() const { return impl_->bounds; }
std::size_t Accel::memory_bytes() const { return static_cast<std::size_t>(impl_->memory.load()); }

}  // namespace fogbow
