// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/contact.h"

#include <algorithm>

#include "core/geometry/trimmed.h"
#include "core/math/spread.h"

namespace fogbow {

namespace {

constexpr double kTouch = 0x1p-22;  ///< in parts of the largest coordinate
/// Cosine between the normals of surfaces that touch, at least: others cross.
constexpr double kAlong = 0.999;
/// Points of a surface at which a contact is looked for.
constexpr int kPoints = 1024;
/// Size of what rays can be traced to, with a margin.
constexpr double kLeast = 1e-9;

using ShapePointer = std::shared_ptr<const Shape>;

}  // namespace

bool is_opaque(const Surface& surface) {
  const Bsdf& bsdf = *surface.bsdf;
  return !bsdf.has_passage() && bsdf.eta() == 1 && !bsdf.between(1.5, 1);
}

/// What is met of two surfaces at one place: that of the higher rank. Nothing for what both shines
/// and lets light through: it stays.
enum class Contacts::Rank { Transparent, Opaque, Lamp };
std::optional<Contacts::Rank> Contacts::rank(const Surface& surface) {
  if (is_opaque(surface)) return surface.emitter ? Rank::Lamp : Rank::Opaque;
  if (surface.emitter) return std::nullopt;
  return Rank::Transparent;
}

double touch_distance(const std::vector<Surface>& surfaces) {
  double largest = 0;
  for (const Surface& s : surfaces) {
    const Bounds b = s.shape->bounds();
    largest = std::max(largest, max_component(glm::max(glm::abs(b.lo), glm::abs(b.hi))));
  }
  return kTouch * largest;
}

/// Surfaces that other surfaces may touch.
class Contacts::Cover {
 public:
  Cover(std::vector<ShapePointer> shapes, double touch)
      : shapes_(std::move(shapes)), accel_(pointers(shapes_)), touch_(touch) {}

  /// Whether one of them lies upon x.
  bool holds(const SurfacePoint& x) const {
    Ray ray{x.position - touch_ * x.n_g, x.n_g, 0, 2 * touch_};
    PrimitiveId from = kNoPrimitive;
    while (const auto hit = accel_.intersect(ray, from)) {
      const Shape& shape = *shapes_[hit->id.shape];
      const Vec3 n = shape.surface_point(hit->id.primitive, hit->local).n_g;
      if (std::abs(dot(n, x.n_g)) > kAlong) return true;
      ray.t_min = hit->t;
      from = hit->id;
    }
    return false;
  }
  bool holds_some_of(const Shape& shape) const {
    const Bounds b = accel_.bounds();
    for (int i = 0; i < kPoints; ++i) {
      const SurfacePoint x = shape.sample(spread_point(i, kPoints));
      if (contains(b, x.position, touch_) && holds(x)) return true;
    }
    return false;
  }

 private:
  static bool contains(const Bounds& b, const Vec3& p, double margin) {
    return glm::all(glm::lessThanEqual(b.lo - margin, p)) &&
           glm::all(glm::lessThanEqual(p, b.hi + margin));
  }
  static std::vector<const Shape*> pointers(const std::vector<ShapePointer>& shapes) {
    std::vector<const Shape*> list;
    for (const ShapePointer& shape : shapes) list.push_back(shape.get());
    return list;
  }

  std::vector<ShapePointer> shapes_;
  Accel accel_;
  double touch_;
};

Contacts::Contacts(const std::vector<Surface>& surfaces, const std::vector<ShapePointer>& met)
    : free_parts_(met), touch_(touch_distance(surfaces)) {
  std::vector<std::optional<Rank>> ranks;
  for (std::size_t i = 0; i < met.size(); ++i) ranks.push_back(rank(surfaces[i]));
  for (const Rank lower : {Rank::Transparent, Rank::Opaque}) trim_all(ranks, lower);
}

void Contacts::trim_all(const std::vector<std::optional<Rank>>& ranks, Rank lower) {
  std::vector<ShapePointer> higher;
  Bounds bounds;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    if (!ranks[i] || *ranks[i] <= lower) continue;
    higher.push_back(free_parts_[i]);
    bounds.extend(free_parts_[i]->bounds());
  }
  if (!(bounds.radius() > kLeast)) return;
  std::shared_ptr<const Cover> cover;  // made when it is wanted
  for (std::uint32_t i = 0; i < ranks.size(); ++i) {
    const Bounds b = free_parts_[i]->bounds();
    if (ranks[i] != lower || !(b.radius() > kLeast)) continue;
    std::vector<ShapePointer> near;
    std::ranges::copy_if(higher, std::back_inserter(near), [&](const ShapePointer& other) {
      return Bounds{b.lo - touch_, b.hi + touch_}.overlaps(other->bounds());
    });
    if (near.empty()) continue;
    if (!cover) cover = std::make_shared<const Cover>(higher, touch_);
    if (touches(*cover, free_parts_[i], near)) trim(i, cover);
  }
}

/// Looked for from both sides: a small face in a large one is found from its own.
bool Contacts::touches(const Cover& cover, const ShapePointer& shape,
                       const std::vector<ShapePointer>& near) const {
  if (cover.holds_some_of(*shape)) return true;
  const Cover own({shape}, touch_);
  return std::ranges::any_of(near, [&](const auto& other) { return own.holds_some_of(*other); });
}

void Contacts::trim(std::uint32_t surface, const std::shared_ptr<const Cover>& cover) {
  covered_.push_back(surface);
  ShapePointer& part = free_parts_[surface];
  part = make_trimmed(part, [cover, whole = part](std::uint32_t primitive, const Vec2& local) {
    return !cover->holds(whole->surface_point(primitive, local));
  });
}

}  // namespace fogbow
