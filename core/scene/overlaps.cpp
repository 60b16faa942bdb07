// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/overlaps.h"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "core/geometry/trimmed.h"
#include "core/math/spread.h"
#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/contact.h"
#include "core/util/check.h"

namespace fogbow {

namespace {

constexpr std::uint32_t kHidden = PrimitiveId::kNone;
constexpr std::size_t kMostAround = 64, kMostSurfaces = std::size_t{1} << 20;
/// Points of each surface at which its pieces are checked.
constexpr int kPoints = 64;
/// How far beyond its bounds a volume is asked about, in parts of its size.
constexpr double kMargin = 1e-6;

/// A way off a surface on the side of n that no symmetry of a scene is likely to have.
Vec3 way_off(const Vec3& n) {
  const Frame frame(n);
  return normalize(n + 0.213 * frame.s + 0.131 * frame.t);
}

bool is_null(const Bsdf& bsdf) {
  return bsdf.has_passage() && !bsdf.has_smooth() && !bsdf.has_dirac();
}

Bounds widened(const Bounds& b, double by) { return {b.lo - by, b.hi + by}; }

Bounds common(const Bounds& a, const Bounds& b) {
  return {glm::max(a.lo, b.lo), glm::min(a.hi, b.hi)};
}

}  // namespace

struct Overlaps::Volume : EnclosedVolume {
  Bounds bounds;
  double margin = 0;
  std::vector<const Shape*> shapes;
  std::unique_ptr<Accel> accel;
  std::vector<bool> lies_in, meets;  ///< other volumes
  bool overlaps = false;             ///< any
  const Medium* around = nullptr;

  Volume(EnclosedVolume volume, const std::vector<std::shared_ptr<const Shape>>& whole)
      : EnclosedVolume(std::move(volume)) {
    for (const std::uint32_t i : surfaces) {
      shapes.push_back(whole[i].get());
      bounds.extend(whole[i]->bounds());
    }
    margin = kMargin * bounds.radius();
    accel = std::make_unique<Accel>(shapes);
  }

  /// How often the boundary winds around the beginning of a ray.
  int winding(const Vec3& p, const Vec3& d, PrimitiveId from = kNoPrimitive) const {
    for (int i = 0; i < 3; ++i)
      if (p[i] < bounds.lo[i] - margin || p[i] > bounds.hi[i] + margin) return 0;
    int sum = 0;
    Ray ray{p, d, 0, kInfinity};
    while (const auto hit = accel->intersect(ray, from)) {
      const Vec3 n = shapes[hit->id.shape]->surface_point(hit->id.primitive, hit->local).n_g;
      sum += dot(n, d) > 0 ? 1 : -1;
      ray.t_min = hit->t;
      from = hit->id;
    }
    return sum;
  }
};

Overlaps::Overlaps(std::vector<Surface>& surfaces, std::vector<EnclosedVolume> volumes,
                   const OverlappingPairs& pairs)
    : touch_(touch_distance(surfaces)) {
  for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
    whole_.push_back(surfaces[i].shape);
    refracting_.push_back(refracts(surfaces[i]));
    origins_.push_back(i);
  }
  shapes_ = whole_;
  parts_.resize(surfaces.size());
  for (EnclosedVolume& volume : volumes) {
    media_.push_back(volume.interior);
    media_.push_back(volume.exterior);
    volumes_.emplace_back(std::move(volume), whole_);
  }
  for (const auto& [a, b] : pairs)
    for (const std::size_t v : {a, b})
      if (!volumes_[v].obstacle.empty()) throw std::domain_error(volumes_[v].obstacle);
  rank(pairs);
  for (std::size_t v = 0; v < volumes_.size(); ++v) check_winding(v);
  std::vector<std::uint32_t> taking_part;
  for (std::size_t v = 0; v < volumes_.size(); ++v) {
    if (!volumes_[v].obstacle.empty()) continue;
    for (const std::uint32_t i : volumes_[v].surfaces) {
      parts_[i].own = v;
      const bool near = std::ranges::any_of(pairs, [&](const auto& pair) {
        const Bounds zone = common(widened(volumes_[pair.first].bounds, touch_),
                                   widened(volumes_[pair.second].bounds, touch_));
        return zone.overlaps(whole_[i]->bounds());
      });
      if (volumes_[v].overlaps || near) taking_part.push_back(i);
    }
  }
  for (const std::uint32_t i : taking_part) take_part(surfaces, i);
}

