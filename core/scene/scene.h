// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/geometry/accel.h"
#include "core/image/film.h"
#include "core/math/discrete_distribution.h"
#include "core/scene/bsdf.h"
#include "core/scene/emitter.h"
#include "core/scene/medium.h"
#include "core/scene/sensor.h"
#include "core/util/error.h"

namespace fogbow {

/// A shape with what it is made of.
struct Surface {
  std::shared_ptr<const Shape> shape;
  std::shared_ptr<const Bsdf> bsdf;
  std::shared_ptr<Emitter> emitter;  ///< null where it does not emit
  /// Where true, the media on the two sides are those named (null: vacuum); else the surface leaves
  /// the medium unchanged.
  bool medium_boundary = false;
  std::shared_ptr<const Medium> interior, exterior;
  int priority = 0;  ///< where volumes overlap the greater one holds
  std::string id;
  SourceLocation where;
};

/// What the integrator was asked to do in a scene file, as text: "max_depth" → "64".
struct IntegratorSettings {
  std::string type;
  std::vector<std::pair<std::string, std::string>> properties;
};

struct SceneDescription {
  std::vector<Surface> surfaces;
  std::vector<std::shared_ptr<Emitter>>
      emitters;  ///< those that are on no surface: point, constant
  std::shared_ptr<const Sensor> sensor;
  std::shared_ptr<const Medium> sensor_medium;
  bool sensor_medium_declared = false;
  FilmSettings film;
  IntegratorSettings integrator;
  std::string title;  ///< file name or what the user calls it
  std::uint64_t content_hash = 0;
};

class Overlaps;

/// An immutable scene, ready for rays.
class Scene {
 public:
  /// Throws Error(Scene) on what cannot be rendered; with `strict` also on what is only warned of
  /// (open or self-intersecting medium boundaries, camera or point light in an undeclared medium).
  explicit Scene(SceneDescription description, bool strict = false);
  ~Scene();
  Scene(const Scene&) = delete;

  const Accel& accel() const { return *accel_; }
  const Surface& surface(std::uint32_t shape) const { return description_.surfaces[shape]; }
  /// Those of the description, and what they are where volumes overlap.
  const std::vector<Surface>& surfaces() const { return description_.surfaces; }
  std::size_t declared_surfaces() const { return declared_surfaces_; }
  /// Under what name rays would meet a point of a shape of the description.
  std::uint32_t name_at(std::uint32_t shape, const SurfacePoint& x) const;
  SurfacePoint surface_point(const Hit& hit) const {
    const Shape& shape = *surface(hit.id.shape).shape;
    SurfacePoint x = shape.surface_point(hit.id.primitive, hit.local);
    x.shape = &shape;
    return x;
  }

  const Sensor& sensor() const { return *description_.sensor; }
  const Medium* sensor_medium() const { return description_.sensor_medium.get(); }
  const FilmSettings& film() const { return description_.film; }
  const SceneDescription& description() const { return description_; }

  /// Every medium of the scene once, in the order of the description.
  const std::vector<std::shared_ptr<const Medium>>& media() const { return media_; }
  /// The medium at a point that lies on no medium boundary (null: vacuum): that of the region
  /// between the boundaries which holds it.
  const Medium* medium_at(const Vec3& p, PrimitiveId on = kNoPrimitive) const;
  bool has_media() const { return !media_.empty(); }
  /// Surfaces that light can pass straight through.
  bool has_null_surfaces() const { return has_null_surfaces_; }

  // Emitters: those of surfaces, those on none, and a Volume for every emitting medium; chosen half
  // in proportion to their power and half alike.
  std::size_t emitter_count() const { return emitters_.size(); }
  const Emitter& emitter(std::size_t i) const { return *emitters_[i]; }
  const DiscreteDistribution& emitter_distribution() const { return emitter_distribution_; }
  /// Of all emitters, as luminance.
  double power() const { return power_; }
  /// The medium around a point of an emitter that lies on no medium boundary; for emitters at
  /// infinity the one beyond the scene.
  const Medium* medium_around_emitter(int emitter, const Vec3& p, PrimitiveId on) const {
    const auto& known = medium_around_emitter_[emitter];
    return known ? *known : medium_at(p, on);
  }
  /// Index of a surface's emitter, or of a medium's Volume emitter, in the list; −1 if it does not
  /// emit.
  int emitter_of_surface(std::uint32_t shape) const { return emitter_of_surface_[shape]; }
  int emitter_of_medium(const Medium* medium) const;
  /// Those at infinity that rays run into.
  const std::vector<int>& infinite_emitters() const { return infinite_emitters_; }

  Bounds bounds() const { return bounds_; }
  /// Radius of the sphere around the scene: what relative tolerances refer to.
  double radius() const { return radius_; }
  /// What the load-time checks found, one line each with shape and place.
  const std::vector<std::string>& warnings() const { return warnings_; }
  /// What holds where volumes overlap, or lie upon something opaque, one line each.
  const std::vector<std::string>& overlap_notes() const { return overlap_notes_; }

 private:
  struct BoundaryReport;
  void check_description() const;
  void measure();
  void place_anchors();
  /// What is seen from p in the direction of an anchor.
  struct Sighting;
  std::optional<Sighting> look(const Vec3& p, const Vec3& target, PrimitiveId on) const;
  void build_accels();
  void check_camera(const BoundaryReport& report);
  void check_point_lights(const BoundaryReport& report);
  void compare(const BoundaryReport& report, const Vec3& p, const std::string& what);
  void collect_emitters(const BoundaryReport& report);
  void drop_infinite_emitters_in_fog();
  void locate_emitters();
  bool crosses_boundary(const Bounds& box) const;
  void add_volume_emitters(const BoundaryReport& report);
  Bounds emission_bounds(const Medium* medium, const BoundaryReport& report) const;
  void warn(std::string message);

  void list_media();

  SceneDescription description_;
  std::vector<std::shared_ptr<const Medium>> media_;
  std::size_t declared_surfaces_ = 0;
  std::unique_ptr<const Overlaps> overlaps_;
  /// What rays meet of each surface of the description.
  std::vector<std::shared_ptr<const Shape>> met_shapes_;
  double touch_ = 0;  ///< distance over which surfaces touch
  std::unique_ptr<Accel> accel_;
  std::unique_ptr<Accel> boundary_accel_;       ///< of the medium boundaries alone
  std::vector<std::uint32_t> boundary_shapes_;  ///< ids in accel_ of boundary_accel_'s shapes
  std::vector<Vec3> anchors_;                   ///< points on boundaries to look at
  std::vector<std::shared_ptr<Emitter>> emitters_;
  std::vector<int> emitter_of_surface_;
  std::vector<std::optional<const Medium*>>
      medium_around_emitter_;  ///< where it is the same everywhere
  std::vector<std::pair<const Medium*, int>> emitter_of_medium_;
  std::vector<int> infinite_emitters_;
  DiscreteDistribution emitter_distribution_;
  double power_ = 0;
  Bounds bounds_;
  double radius_ = 0;
  bool has_null_surfaces_ = false;
  std::vector<std::string> warnings_, overlap_notes_;
};

}  // namespace fogbow
