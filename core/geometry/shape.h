// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/math/frame.h"
#include "core/math/ray.h"
#include "core/math/vec.h"

namespace fogbow {

class Shape;

/// A point of a surface with its tangent geometry, in world space.
struct SurfacePoint {
  Vec3 position;
  Vec3 n_g;       ///< unit geometric normal; decides interior (−) and exterior (+)
  Frame shading;  ///< frame around the shading normal, n·n_g > 0
  Vec2 uv;        ///< texture coordinates
  Vec2 local;     ///< coordinates on the primitive (barycentric, or the shape's own)
  std::uint32_t primitive = 0;
  const Shape* shape = nullptr;  ///< where the point is that of a scene
};

/// First derivatives at a surface point with respect to two coordinates of the primitive.
struct SurfaceDerivatives {
  Vec3 dp_du, dp_dv;  ///< of the position
  Vec3 dn_du, dn_dv;  ///< of the unit shading normal
};

/// Where a ray meets one primitive.
struct PrimitiveHit {
  double t;
  Vec2 local;
};

/// How Embree is told of a shape.
enum class PrimitiveKind { Triangles, Quads, Analytic };

/// Indexed triangles or quads in single precision, as Embree wants them; four readable bytes follow
/// the last vertex.
struct PrimitiveBuffers {
  std::span<const glm::vec3> vertices;
  std::span<const std::uint32_t> indices;  ///< 3 or 4 per primitive
};

/// A triangle soup of a shape's surface with consistent winding (counter-clockwise seen from
/// outside).
struct Tessellation {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// One or three numbers for each vertex or each primitive of a mesh.
struct MeshAttribute {
  std::string name;
  int channels = 1;
  bool per_primitive = false;
  std::vector<float> values;
};

/// A surface in world space; immutable. Positions are evaluated in double precision, and a hit is
/// refined in it.
class Shape {
 public:
  virtual ~Shape() = default;

  virtual PrimitiveKind primitive_kind() const = 0;
  virtual std::uint32_t primitive_count() const = 0;
  /// Buffers for Triangles and Quads; empty for Analytic. They live as long as the shape.
  virtual PrimitiveBuffers buffers() const = 0;
  virtual Bounds bounds() const = 0;
  virtual Bounds primitive_bounds(std::uint32_t primitive) const = 0;

  /// Nearest intersection with t in (ray.t_min, ray.t_max), in double precision.
  /// What double rounding cannot tell from an end of the ray is no hit; planar primitives accept
  /// barycentrics a double rounding error outside, so that shared edges have no gap.
  /// `leaving`: the ray starts on this very primitive, at a point with a root at t = 0, which is
  /// not a hit.
  virtual std::optional<PrimitiveHit> intersect(std::uint32_t primitive, const Ray& ray,
                                                bool leaving) const = 0;
  /// Primitives are flat, with straight edges that neighbours may share; a ray that starts on one
  /// cannot meet it again.
  virtual bool polygonal() const = 0;

  /// True only if the primitive has no point in the box; may be false where it has none either.
  virtual bool avoids(std::uint32_t primitive, const Bounds& box) const;

  virtual SurfacePoint surface_point(std::uint32_t primitive, const Vec2& local) const = 0;
  virtual SurfaceDerivatives derivatives(const SurfacePoint& point) const = 0;

  /// Of the texture coordinates by the coordinates that derivatives() refers to; unless overridden
  /// they are the same.
  virtual std::array<Vec2, 2> uv_derivatives(const SurfacePoint&) const {
    return {Vec2(1, 0), Vec2(0, 1)};
  }
  /// Derivatives of the position by the texture coordinates; where those are singular, by the
  /// coordinates of the primitive.
  std::array<Vec3, 2> uv_tangents(const SurfacePoint& x) const;

  /// Total area, world units squared.
  virtual double area() const = 0;
  /// Uniform with respect to area: pdf_A = 1/area().
  virtual SurfacePoint sample(const Vec2& u) const = 0;
  /// The u with sample(u) = point.
  virtual Vec2 invert(const SurfacePoint& point) const = 0;

  /// What its file says of it beyond geometry.
  virtual std::span<const MeshAttribute> attributes() const { return {}; }
  /// Null if there is none of that name.
  const MeshAttribute* find_attribute(const std::string& name) const;
  /// At a point; one number counts for all channels.
  virtual RGB attribute(const SurfacePoint&, const MeshAttribute&) const { return RGB(0); }

  /// For boundary checks: exact for polygonal shapes, an inscribed mesh for curved ones.
  virtual Tessellation tessellate() const = 0;
};

/// Unit vector along ∂p/∂u in the tangent plane of the shading normal, in the shading frame; x̂
/// where that vanishes, or of no shape.
Vec2 u_axis(const SurfacePoint& x);

}  // namespace fogbow
