// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/geometry/accel.h"

#if __has_include(<embree3/rtcore.h>)
#include <embree3/rtcore.h>
#else
#include <embree4/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <string>

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

/// Primitives whose neighbours are to be tried, and where that was done. More than these occur only
/// where geometry is finer than single precision.
struct Doubtful {
  std::size_t count = 0, places = 0;
  std::array<PrimitiveId, 64> primitives;
  std::array<Vec3, 64> centers;

  void add(PrimitiveId id) {
    const auto end = primitives.begin() + count;
    if (count < primitives.size() && std::find(primitives.begin(), end, id) == end)
      primitives[count++] = id;
  }
  /// False if another place within `radius` was added before.
  bool add_place(const Vec3& center, double radius) {
    for (std::size_t i = 0; i < places; ++i)
      if (length(centers[i] - center) < radius) return false;
    if (places == centers.size()) return false;
    centers[places++] = center;
    return true;
  }
};

/// What the callbacks need to know of a query; Embree hands back the address of its first member.
struct Query {
  EmbreeContext context;
  const Shape* const* shapes;
  const Ray* ray;
  PrimitiveId from, to;
  Purpose purpose;
  bool from_missed, to_missed;   ///< Embree did not find this planar end well within its edges
  std::uint32_t doubts = 0;      ///< how many candidates were rejected at their edges;
  Doubtful* doubtful = nullptr;  ///< where they are to be listed
  double base;                   ///< t of the true ray where Embree's is 0
  double first, last;            ///< between these of Embree's t a candidate is far from the ends
  double edge;                   ///< kEdge in world units
  Hit best{kInfinity, kNoPrimitive, Vec2(0)};  ///< nearest of those decided in double precision

  bool uncertain() const { return doubts > 0 || from_missed || to_missed; }
  static Query& of(EmbreeContext* context) { return *reinterpret_cast<Query*>(context); }
};

/// In double precision.
std::optional<PrimitiveHit> decide(Query& query, PrimitiveId id) {
  const Shape& shape = *query.shapes[id.shape];
  const Ray& ray = *query.ray;
  if (id == query.to && id != query.from) {
    // The end point is a root that only the ray leaving it can exclude exactly.
    const Ray back{ray(ray.t_max), -ray.d, 0, ray.t_max - ray.t_min};
    return shape.intersect(id.primitive, back, true);
  }
  auto hit = shape.intersect(id.primitive, ray, id == query.from);
  if (!hit && shape.planar()) {
    const Ray line{ray.o, ray.d, -kInfinity, kInfinity};
    if (!shape.intersect(id.primitive, line, false)) {
      ++query.doubts;
      if (query.doubtful) query.doubtful->add(id);
    }
  }
  return hit;
}

/// |Ng| and |Ng·d| of a candidate; |Ng| is twice the area of a triangle.
struct Facing {
  double normal, projected;

  Facing(const RTCRay& ray, const RTCHit& hit) {
    const Vec3 n(hit.Ng_x, hit.Ng_y, hit.Ng_z);
    normal = length(n);
    projected = std::fabs(n.x * ray.dir_x + n.y * ray.dir_y + n.z * ray.dir_z);
  }
};

/// Whether Embree is right that the ray passes within the primitive's edges.
bool is_within(const Query& query, const Facing& facing, const RTCHit& hit) {
  const double u = hit.u, v = hit.v;
  const bool quad = query.shapes[hit.geomID]->primitive_kind() == PrimitiveKind::Quads;
  const double inside = std::fmin(std::fmin(u, v), quad ? 1 - std::fmax(u, v) : 1 - u - v);
  // inside times the height over the longest edge, foreshortened
  return inside * facing.projected > query.edge * kStretch * std::sqrt(facing.normal);
}

/// Whether Embree is right about t, as far as its comparison with the ends is concerned.
bool is_between(const Query& query, const Facing& facing, const RTCRay& ray) {
  return ray.tfar > query.first && ray.tfar < query.last &&
         facing.projected > kGrazing * facing.normal;
}

