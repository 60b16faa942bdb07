// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/scene/emitters.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{4} << 30;

std::shared_ptr<Emitter> point(Properties& p, const PictureContext&) {
  if (p.has("position") && p.has("to_world"))
    p.fail("position", "give either \"position\" or \"to_world\"");
  const Vec3 position =
      p.has("to_world") ? p.transform("to_world").point(Vec3(0)) : p.point("position", Vec3(0));
  p.take<Medium>();  // the scene finds out by itself in which medium the light lies
  return make_point_emitter(position, p.color("intensity", RGB(1)));
}

std::shared_ptr<Emitter> constant(Properties& p, const PictureContext&) {
  return make_constant_emitter(p.color("radiance", RGB(1)));
}

std::shared_ptr<Emitter> directional(Properties& p, const PictureContext&) {
  if (p.has("direction") && p.has("to_world"))
    p.fail("direction", "give either \"direction\" or \"to_world\"");
  const Vec3 z(0, 0, 1);
  const Vec3 direction =
      p.has("direction") ? p.point("direction", z) : p.transform("to_world").vector(z);
  p.take<Medium>();
  return make_directional_emitter(direction, p.color("irradiance", RGB(1)));
}

std::shared_ptr<Emitter> spot(Properties& p, const PictureContext&) {
  const Transform to_world = p.transform("to_world");
  const double cutoff = p.number("cutoff_angle", 20);
  const double beam = p.number("beam_width", 0.75 * cutoff);
  p.take<Medium>();
  return make_spot_emitter(to_world.point(Vec3(0)), to_world.vector(Vec3(0, 0, 1)),
                           p.color("intensity", RGB(1)), cutoff, beam);
}

/// The linear value of an sRGB one (IEC 61966-2-1).
float decode_srgb(float x) {
  return x <= 0.04045f ? x / 12.92f : std::pow((x + 0.055f) / 1.055f, 2.4f);
}

Image read_picture(Properties& p, const PictureContext& context) {
  const std::string name = p.required_string("filename");
  const SourceLocation& where = p.where("filename");
  if (!context.read_image) p.fail("filename", "this program reads no pictures");
  const auto file = context.files.resolve(name, where);
  context.hash.add(read_file(file, kMaxPictureBytes, where));
  Image image;
  try {
    image = context.read_image(file.string());
  } catch (const Error& error) {
    throw Error(error.kind(), where, error.what());
  }
  const auto space = image.metadata.find("oiio:ColorSpace");
  const auto* named =
      space == image.metadata.end() ? nullptr : std::get_if<std::string>(&space->second);
  if (named && *named == "sRGB")
    for (float& value : image.pixels) value = decode_srgb(value);
  return image;
}

/// Sharpened pictures may undershoot.
void clamp_negative(Properties& p, Image& image) {
  std::size_t count = 0;
  for (float& value : image.pixels)
    if (value < 0) {
      value = 0;
      ++count;
    }
  if (count > 0)
    p.warn("filename", std::to_string(count) + " negative values of the picture count as zero");
}

std::shared_ptr<Emitter> envmap(Properties& p, const PictureContext& context) {
  Image image = read_picture(p, context);
  clamp_negative(p, image);
  const double scale = p.positive_number("scale", 1);
  return make_environment_emitter(image, p.transform("to_world"), scale);
}

std::shared_ptr<Emitter> area(Properties& p, std::shared_ptr<const Shape> shape) {
  p.take<Medium>();
  return make_area_emitter(std::move(shape), p.color("radiance", RGB(1)));
}

}  // namespace

const PluginTable<std::shared_ptr<Emitter>(Properties&, const PictureContext&)>& emitter_plugins() {
  static const PluginTable<std::shared_ptr<Emitter>(Properties&, const PictureContext&)> table{
      {"point", point},
      {"constant", constant},
      {"directional", directional},
      {"spot", spot},
      {"envmap", envmap}};
  return table;
}

const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>&
surface_emitter_plugins() {
  static const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>
      table{{"area", area}};
  return table;
}

}  // namespace fogbow