Overlaps::~Overlaps() = default;

/// What lies in another volume comes before it; then priorities decide, then the smaller size.
void Overlaps::rank(const OverlappingPairs& pairs) {
  const std::size_t count = volumes_.size();
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t a = 0; a < count; ++a)
    for (std::size_t b = 0; b < count; ++b)
      volumes_[a].lies_in.push_back(a != b &&
                                    volumes_[a].boundary->lies_within(*volumes_[b].boundary));
  for (Volume& volume : volumes_) volume.meets.assign(count, false);
  for (const auto& [a, b] : pairs) {
    volumes_[a].overlaps = volumes_[b].overlaps = true;
    volumes_[a].meets[b] = volumes_[b].meets[a] = true;
  }
  // From the largest to the smallest: of what lies around, all is known.
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return volumes_[a].boundary->volume() > volumes_[b].boundary->volume();
  });
  for (const std::size_t a : order)
    for (std::size_t b = 0; b < count; ++b)
      if (volumes_[a].lies_in[b])
        volumes_[a].priority = std::max(volumes_[a].priority, volumes_[b].priority);
  std::ranges::reverse(order);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return volumes_[a].priority > volumes_[b].priority;
  });
  rank_.resize(count);
  for (std::size_t i = 0; i < count; ++i) rank_[order[i]] = i;
  for (const auto& [a, b] : pairs) {
    // Glass that says nothing of media displaces what it overlaps: it stands in what that is in.
    if (!volumes_[a].sets_medium) volumes_[a].around = volumes_[b].exterior.get();
    if (!volumes_[b].sets_medium) volumes_[b].around = volumes_[a].exterior.get();
  }
}

/// Pieces that overlap are one volume if each of them is right way out.
void Overlaps::check_winding(std::size_t v) const {
  const Volume& volume = volumes_[v];
  if (!volume.meets_itself) return;
  for (std::size_t s = 0; s < volume.surfaces.size(); ++s)
    for (int i = 0; i < kPoints; ++i) {
      const SurfacePoint x = volume.shapes[s]->sample(spread_point(i, kPoints));
      const PrimitiveId from{static_cast<std::uint32_t>(s), x.primitive};
      if (volume.winding(x.position, way_off(x.n_g), from) < 0)
        throw std::domain_error("the boundary meets itself and is partly inside out");
    }
}

// --- Places

/// Light is in the volume of the highest rank; volumes that do not refract leave the index alone,
/// and so are there with any that does, but only one that refracts is anywhere: another gives its
/// medium only to what lies in it and says nothing of media.
Overlaps::Place Overlaps::place(const Part& part, Mask inside, bool refracting) const {
  const Volume* holds_index = nullptr;
  for (std::size_t i = 0; i < part.around.size() && !holds_index; ++i)
    if (inside >> i & 1 && volumes_[part.around[i]].n != 0) holds_index = &volumes_[part.around[i]];
  Place place = part.outside;
  if (holds_index) {
    place.n = holds_index->n;
    if (!holds_index->sets_medium && holds_index->overlaps) place.medium = holds_index->around;
  }
  if (!refracting) place.n = 1;  // nothing to be told apart by
  for (std::size_t i = 0; i < part.around.size(); ++i) {
    const Volume& v = volumes_[part.around[i]];
    if (!(inside >> i & 1) || !v.sets_medium) continue;
    if (v.n != 0 && &v != holds_index &&
        (holds_index->sets_medium || !holds_index->lies_in[part.around[i]]))
      continue;
    place.medium = v.interior.get();
    break;
  }
  return place;
}

/// All that `place` can answer: two volumes, and on the inner side the surface's own, decide.
std::vector<Overlaps::Place> Overlaps::places(const Part& part, bool interior,
                                              bool refracting) const {
  std::vector<Place> all;
  const std::size_t count = part.around.size();
  for (std::size_t a = 0; a <= count; ++a)
    for (std::size_t b = a; b <= count; ++b) {
      Mask mask = 0;
      for (const std::size_t i : {a, b})
        if (i < count) mask |= Mask{1} << i;
      for (std::size_t i = 0; i < count; ++i)
        if (part.around[i] == part.own) {
          if (interior) mask |= Mask{1} << i;
          if (!interior && !volumes_[part.own].meets_itself) mask &= ~(Mask{1} << i);
        }
      const Place answer = place(part, mask, refracting);
      if (std::ranges::find(all, answer) == all.end()) all.push_back(answer);
    }
  return all;
}

