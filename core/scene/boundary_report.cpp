// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/boundary_report.h"

#include <algorithm>
#include <set>
#include <stdexcept>

#include "core/math/spread.h"
#include "core/scene/contact.h"
#include "core/scene/covered_border.h"

namespace fogbow {

namespace {

constexpr int kPointsOfGlass = 256;

/// What is wrong with a boundary besides its pieces' overlapping.
bool is_flawed(const BoundaryGroup& boundary) {
  return std::ranges::any_of(boundary.defects(), [](const BoundaryDefect& defect) {
    return defect.kind != BoundaryDefect::Kind::SelfIntersecting;
  });
}

bool cross(const EnclosedVolume& a, const EnclosedVolume& b) {
  return a.boundary->crosses(*b.boundary) || b.boundary->crosses(*a.boundary);
}

bool touch(const EnclosedVolume& a, const EnclosedVolume& b, double distance) {
  return a.boundary->touches(*b.boundary, distance) || b.boundary->touches(*a.boundary, distance);
}

}  // namespace

std::string describe(const Surface& surface) {
  const std::string place = to_string(surface.where);
  return (surface.id.empty() ? "a shape" : "shape '" + surface.id + "'") +
         (place.empty() ? "" : " (" + place + ")");
}

std::string describe(const Medium* medium) {
  if (!medium) return "vacuum";
  return medium->id().empty() ? "an unnamed medium" : "medium '" + medium->id() + "'";
}

Scene::BoundaryReport::BoundaryReport(std::vector<Surface>& surfaces)
    : surfaces_(surfaces), touch_(touch_distance(surfaces)) {
  group_surfaces();
  list_volumes();
  list_pairs();
  add_glass();
  if (!pairs_.empty()) resolve();
}

void Scene::BoundaryReport::group_surfaces() {
  for (std::uint32_t i = 0; i < surfaces_.size(); ++i) {
    const Surface& s = surfaces_[i];
    if (!s.medium_boundary || s.interior == s.exterior) continue;
    auto group = std::ranges::find_if(groups_, [&](const Group& g) {
      return g.interior == s.interior && g.exterior == s.exterior && g.priority == s.priority;
    });
    if (group == groups_.end())
      group = groups_.insert(group, {s.interior, s.exterior, s.priority, {}, {}});
    group->surfaces.push_back(i);
  }
  for (Group& group : groups_) group.boundary = join(group.surfaces);
}

std::shared_ptr<const BoundaryGroup> Scene::BoundaryReport::join(
    const std::vector<std::uint32_t>& members) const {
  std::vector<const Shape*> shapes;
  for (const std::uint32_t i : members) shapes.push_back(surfaces_[i].shape.get());
  return std::make_shared<const BoundaryGroup>(shapes);
}

// --- Volumes and where they overlap

void Scene::BoundaryReport::list_volumes() {
  for (const Group& group : groups_)
    if (group.boundary->closed())
      for (EnclosedVolume& volume : volumes_of(group)) volumes_.push_back(std::move(volume));
}

/// Pieces of one index each, where the group has several.
std::vector<EnclosedVolume> Scene::BoundaryReport::volumes_of(const Group& group) const {
  std::map<double, std::vector<std::uint32_t>> pieces;
  for (const std::uint32_t i : group.surfaces) {
    const Bsdf& bsdf = *surfaces_[i].bsdf;
    pieces[refracts(surfaces_[i]) ? bsdf.eta() * bsdf.n_exterior() : 0].push_back(i);
  }
  EnclosedVolume whole = volume_of(group, group.surfaces);
  whole.boundary = group.boundary;
  if (pieces.size() == 1) return {whole};
  std::vector<EnclosedVolume> parts;
  for (auto& [n, members] : pieces) {
    parts.push_back(volume_of(group, members));
    parts.back().boundary = join(members);
  }
  if (std::ranges::all_of(parts, [](const auto& part) { return part.boundary->closed(); }))
    return parts;
  // An index and walls that close its volume.
  if (pieces.size() == 2 && pieces.begin()->first == 0) return {whole};
  whole.obstacle = "its boundary has more than one index of refraction";
  return {whole};
}

EnclosedVolume Scene::BoundaryReport::volume_of(const Group& group,
                                                std::vector<std::uint32_t> members) const {
  EnclosedVolume volume;
  volume.surfaces = std::move(members);
  volume.interior = group.interior;
  volume.exterior = group.exterior;
  volume.sets_medium = true;
  volume.priority = group.priority;
  for (const std::uint32_t i : volume.surfaces) {
    if (!refracts(surfaces_[i])) continue;
    volume.n_exterior = surfaces_[i].bsdf->n_exterior();
    volume.n = surfaces_[i].bsdf->eta() * volume.n_exterior;
  }
  if (is_flawed(*group.boundary)) volume.obstacle = "a boundary is flawed, as is said of it";
  return volume;
}

/// Whether two volumes run through each other, or share a face, and not both can be as they are.
bool Scene::BoundaryReport::dispute(const EnclosedVolume& a, const EnclosedVolume& b) const {
  return a.disputes(b) && (cross(a, b) || touch(a, b, touch_));
}

void Scene::BoundaryReport::list_pairs() {
  for (std::size_t a = 0; a < volumes_.size(); ++a) {
    EnclosedVolume& v = volumes_[a];
    v.meets_itself = !is_flawed(*v.boundary) && !v.boundary->defects().empty();
    if (v.meets_itself) pairs_.emplace_back(a, a);
    for (std::size_t b = 0; b < a; ++b)
      if (dispute(v, volumes_[b])) pairs_.emplace_back(b, a);
  }
}

/// Whether glass that says nothing of media runs through the boundary of another volume or lies
/// upon it, or has, as other such glass around it, a priority.
bool Scene::BoundaryReport::may_dispute(const Surface& glass) const {
  const Bounds bounds = glass.shape->bounds();
  for (const EnclosedVolume& v : volumes_) {
    if (v.n == 0 || !v.sets_medium) continue;
    std::array<int, 3> points{};  // by how many of their sides are inside
    for (int i = 0; i < kPointsOfGlass; ++i) {
      const SurfacePoint x = glass.shape->sample(spread_point(i, kPointsOfGlass));
      ++points[v.boundary->contains(x.position + touch_ * x.n_g) +
               v.boundary->contains(x.position - touch_ * x.n_g)];
    }
    if (points[1] > 0 || (points[0] > 0 && points[2] > 0)) return true;
  }
  return std::ranges::any_of(surfaces_, [&](const Surface& s) {
    return &s != &glass && refracts(s) && !s.medium_boundary &&
           s.shape->bounds().overlaps(bounds) && (s.priority != 0 || glass.priority != 0);
  });
}

/// Glass that says nothing of media. What is no closed shape of its own is joined with what is made
/// of the same.
void Scene::BoundaryReport::add_glass() {
  std::map<std::tuple<double, double, int>, std::vector<std::uint32_t>> open;
  std::set<std::tuple<double, double, int>> wanted;
  std::vector<std::pair<std::vector<std::uint32_t>, std::shared_ptr<const BoundaryGroup>>> glasses;
  for (std::uint32_t i = 0; i < surfaces_.size(); ++i) {
    const Surface& s = surfaces_[i];
    if (!refracts(s) || s.medium_boundary) continue;
    const bool matters = is_in_overlap(s) || may_dispute(s);
    const std::tuple key{s.bsdf->eta(), s.bsdf->n_exterior(), s.priority};
    if (s.shape->primitive_kind() == PrimitiveKind::Analytic || matters) {
      const auto alone = join({i});
      if (alone->closed() && !is_flawed(*alone)) {
        if (matters) glasses.push_back({{i}, alone});
        continue;
      }
    }
    open[key].push_back(i);
    if (matters) wanted.insert(key);
  }
  for (const auto& key : wanted) glasses.push_back({open[key], join(open[key])});
  for (const auto& [members, boundary] : glasses) add_glass_volume(members, boundary);
}

void Scene::BoundaryReport::add_glass_volume(const std::vector<std::uint32_t>& members,
                                             const std::shared_ptr<const BoundaryGroup>& boundary) {
  if (!boundary->closed()) {
    if (std::ranges::any_of(members, [&](std::uint32_t i) { return may_dispute(surfaces_[i]); }))
      open_glass_.push_back(members.front());
    return;
  }
  EnclosedVolume volume =
      volume_of({nullptr, nullptr, surfaces_[members.front()].priority, {}, boundary}, members);
  volume.boundary = boundary;
  volume.sets_medium = false;
  for (std::size_t b = 0; b < volumes_.size(); ++b)
    if (dispute(volume, volumes_[b])) pairs_.emplace_back(b, volumes_.size());
  volumes_.push_back(std::move(volume));
}

/// Glass wholly within an overlap needs to know what is around it.
bool Scene::BoundaryReport::is_in_overlap(const Surface& surface) const {
  return std::ranges::any_of(pairs_, [&](const auto& pair) {
    return std::ranges::any_of(volumes_[pair.first].surfaces, [&](std::uint32_t other) {
      return surfaces_[other].shape->bounds().overlaps(surface.shape->bounds());
    });
  });
}

std::string Scene::BoundaryReport::overlap_text(std::size_t a, std::size_t b) const {
  const auto held = [&](const EnclosedVolume& v) {
    return describe(surfaces_[v.surfaces.front()]) + ", which holds " +
           (v.sets_medium ? describe(v.interior.get()) : "an index of refraction");
  };
  if (a == b) return "pieces of " + held(volumes_[a]) + ", overlap";
  const bool crossing = cross(volumes_[a], volumes_[b]);
  return held(volumes_[b]) + (crossing ? ", overlaps " : ", touches ") + held(volumes_[a]);
}

void Scene::BoundaryReport::resolve() {
  const std::size_t declared = surfaces_.size();
  try {
    auto overlaps = std::make_unique<const Overlaps>(surfaces_, volumes_, pairs_);
    for (const auto& [a, b] : pairs_) {
      if (a != b && !cross(volumes_[a], volumes_[b])) continue;  // nothing has to give way
      const auto& [high, low] = overlaps->outranks(a, b) ? std::pair(a, b) : std::pair(b, a);
      notes_.push_back(
          overlap_text(a, b) +
          (a == b ? ": they are taken as one"
                  : ": where both are, that of " +
                        describe(surfaces_[volumes_[high].surfaces.front()]) + " holds, whose " +
                        (volumes_[high].priority > volumes_[low].priority ? "priority is greater"
                                                                          : "volume is smaller")));
    }
    overlaps_ = std::move(overlaps);
  } catch (const std::domain_error& error) {
    surfaces_.resize(declared);
    obstacle_ = error.what();
  }
}

// --- What is wrong

std::vector<std::string> Scene::BoundaryReport::warnings(const Accel& accel) const {
  std::vector<std::string> messages;
  warn_of_defects(accel, messages);
  if (!obstacle_.empty())
    for (const auto& [a, b] : pairs_)
      messages.push_back(overlap_text(a, b) + ", but " + obstacle_ +
                         ": where both are, what holds is the boundary crossed last; mend that, "
                         "nest one in the other, or keep them apart");
  warn_of_open_overlaps(messages);
  return messages;
}

void Scene::BoundaryReport::warn_of_open_overlaps(std::vector<std::string>& messages) const {
  for (const std::uint32_t glass : open_glass_)
    messages.push_back(describe(surfaces_[glass]) +
                       " refracts, and overlaps what refracts otherwise, but its boundary is "
                       "open: only closed boundaries may overlap");
  for (const Group& group : groups_) {
    if (group.boundary->closed()) continue;
    for (const EnclosedVolume& v : volumes_)
      if (v.sets_medium && group.boundary->crosses(*v.boundary))
        messages.push_back(describe(surfaces_[group.surfaces.front()]) +
                           ", whose boundary is open, runs through " + describe(v.interior.get()) +
                           ", which " + describe(surfaces_[v.surfaces.front()]) +
                           " bounds: only closed boundaries may overlap");
  }
}

void Scene::BoundaryReport::warn_of_defects(const Accel& accel,
                                            std::vector<std::string>& messages) const {
  for (const Group& group : groups_) {
    std::map<std::size_t, std::size_t> open;  // by shape
    for (const BorderEdge& border : group.boundary->borders())
      if (!is_covered(border, surfaces_, accel)) ++open[border.shape];
    for (const BoundaryDefect& defect : group.boundary->defects()) {
      std::string text = defect.message;
      if (defect.kind == BoundaryDefect::Kind::SelfIntersecting && obstacle_.empty() &&
          group.boundary->closed() && !is_flawed(*group.boundary))
        continue;
      if (defect.kind == BoundaryDefect::Kind::Open) {
        if (!open.contains(defect.shape)) continue;
        const std::size_t count = open[defect.shape];
        text = std::to_string(count) + (count == 1 ? " border edge" : " border edges");
      }
      messages.push_back(describe(surfaces_[group.surfaces[defect.shape]]) +
                         " is a doubtful boundary between " + describe(group.interior.get()) +
                         " inside and " + describe(group.exterior.get()) + " outside: " + text);
    }
  }
}

bool Scene::BoundaryReport::closed(std::uint32_t surface) const {
  return std::ranges::any_of(groups_, [surface](const Group& g) {
    return g.boundary->closed() && std::ranges::find(g.surfaces, surface) != g.surfaces.end();
  });
}

std::optional<const Medium*> Scene::BoundaryReport::medium_around(const Vec3& p) const {
  const Group* innermost = nullptr;
  for (const Group& group : groups_)
    if (group.boundary->closed() && group.boundary->contains(p) &&
        (!innermost || group.boundary->volume() < innermost->boundary->volume()))
      innermost = &group;
  if (!innermost) return std::nullopt;
  return innermost->interior.get();
}

}  // namespace fogbow