void filter(const RTCFilterFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  Query& query = Query::of(args->context);
  const RTCRay& ray = *reinterpret_cast<const RTCRay*>(args->ray);
  const RTCHit& hit = *reinterpret_cast<const RTCHit*>(args->hit);
  const PrimitiveId id{hit.geomID, hit.primID};
  const Facing facing(ray, hit);
  if (id == query.from || id == query.to) {
    args->valid[0] = 0;
    if (!is_within(query, facing, hit)) return;
    if (id == query.from) query.from_missed = false;
    if (id == query.to) query.to_missed = false;
    return;
  }
  if (query.purpose != Purpose::Resolution && is_between(query, facing, ray) &&
      (query.purpose == Purpose::Nearest || is_within(query, facing, hit)))
    return;
  const auto exact = decide(query, id);
  if (!exact)
    args->valid[0] = 0;
  else if (exact->t < query.best.t)
    query.best = {exact->t, id, exact->local};
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
  const auto hit = decide(query, id);
  if (!hit) return;
  const float t = static_cast<float>(hit->t - query.base);
  if (!(t < rayhit.ray.tfar)) return;
  rayhit.ray.tfar = t;
  rayhit.hit.geomID = id.shape;
  rayhit.hit.primID = id.primitive;
  query.best = {hit->t, id, hit->local};
}

void analytic_occluded(const RTCOccludedFunctionNArguments* args) {
  if (args->valid[0] == 0) return;
  Query& query = Query::of(args->context);
  const PrimitiveId id{static_cast<const AnalyticGeometry*>(args->geometryUserPtr)->id,
                       args->primID};
  if (decide(query, id)) reinterpret_cast<RTCRay*>(args->ray)->tfar = -HUGE_VALF;
}

// --- The two calls, in both versions of Embree

#if RTC_VERSION_MAJOR >= 4
void trace_nearest(RTCScene scene, Query& query, RTCRayHit& rayhit) {
  rtcInitRayQueryContext(&query.context);
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &query.context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
  rtcIntersect1(scene, &rayhit, &arguments);
}
void trace_occlusion(RTCScene scene, Query& query, RTCRay& ray) {
  rtcInitRayQueryContext(&query.context);
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &query.context;
  arguments.filter = filter;
  arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
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

void check_ray(const Ray& ray) {
  FOGBOW_CHECK(is_finite(ray.o) && is_finite(ray.d) && std::isfinite(ray.t_min) &&
               !std::isnan(ray.t_max));
}

}  // namespace