/// What is outside of all volumes. A boundary may declare the medium and the index of a larger
/// volume outside, and yet come out of it: then what is around that one counts.
Overlaps::Place Overlaps::outside(const Surface& surface, std::size_t own) const {
  Place place{surface.medium_boundary ? surface.exterior.get() : volumes_[own].around,
              surface.bsdf->n_exterior()};
  for (std::size_t v = 0; v < volumes_.size(); ++v) {
    const Volume& volume = volumes_[v];
    if (!(volumes_[own].lies_in[v] || volumes_[own].meets[v]) ||
        !(volume.boundary->volume() > volumes_[own].boundary->volume()))
      continue;
    const bool medium = volume.sets_medium && volume.interior.get() == place.medium;
    const bool index = volume.n != 0 && volume.n == place.n;
    if (!medium && !index) continue;
    if (medium) place.medium = volume.exterior.get();
    if (index) place.n = volume.n_exterior;
    own = v;
    v = static_cast<std::size_t>(-1);  // once more, for what is larger yet
  }
  return place;
}

// --- Surfaces

void Overlaps::take_part(std::vector<Surface>& surfaces, std::uint32_t surface) {
  Part& part = parts_[surface];
  for (std::size_t v = 0; v < volumes_.size(); ++v)
    if (v == part.own || (volumes_[v].obstacle.empty() &&
                          widened(volumes_[v].bounds, touch_).overlaps(whole_[surface]->bounds())))
      part.around.push_back(v);
  if (part.around.size() > kMostAround)
    throw std::domain_error("more than " + std::to_string(kMostAround) + " volumes are around " +
                            describe(surfaces[surface]));
  std::ranges::sort(part.around, {}, [&](std::size_t v) { return rank_[v]; });
  part.outside = outside(surfaces[surface], part.own);
  if (!refracting_[surface]) part.outside.n = 1;
  add_variants(surfaces, surface, part);
  const bool hides =
      !part.variants.empty() &&
      (std::ranges::any_of(part.variants, [](const Variant& v) { return v.name == kHidden; }) ||
       std::ranges::any_of(part.around,
                           [&](std::size_t v) { return volumes_[part.own].meets[v]; }));
  if (!hides) return;
  shapes_[surface] =
      make_trimmed(whole_[surface], [this, surface](std::uint32_t primitive, const Vec2& local) {
        return find(surface, whole_[surface]->surface_point(primitive, local)) != kHidden;
      });
}

void Overlaps::add_variants(std::vector<Surface>& surfaces, std::uint32_t surface, Part& part) {
  const bool refracting = refracting_[surface];
  std::vector<Variant> variants;
  for (const Place& interior : places(part, true, refracting))
    for (const Place& exterior : places(part, false, refracting))
      variants.push_back({interior, exterior, variant(surfaces, surface, interior, exterior)});
  if (std::ranges::any_of(variants, [&](const Variant& v) { return v.name != surface; }))
    part.variants = std::move(variants);
}

std::uint32_t Overlaps::variant(std::vector<Surface>& surfaces, std::uint32_t surface,
                                const Place& interior, const Place& exterior) {
  const Surface& declared = surfaces[surface];
  const bool vanishes = !declared.emitter && (is_null(*declared.bsdf) || refracting_[surface]);
  if (vanishes && interior == exterior) return kHidden;
  Surface s = declared;
  const auto owned = [&](const Medium* medium) {
    const auto place = std::ranges::find(media_, medium, [](const auto& m) { return m.get(); });
    return place == media_.end() ? nullptr : *place;
  };
  s.bsdf = bsdf_between(declared, interior, exterior);
  s.medium_boundary |= interior.medium != exterior.medium;
  if (s.medium_boundary) {
    s.interior = owned(interior.medium);
    s.exterior = owned(exterior.medium);
  }
  if (s.bsdf == declared.bsdf && s.medium_boundary == declared.medium_boundary &&
      s.interior == declared.interior && s.exterior == declared.exterior)
    return surface;
  if (surfaces.size() >= kMostSurfaces)
    throw std::domain_error("too many kinds of places lie on their boundaries");
  surfaces.push_back(std::move(s));
  origins_.push_back(surface);
  return static_cast<std::uint32_t>(surfaces.size() - 1);
}

