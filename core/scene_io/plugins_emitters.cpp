// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/emitters.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

std::shared_ptr<Emitter> point(Properties& p) {
  if (p.has("position") && p.has("to_world"))
    p.fail("position", "give either \"position\" or \"to_world\"");
  const Vec3 position =
      p.has("to_world") ? p.transform("to_world").point(Vec3(0)) : p.point("position", Vec3(0));
  p.take<Medium>();  // the scene finds out by itself in which medium the light lies
  return make_point_emitter(position, p.color("intensity", RGB(1)));
}

std::shared_ptr<Emitter> constant(Properties& p) {
  return make_constant_emitter(p.color("radiance", RGB(1)));
}

std::shared_ptr<Emitter> area(Properties& p, std::shared_ptr<const Shape> shape) {
  p.take<Medium>();
  return make_area_emitter(std::move(shape), p.color("radiance", RGB(1)));
}

}  // namespace

const PluginTable<std::shared_ptr<Emitter>(Properties&)>& emitter_plugins() {
  static const PluginTable<std::shared_ptr<Emitter>(Properties&)> table{{"point", point},
                                                                        {"constant", constant}};
  return table;
}

const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>&
surface_emitter_plugins() {
  static const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>
      table{{"area", area}};
  return table;
}

}  // namespace fogbow