struct Accel::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<const Shape*> shapes;
  std::vector<char> planar;  ///< of each shape
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
    planar.push_back(shape.planar());
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
      const bool quads = shape.primitive_kind() == PrimitiveKind::Quads;
      geometry =
          rtcNewGeometry(device, quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
      const PrimitiveBuffers buffers = shape.buffers();
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                 buffers.vertices.data(), 0, sizeof(glm::vec3),
                                 buffers.vertices.size());
      const std::size_t corners = quads ? 4 : 3;
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                 quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
                                 buffers.indices.data(), 0, corners * sizeof(std::uint32_t),
                                 buffers.indices.size() / corners);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }

  bool is_planar(PrimitiveId id) const { return id != kNoPrimitive && planar[id.shape]; }

  /// Embree's version of the query's ray.
  RTCRay prepare(Query& query) const {
    const Ray& ray = *query.ray;
    const double shift = kShift * magnitude;
    double start = ray.t_min;
    // From afar: begin near the scene, where single precision can tell things apart.
    if (length_squared(ray(start) - center) > sqr(4 * radius))
      start = std::fmin(std::fmax(start, dot(center - ray.o, ray.d) - 2 * radius), ray.t_max);
    query.base = start - shift;
    const Vec3 o = ray(query.base);
    RTCRay r;
    r.org_x = static_cast<float>(o.x);
    r.org_y = static_cast<float>(o.y);
    r.org_z = static_cast<float>(o.z);
    r.dir_x = static_cast<float>(ray.d.x);
    r.dir_y = static_cast<float>(ray.d.y);
    r.dir_z = static_cast<float>(ray.d.z);
    r.tnear = 0;
    r.time = 0;
    r.tfar = static_cast<float>(ray.t_max - query.base + shift);
    r.mask = ~0u;
    r.id = 0;
    r.flags = 0;
    query.first = 2 * shift;
    query.last = r.tfar - 2 * shift;
    return r;
  }

  Query make_query(const Ray& ray, PrimitiveId from, PrimitiveId to, Purpose purpose) const {
    Query query;
    query.shapes = shapes.data();
    query.ray = &ray;
    query.from = from;
    query.to = to;
    query.purpose = purpose;
    query.from_missed = is_planar(from);
    query.to_missed = is_planar(to);
    query.edge = kEdge * magnitude;
    return query;
  }

  /// Decides on all primitives around a point; `best` keeps the nearest hit.
  void try_around(Query& query, const Vec3& center, double radius) const {
    if (!query.doubtful->add_place(center, 0.25 * radius)) return;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    const glm::vec3 p(center);
    RTCPointQuery ball{p.x, p.y, p.z, 0, static_cast<float>(radius)};
    rtcPointQuery(
        scene, &ball, &context,
        [](RTCPointQueryFunctionArguments* args) {
          Query& q = *static_cast<Query*>(args->userPtr);
          const PrimitiveId id{args->geomID, args->primID};
          if (q.shapes[id.shape]->planar() && (id == q.from || id == q.to)) return false;
          const auto hit = decide(q, id);
          if (hit && hit->t < q.best.t) q.best = {hit->t, id, hit->local};
          return false;  // the ball keeps its size
        },
        &query);
  }

  /// Tries what shares the edges of a planar primitive at which the ray passes.
  void try_neighbours(Query& query, PrimitiveId id) const {
    const PrimitiveBuffers buffers = shapes[id.shape]->buffers();
    const std::size_t corners = shapes[id.shape]->primitive_kind() == PrimitiveKind::Quads ? 4 : 3;
    const Ray& ray = *query.ray;
    const double reach = 2 * query.edge;
    const auto corner = [&](std::size_t k) {
      return Vec3(buffers.vertices[buffers.indices[corners * id.primitive + k % corners]]);
    };
    for (std::size_t k = 0; k < corners; ++k) {
      const Vec3 a = corner(k), edge = corner(k + 1) - a;
      const Vec3 across = edge - dot(edge, ray.d) * ray.d;
      const Vec3 r = a - ray.o, aside = r - dot(r, ray.d) * ray.d;
      if (length(across) < 2 * reach) {  // the ray may run along all of the edge
        if (length(aside) < 3 * reach)
          try_around(query, a + 0.5 * edge, 0.5 * length(edge) + reach);
        continue;
      }
      const double s = std::clamp(-dot(aside, across) / length_squared(across), 0.0, 1.0);
      if (length(aside + s * across) < reach) try_around(query, a + s * edge, 1.5 * reach);
    }
  }

  /// The nearest hit when all candidates are decided in double precision, and so are the
  /// neighbours of those in doubt.
  std::optional<Hit> resolve(const Ray& ray, PrimitiveId from, PrimitiveId to) const {
    Doubtful doubtful;
    Query query = make_query(ray, from, to, Purpose::Resolution);
    query.doubtful = &doubtful;
    RTCRayHit rayhit;
    rayhit.ray = prepare(query);
    rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    trace_nearest(scene, query, rayhit);
    if (query.from_missed) doubtful.add(from);
    if (query.to_missed) doubtful.add(to);
    // The list grows while the ray is in doubt about neighbours, too.
    for (std::size_t i = 0; i < doubtful.count; ++i) try_neighbours(query, doubtful.primitives[i]);
    if (query.best.id == kNoPrimitive) return std::nullopt;
    return query.best;
  }
};

Accel::Accel(std::span<const Shape* const> shapes) : impl_(std::make_unique<Impl>(shapes)) {}
Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;
Accel& Accel::operator=(Accel&&) noexcept = default;

std::optional<Hit> Accel::intersect(const Ray& ray, PrimitiveId from) const {
  check_ray(ray);
  if (!(ray.t_max > ray.t_min)) return std::nullopt;
  Query query = impl_->make_query(ray, from, kNoPrimitive, Purpose::Nearest);
  RTCRayHit rayhit;
  rayhit.ray = impl_->prepare(query);
  rayhit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rayhit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  trace_nearest(impl_->scene, query, rayhit);
  if (query.uncertain()) return impl_->resolve(ray, from, kNoPrimitive);
  if (rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const PrimitiveId id{rayhit.hit.geomID, rayhit.hit.primID};
  if (query.best.id == id) return query.best;
  if (const auto hit = impl_->shapes[id.shape]->intersect(id.primitive, ray, false))
    return Hit{hit->t, id, hit->local};
  return impl_->resolve(ray, from, kNoPrimitive);
}

bool Accel::occluded(const Vec3& a, const Vec3& b, PrimitiveId from, PrimitiveId to) const {
  const double distance = length(b - a);
  if (distance == 0) return false;
  const Ray ray{a, (b - a) / distance, 0, distance};
  check_ray(ray);
  Query query = impl_->make_query(ray, from, to, Purpose::Occlusion);
  RTCRay embree_ray = impl_->prepare(query);
  trace_occlusion(impl_->scene, query, embree_ray);
  if (embree_ray.tfar < 0) return true;
  return query.uncertain() && impl_->resolve(ray, from, to).has_value();
}

Bounds Accel::bounds() const { return impl_->bounds; }
std::size_t Accel::memory_bytes() const { return static_cast<std::size_t>(impl_->memory.load()); }

}  // namespace fogbow