std::shared_ptr<const Bsdf> Overlaps::bsdf_between(const Surface& surface, const Place& interior,
                                                   const Place& exterior) {
  const double n_exterior = surface.bsdf->n_exterior();
  if (!refracts(surface) ||
      (interior.n == surface.bsdf->eta() * n_exterior && exterior.n == n_exterior))
    return surface.bsdf;
  auto& bsdf = bsdfs_[{surface.bsdf.get(), interior.n, exterior.n}];
  if (!bsdf)
    bsdf = interior.n == exterior.n ? make_null() : surface.bsdf->between(interior.n, exterior.n);
  if (!bsdf)
    throw std::domain_error("the bsdf \"" + std::string(surface.bsdf->name()) + "\" of " +
                            describe(surface) + " cannot lie between other indices of refraction");
  return bsdf;
}

// --- Hits

/// The volumes on one side of a surface, close to x. That its own is on the inner side, and on the
/// outer one only where its pieces overlap, needs no ray, and holds at sharp edges, too.
Overlaps::Mask Overlaps::beside(const Part& part, const SurfacePoint& x, bool interior) const {
  const Vec3 n = interior ? -x.n_g : x.n_g, p = x.position + touch_ * n, way = way_off(n);
  Mask mask = 0;
  for (std::size_t i = 0; i < part.around.size(); ++i) {
    const Volume& volume = volumes_[part.around[i]];
    const bool own = part.around[i] == part.own;
    const bool holds =
        own && (interior || !volume.meets_itself) ? interior : volume.winding(p, way) > 0;
    if (holds) mask |= Mask{1} << i;
  }
  return mask;
}

/// Whether one of the boundaries that lie upon a place is there instead: of those that refract, or
/// of all if none does, that of the highest rank stays.
bool Overlaps::replaced(const Part& part, Mask flips) const {
  const Volume& own = volumes_[part.own];
  for (std::size_t i = 0; i < part.around.size(); ++i) {
    const std::size_t other = part.around[i];
    if (!(flips >> i & 1) || !own.meets[other] || other == part.own) continue;
    const bool refracts = volumes_[other].n != 0, own_refracts = own.n != 0;
    if (refracts != own_refracts ? refracts : rank_[other] < rank_[part.own]) return true;
  }
  return false;
}

std::uint32_t Overlaps::find(std::uint32_t surface, const SurfacePoint& x) const {
  const Part& part = parts_[surface];
  const Mask in = beside(part, x, true), out = beside(part, x, false);
  if (replaced(part, in ^ out)) return kHidden;
  const bool refracting = refracting_[surface];
  const Place interior = place(part, in, refracting), exterior = place(part, out, refracting);
  for (const Variant& v : part.variants)
    if (v.interior == interior && v.exterior == exterior) return v.name;
  FOGBOW_CHECK(false && "a place on a surface was not foreseen");
  return surface;
}

std::uint32_t Overlaps::name(const Hit& hit) const {
  const std::uint32_t surface = hit.id.shape;
  if (parts_[surface].variants.empty()) return surface;
  const std::uint32_t found =
      find(surface, whole_[surface]->surface_point(hit.id.primitive, hit.local));
  FOGBOW_CHECK(found != kHidden);
  return found;
}

std::optional<const Medium*> Overlaps::medium_at(const Vec3& p) const {
  Part part;
  part.outside = {nullptr, 1};
  Mask inside = 0;
  std::vector<std::size_t> order(volumes_.size());
  for (std::size_t v = 0; v < volumes_.size(); ++v) order[rank_[v]] = v;
  bool sets_medium = false;
  for (const std::size_t v : order) {
    if (part.around.size() == kMostAround || volumes_[v].winding(p, spread_direction(0, 1)) <= 0)
      continue;
    inside |= Mask{1} << part.around.size();
    part.around.push_back(v);
    sets_medium |= volumes_[v].sets_medium;
  }
  if (!sets_medium) return std::nullopt;
  return place(part, inside, true).medium;
}

}  // namespace fogbow
