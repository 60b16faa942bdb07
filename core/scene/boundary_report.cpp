// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/boundary_report.h"

#include <algorithm>

namespace fogbow {

std::string describe(const Surface& surface) {
  const std::string place = to_string(surface.where);
  return (surface.id.empty() ? "a shape" : "shape '" + surface.id + "'") +
         (place.empty() ? "" : " (" + place + ")");
}

std::string describe(const Medium* medium) {
  if (!medium) return "vacuum";
  return medium->id().empty() ? "an unnamed medium" : "medium '" + medium->id() + "'";
}

Scene::BoundaryReport::BoundaryReport(const std::vector<Surface>& surfaces) {
  for (std::uint32_t i = 0; i < surfaces.size(); ++i) {
    const Surface& s = surfaces[i];
    if (!s.medium_boundary || s.interior == s.exterior) continue;
    auto group = std::ranges::find_if(groups_, [&](const Group& g) {
      return g.interior == s.interior.get() && g.exterior == s.exterior.get();
    });
    if (group == groups_.end())
      group = groups_.insert(group, {s.interior.get(), s.exterior.get(), {}, {}});
    group->surfaces.push_back(i);
  }
  for (Group& group : groups_) {
    std::vector<const Shape*> shapes;
    for (const std::uint32_t i : group.surfaces) shapes.push_back(surfaces[i].shape.get());
    group.boundary.emplace(shapes);
    report_defects(surfaces, group);
  }
  report_overlaps(surfaces);
}

void Scene::BoundaryReport::report_overlaps(const std::vector<Surface>& surfaces) {
  for (auto a = groups_.begin(); a != groups_.end(); ++a)
    for (auto b = a + 1; b != groups_.end(); ++b) {
      if (!a->boundary->closed() || !b->boundary->closed()) continue;
      if (!a->boundary->crosses(*b->boundary) && !b->boundary->crosses(*a->boundary)) continue;
      messages_.push_back(describe(surfaces[b->surfaces.front()]) + " bounds " +
                          describe(b->interior) + " and overlaps " + describe(a->interior) +
                          ", which " + describe(surfaces[a->surfaces.front()]) +
                          " bounds: where both are, what holds is the boundary crossed last; "
                          "nest one in the other, or keep them apart");
    }
}

void Scene::BoundaryReport::report_defects(const std::vector<Surface>& surfaces,
                                           const Group& group) {
  for (const BoundaryDefect& defect : group.boundary->defects())
    messages_.push_back(describe(surfaces[group.surfaces[defect.shape]]) +
                        " is a doubtful boundary between " + describe(group.interior) +
                        " inside and " + describe(group.exterior) + " outside: " + defect.message);
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
  return innermost->interior;
}

}  // namespace fogbow
