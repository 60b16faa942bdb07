// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/scene.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <set>

#include "core/math/spread.h"
#include "core/scene/boundary_report.h"
#include "core/scene/contact.h"
#include "core/scene/emitters.h"
#include "core/util/log.h"

namespace fogbow {

namespace {

/// Points to look at on each boundary, and how many are tried before the answer is a guess.
constexpr int kAnchorsPerShape = 8, kAnchorsTried = 8;
/// Cosine below which the facing side of a boundary is not trusted.
constexpr double kGrazing = 1e-3;
constexpr int kEscapeRays = 64;

Vec3 camera_position(const Sensor& sensor) { return sensor.sample_position(Vec2(0.5)); }

std::optional<Vec3> point_light_position(const Emitter& emitter) {
  if (emitter.kind() != EmitterKind::Point) return std::nullopt;
  const auto x = emitter.sample_position(Vec3(0.5));
  return x ? std::optional(x->surface.position) : std::nullopt;
}

/// Half by power, half alike: power alone starves the lamp that lights what the picture shows where
/// a sky or a sun is by far the stronger, and no choice of ours is then off by more than twice.
DiscreteDistribution choice_of_emitters(std::span<const double> powers, double total) {
  if (total == 0) return DiscreteDistribution(std::vector<double>(powers.size(), 1.0));
  const auto lit = static_cast<double>(powers.size() - std::ranges::count(powers, 0.0));
  std::vector<double> weights;
  for (const double power : powers) weights.push_back(power > 0 ? power / total + 1 / lit : 0);
  return DiscreteDistribution(weights);
}

}  // namespace

struct Scene::Sighting {
  const Medium* medium;  ///< on the facing side
  bool trusted;          ///< not grazing, and nothing in between
};

Scene::Scene(SceneDescription description, bool strict) : description_(std::move(description)) {
  check_description();
  declared_surfaces_ = surfaces().size();
  touch_ = touch_distance(surfaces());
  BoundaryReport report(description_.surfaces);
  overlaps_ = std::move(report.overlaps());
  overlap_notes_ = report.notes();
  build_accels();
  list_media();
  measure();
  place_anchors();
  for (std::string& message : report.warnings(*accel_)) warn(std::move(message));
  for (const std::string& note : overlap_notes_) log_info(note);
  check_camera(report);
  check_point_lights(report);
  collect_emitters(report);
  if (strict && !warnings_.empty())
    throw Error(ErrorKind::Scene, warnings_.front() + " (an error since the scene is strict)");
}

Scene::~Scene() = default;

void Scene::build_accels() {
  std::vector<std::shared_ptr<const Shape>> whole;
  for (std::uint32_t i = 0; i < declared_surfaces_; ++i)
    whole.push_back(overlaps_ ? overlaps_->shape_of(i) : surface(i).shape);
  const Contacts contacts(surfaces(), whole);
  met_shapes_ = contacts.free_parts();
  for (const std::uint32_t i : contacts.covered())
    overlap_notes_.push_back(describe(surface(i)) +
                             " touches what is opaque or shines: there light meets only that");
  std::vector<const Shape*> shapes, boundaries;
  for (const auto& shape : met_shapes_) shapes.push_back(shape.get());
  for (std::uint32_t i = 0; i < surfaces().size(); ++i) {
    has_null_surfaces_ |= surface(i).bsdf->has_passage();
    const std::uint32_t declared = overlaps_ ? overlaps_->shape(i) : i;
    if (!surface(i).medium_boundary ||
        std::ranges::find(boundary_shapes_, declared) != boundary_shapes_.end())
      continue;
    boundary_shapes_.push_back(declared);
  }
  std::ranges::sort(boundary_shapes_);
  for (const std::uint32_t i : boundary_shapes_) boundaries.push_back(whole[i].get());
  accel_ = std::make_unique<Accel>(shapes, overlaps_.get());
  boundary_accel_ = std::make_unique<Accel>(boundaries);
}

std::uint32_t Scene::name_at(std::uint32_t shape, const SurfacePoint& x) const {
  return overlaps_ ? overlaps_->name({0, {shape, x.primitive}, x.local}) : shape;
}

void Scene::warn(std::string message) {
  log_warning(message);
  warnings_.push_back(std::move(message));
}

void Scene::check_description() const {
  if (!description_.sensor) throw Error(ErrorKind::Scene, "the scene has no sensor");
  std::set<const Emitter*> seen;
  for (const Surface& s : description_.surfaces) {
    if (!s.shape || !s.bsdf)
      throw Error(ErrorKind::Scene, s.where, describe(s) + " has no geometry or no BSDF");
    if (s.emitter && s.emitter->kind() != EmitterKind::Area)
      throw Error(ErrorKind::Scene, s.where, describe(s) + " has an emitter for no surface");
    if (s.emitter && !seen.insert(s.emitter.get()).second)
      throw Error(ErrorKind::Scene, s.where, describe(s) + " shares its emitter with another");
  }
  for (const auto& emitter : description_.emitters)
    if (!emitter || emitter->kind() == EmitterKind::Area || !seen.insert(emitter.get()).second)
      throw Error(ErrorKind::Scene, "an emitter is listed twice, or belongs on a surface");
}

/// Without surfaces, what is left to measure is where camera and lights are.
void Scene::measure() {
  bounds_ = accel_->bounds();
  if (bounds_.empty()) {
    bounds_.extend(camera_position(sensor()));
    for (const auto& emitter : description_.emitters)
      if (const auto p = point_light_position(*emitter)) bounds_.extend(*p);
  }
  radius_ = bounds_.radius();
  if (radius_ == 0) radius_ = 1;
}

// --- Media

void Scene::place_anchors() {
  for (const std::uint32_t id : boundary_shapes_)
    for (int i = 0; i < kAnchorsPerShape; ++i)
      anchors_.push_back(surface(id).shape->sample(spread_point(i, kAnchorsPerShape)).position);
}

std::optional<Scene::Sighting> Scene::look(const Vec3& p, const Vec3& target,
                                           PrimitiveId on) const {
  const double distance = length(target - p);
  if (!(distance > 0)) return std::nullopt;
  const std::uint32_t own = overlaps_ && on != kNoPrimitive ? overlaps_->shape(on.shape) : on.shape;
  const auto place = std::ranges::lower_bound(boundary_shapes_, own);
  PrimitiveId from = kNoPrimitive;
  if (place != boundary_shapes_.end() && *place == own)
    from = {static_cast<std::uint32_t>(place - boundary_shapes_.begin()), on.primitive};
  // What touches the surface that p lies on is on its other side.
  const double start = on == kNoPrimitive ? 0 : 2 * touch_;
  const Ray ray{p, (target - p) / distance, start, kInfinity};
  const auto hit = boundary_accel_->intersect(ray, from);
  if (!hit) return std::nullopt;
  PrimitiveId id{boundary_shapes_[hit->id.shape], hit->id.primitive};
  const SurfacePoint x = surface(id.shape).shape->surface_point(id.primitive, hit->local);
  if (overlaps_) id.shape = overlaps_->name({hit->t, id, hit->local});
  const double cosine = dot(ray.d, x.n_g);
  const Surface& s = surface(id.shape);
  return Sighting{cosine > 0 ? s.interior.get() : s.exterior.get(),
                  std::fabs(cosine) > kGrazing && !accel_->occluded(p, x.position, on, id)};
}

/// The first boundary on any way out of a region faces it. Anchors in sight come first: with open
/// boundaries, such as the surface of a pool, walls close the region.
const Medium* Scene::medium_at(const Vec3& p, PrimitiveId on) const {
  std::optional<Sighting> guess;
  double tried = -1;  // square of the distance up to which anchors were looked at
  for (int i = 0; i < kAnchorsTried; ++i) {
    const Vec3* nearest = nullptr;
    double best = kInfinity;
    for (const Vec3& anchor : anchors_)
      if (const double d2 = length_squared(anchor - p); d2 > tried && d2 < best) {
        best = d2;
        nearest = &anchor;
      }
    if (!nearest) break;
    tried = best;
    const auto sighting = look(p, *nearest, on);
    if (!sighting) continue;
    if (sighting->trusted) return sighting->medium;
    if (!guess) guess = sighting;
  }
  if (guess) return guess->medium;
  return description_.sensor_medium_declared ? sensor_medium() : nullptr;
}

void Scene::compare(const BoundaryReport& report, const Vec3& p, const std::string& what) {
  const auto holder = overlaps_ ? overlaps_->medium_at(p) : report.medium_around(p);
  if (holder && *holder != medium_at(p))
    warn(what + " lies within the closed boundary of " + describe(*holder) +
         ", but what it sees of the boundaries says " + describe(medium_at(p)) +
         ": do boundaries overlap?");
}

void Scene::check_camera(const BoundaryReport& report) {
  const Vec3 p = camera_position(sensor());
  const Medium* found = medium_at(p);
  if (found != sensor_medium()) {
    if (description_.sensor_medium_declared)
      warn("the camera declares " + describe(sensor_medium()) + " but lies in " + describe(found) +
           "; what it declares is used");
    else
      warn("the camera lies in " + describe(found) + " and does not declare it; vacuum is used");
  }
  compare(report, p, "the camera");
}

void Scene::check_point_lights(const BoundaryReport& report) {
  for (const auto& emitter : description_.emitters) {
    const auto p = point_light_position(*emitter);
    if (!p) continue;
    const Medium* found = medium_at(*p);
    if (found && found != sensor_medium()) log_info("a point light lies in " + describe(found));
    compare(report, *p, "a point light");
  }
}

// --- Emitters

void Scene::collect_emitters(const BoundaryReport& report) {
  emitter_of_surface_.assign(surfaces().size(), -1);
  for (std::uint32_t i = 0; i < surfaces().size(); ++i) {
    if (!description_.surfaces[i].emitter) continue;
    if (i >= declared_surfaces_) {
      emitter_of_surface_[i] = emitter_of_surface_[overlaps_->shape(i)];
      continue;
    }
    emitter_of_surface_[i] = static_cast<int>(emitters_.size());
    emitters_.push_back(description_.surfaces[i].emitter);
    emitters_.back()->bind_shape(i);
  }
  drop_infinite_emitters_in_fog();
  for (const auto& emitter : description_.emitters) {
    if (emitter->kind() == EmitterKind::Infinite)
      infinite_emitters_.push_back(static_cast<int>(emitters_.size()));
    emitters_.push_back(emitter);
  }
  add_volume_emitters(report);
  if (emitters_.empty()) throw Error(ErrorKind::Scene, "the scene has no emitter");
  locate_emitters();

  std::vector<double> powers;
  for (const auto& emitter : emitters_) {
    emitter->bind(bounds_.center(), radius_);
    powers.push_back(luminance(emitter->power()));
    if (!(powers.back() >= 0) || !std::isfinite(powers.back()))
      throw Error(ErrorKind::Scene, "the power of an emitter is negative or not finite");
  }
  power_ = std::accumulate(powers.begin(), powers.end(), 0.0);
  if (!std::isfinite(power_))
    throw Error(ErrorKind::Scene, "the power of all emitters together is not finite");
  emitter_distribution_ = choice_of_emitters(powers, power_);
}

/// A box that no boundary reaches into lies in one region.
bool Scene::crosses_boundary(const Bounds& box) const {
  for (const std::uint32_t id : boundary_shapes_) {
    const Shape& shape = *surface(id).shape;
    for (std::uint32_t primitive = 0; primitive < shape.primitive_count(); ++primitive)
      if (!shape.avoids(primitive, box)) return true;
  }
  return false;
}

/// Light paths ask for the medium they start in: it is looked for once where it is the same all
/// over the emitter.
void Scene::locate_emitters() {
  medium_around_emitter_.assign(emitters_.size(), std::nullopt);
  for (std::uint32_t i = 0; i < declared_surfaces_; ++i) {
    const int emitter = emitter_of_surface_[i];
    if (emitter < 0 || surface(i).medium_boundary) continue;
    const Shape& shape = *surface(i).shape;
    if (crosses_boundary(shape.bounds())) continue;
    const SurfacePoint x = shape.sample(Vec2(0.5));
    medium_around_emitter_[emitter] = medium_at(x.position, {i, x.primitive});
  }
  for (std::size_t i = 0; i < emitters_.size(); ++i)
    if (const auto p = point_light_position(*emitters_[i]))
      medium_around_emitter_[i] = medium_at(*p);
    else if (at_infinity(emitters_[i]->kind()))
      medium_around_emitter_[i] =
          medium_at(bounds_.center() + 4 * radius_ * spread_direction(0, 1));
}

void Scene::drop_infinite_emitters_in_fog() {
  if (!has_media()) return;
  // Opaque at infinity in each of these directions, hence, one infers, in all.
  constexpr int kDirections = 32;
  for (int i = 0; i < kDirections; ++i) {
    const Vec3 d = spread_direction(i, kDirections);
    const Ray out{bounds_.center() + 4 * radius_ * d, d};
    const Medium* medium = medium_at(out.o);
    if (!medium || max_component(glm::exp(-medium->optical_depth(out, 0, kInfinity))) > 0) return;
  }
  const std::size_t dropped = std::erase_if(
      description_.emitters, [](const auto& emitter) { return at_infinity(emitter->kind()); });
  if (dropped > 0)
    warn(
        "the scene lies in unbounded fog: emitters at infinity contribute nothing and are left "
        "out");
}

Bounds Scene::emission_bounds(const Medium* medium, const BoundaryReport& report) const {
  Bounds inside;
  bool bounded = medium != sensor_medium();
  for (std::uint32_t i = 0; i < declared_surfaces_; ++i) {
    if (surface(i).medium_boundary && surface(i).interior.get() == medium) {
      inside.extend(surface(i).shape->bounds());
      bounded &= report.closed(i);
    }
  }
  for (const Surface& s : surfaces())
    if (s.medium_boundary && s.exterior.get() == medium) {
      const Bounds b = s.shape->bounds();
      bounded &= glm::all(glm::lessThanEqual(inside.lo, b.lo)) &&
                 glm::all(glm::lessThanEqual(b.hi, inside.hi));
    }
  const Bounds outer = bounded ? inside : bounds_, support = medium->support();
  return {glm::max(outer.lo, support.lo), glm::min(outer.hi, support.hi)};
}

void Scene::list_media() {
  const auto add = [&](const std::shared_ptr<const Medium>& medium) {
    if (medium && std::ranges::find(media_, medium) == media_.end()) media_.push_back(medium);
  };
  for (const Surface& s : surfaces()) {
    if (!s.medium_boundary) continue;
    add(s.interior);
    add(s.exterior);
  }
  add(description_.sensor_medium);
}

void Scene::add_volume_emitters(const BoundaryReport& report) {
  for (const auto& medium : media_) {
    if (!medium->emits()) continue;
    const Bounds bounds = emission_bounds(medium.get(), report);
    if (!(bounds.volume() > 0))
      throw Error(ErrorKind::Scene,
                  describe(medium.get()) + " emits, but nothing tells where: it needs a boundary");
    const double diagonal = length(bounds.diagonal());
    const Ray across{bounds.lo, bounds.diagonal() / diagonal};
    if (!medium->is_heterogeneous() && is_black(medium->optical_depth(across, 0, diagonal)))
      throw Error(ErrorKind::Scene, describe(medium.get()) + " emits but has no sigma_t");
    emitter_of_medium_.emplace_back(medium.get(), static_cast<int>(emitters_.size()));
    emitters_.push_back(
        make_volume_emitter(medium, bounds, [this](const Vec3& p) { return medium_at(p); }));
  }
  const Medium* around = sensor_medium();
  if (!around || !around->emits()) return;
  for (int i = 0; i < kEscapeRays; ++i)
    if (!accel_->intersect({camera_position(sensor()), spread_direction(i, kEscapeRays)})) {
      warn(describe(around) +
           " emits and is not bounded: its light from beyond the scene's bounds is not sampled");
      return;
    }
}

int Scene::emitter_of_medium(const Medium* medium) const {
  for (const auto& [emitting, index] : emitter_of_medium_)
    if (emitting == medium) return index;
  return -1;
}

}  // namespace fogbow
