// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include "core/scene/emitters.h"
#include "core/scene/sun_sky_model.h"
#include "core/scene_io/field_of_view.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

using Emitters = std::vector<std::shared_ptr<Emitter>>;

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
  const double cutoff = p.number("cutoff_angle", 20);
  const double beam = p.number("beam_width", 0.75 * cutoff);
  p.take<Medium>();
  return make_spot_emitter(p.transform("to_world"), p.color("intensity", RGB(1)), cutoff, beam,
                           p.textured_color("texture", RGB(1)));
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

std::shared_ptr<Emitter> projector(Properties& p, const PictureContext&) {
  const Textured<RGB> irradiance = p.textured_color("irradiance", RGB(1));
  const auto [width, height] = irradiance.resolution();
  const double fov = field_of_view(p, static_cast<double>(width) / height);
  p.take<Medium>();
  return make_projector_emitter(irradiance, p.transform("to_world"), fov,
                                p.positive_number("scale", 1));
}

SunTime sun_time(Properties& p) {
  SunTime t;
  const auto whole = [&](const char* name, int value) {
    const std::int64_t given = p.integer(name, value);
    if (given < -4000 || given > 10000)
      p.fail(name, "\"" + std::string(name) + "\" is no such number");
    return static_cast<int>(given);
  };
  t.year = whole("year", t.year);
  t.month = whole("month", t.month);
  t.day = whole("day", t.day);
  t.hour = p.number("hour", t.hour);
  t.minute = p.number("minute", t.minute);
  t.second = p.number("second", t.second);
  t.latitude = p.number("latitude", t.latitude);
  t.longitude = p.number("longitude", t.longitude);
  t.timezone = p.number("timezone", t.timezone);
  return t;
}

/// As given, or in the sky's own axes where it stands at a time and place.
Vec3 towards_sun(Properties& p, bool y_up) {
  if (!p.has("sun_direction")) {
    const Vec3 d = sun_direction(sun_time(p));
    // To the east, the zenith and the south.
    return y_up ? Vec3(-d.y, d.z, d.x) : d;
  }
  for (const char* other :
       {"year", "month", "day", "hour", "minute", "second", "latitude", "longitude", "timezone"})
    if (p.has(other)) p.fail(other, "give either \"sun_direction\" or a time and place");
  const Vec3 direction = p.point("sun_direction", Vec3(0, 0, 1));
  if (!is_finite(direction) || !(length(direction) > 0))
    p.fail("sun_direction", "\"sun_direction\" must be finite and not zero");
  return direction;
}

Emitters sun_and_sky(Properties& p, bool with_sun, bool with_sky) {
  SunSkySettings s;
  s.to_world = p.transform("to_world");
  s.turbidity = p.number("turbidity", s.turbidity);
  if (!(s.turbidity >= 1 && s.turbidity <= 10))
    p.fail("turbidity", "\"turbidity\" must lie between 1 and 10");
  s.albedo = p.color("albedo", s.albedo, 1);
  const bool y_up = p.boolean("y_up", false);  // as in Mitsuba 0.6
  const bool given = p.has("sun_direction");
  s.sun_direction = towards_sun(p, y_up);
  if (!given) s.sun_direction = s.to_world.vector(s.sun_direction);
  if (y_up) s.to_world = s.to_world * Transform::rotate(Vec3(1, 0, 0), -90);
  const auto scale = [&](const char* name, double fallback) {
    const double value = p.number(name, fallback);
    if (!(value >= 0)) p.fail(name, "\"" + std::string(name) + "\" must not be negative");
    return value;
  };
  const double both = with_sun != with_sky ? scale("scale", 1) : 1;  // of Mitsuba 0.6
  if (with_sky) s.sky_scale = scale("sky_scale", both);
  if (with_sun) {
    s.sun_scale = scale("sun_scale", both);
    s.sun_aperture_degrees = p.number("sun_aperture", s.sun_aperture_degrees) *
                             p.number("sun_radius_scale", 1);  // of Mitsuba 0.6
    if (!(s.sun_aperture_degrees > 0 && s.sun_aperture_degrees < 180))
      p.fail("sun_aperture", "\"sun_aperture\" must lie between 0 and 180 degrees");
    s.limb_darkening = p.boolean("complex_sun", false);
  }
  if (dot(normalize(s.sun_direction), normalize(s.to_world.vector(Vec3(0, 0, 1)))) < 0) {
    p.warn("", "the sun is below the horizon: neither sun nor sky shine");
    return {};
  }
  Emitters emitters;
  if (with_sky && s.sky_scale > 0) emitters.push_back(make_sky_emitter(s));
  if (with_sun && s.sun_scale > 0) emitters.push_back(make_sun_emitter(s));
  return emitters;
}

Emitters sunsky(Properties& p, const PictureContext&) { return sun_and_sky(p, true, true); }
Emitters sky(Properties& p, const PictureContext&) { return sun_and_sky(p, false, true); }
Emitters sun(Properties& p, const PictureContext&) { return sun_and_sky(p, true, false); }

std::shared_ptr<Emitter> area(Properties& p, std::shared_ptr<const Shape> shape) {
  p.take<Medium>();
  return make_area_emitter(std::move(shape), p.textured_color("radiance", RGB(1)));
}

}  // namespace

const PluginTable<Emitters(Properties&, const PictureContext&)>& emitter_plugins() {
  const auto one = [](auto* make) {
    return [make](Properties& p, const PictureContext& context) -> Emitters {
      return {make(p, context)};
    };
  };
  static const PluginTable<Emitters(Properties&, const PictureContext&)> table{
      {"point", one(point)},
      {"constant", one(constant)},
      {"directional", one(directional)},
      {"spot", one(spot)},
      {"envmap", one(envmap)},
      {"projector", one(projector)},
      {"sunsky", sunsky},
      {"sky", sky},
      {"sun", sun}};
  return table;
}

const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>&
surface_emitter_plugins() {
  static const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>
      table{{"area", area}};
  return table;
}

}  // namespace fogbow
