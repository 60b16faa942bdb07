// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/textures.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

constexpr std::uint64_t kMaxImageBytes = std::uint64_t{2} << 30;

/// One of several words.
template <class Value>
Value choice(Properties& p, const std::string& name,
             std::initializer_list<std::pair<const char*, Value>> known) {
  const std::string found = p.string(name, known.begin()->first);
  std::vector<std::string> names;
  for (const auto& [word, value] : known) {
    if (found == word) return value;
    names.emplace_back(word);
  }
  p.fail(name, "expected " + listed(names, "or") + ", found " + quote(found));
}

Image read_picture(Properties& p, const PictureContext& context) {
  const std::string name = p.required_string("filename");
  const SourceLocation where = p.where("filename");
  if (!context.read_image)
    p.fail("filename", "bitmaps cannot be read here: the program gave no reader of images");
  const auto file = context.files.resolve(name, where);
  context.hash.add(read_file(file, kMaxImageBytes, where));
  try {
    return context.read_image(file.string());
  } catch (const Error& error) {
    throw Error(error.kind(), where, error.what());
  }
}

std::shared_ptr<const Texture> bitmap(Properties& p, const PictureContext& context) {
  BitmapSettings settings;
  settings.raw = p.boolean("raw", false);
  settings.filter = choice<TextureFilter>(
      p, "filter_type",
      {{"bilinear", TextureFilter::Bilinear}, {"nearest", TextureFilter::Nearest}});
  settings.wrap = choice<TextureWrap>(p, "wrap_mode",
                                      {{"repeat", TextureWrap::Repeat},
                                       {"mirror", TextureWrap::Mirror},
                                       {"clamp", TextureWrap::Clamp}});
  settings.to_uv = p.transform("to_uv");
  // How other programs store the texels.
  p.string("format", {});
  p.boolean("accel", true);
  return make_bitmap_texture(read_picture(p, context), settings);
}

std::shared_ptr<const Texture> checkerboard(Properties& p, const PictureContext&) {
  const Textured<RGB> color0 = p.textured_color("color0", RGB(0.4));
  return make_checkerboard_texture(color0, p.textured_color("color1", RGB(0.2)),
                                   p.transform("to_uv"));
}

std::shared_ptr<const Texture> rawconstant(Properties& p, const PictureContext&) {
  for (const Property& value : p.values())
    if (value.name == "value" && (std::holds_alternative<Property::Point>(value.value) ||
                                  std::holds_alternative<Property::Vector>(value.value)))
      return make_constant_texture(p.point("value", Vec3(0)));
  if (!p.has("value"))
    throw Error(ErrorKind::Scene, p.where(), "\"rawconstant\" needs a \"value\"");
  return make_constant_texture(p.color("value", RGB(0)));
}

std::shared_ptr<const Texture> mesh_attribute(Properties& p, const PictureContext&) {
  const std::string name = p.required_string("name");
  const double scale = p.number("scale", 1);
  return make_mesh_attribute_texture(name, scale);
}

}  // namespace

const PluginTable<std::shared_ptr<const Texture>(Properties&, const PictureContext&)>&
texture_plugins() {
  static const PluginTable<std::shared_ptr<const Texture>(Properties&, const PictureContext&)>
      table{{"bitmap", bitmap},
            {"checkerboard", checkerboard},
            {"mesh_attribute", mesh_attribute},
            {"rawconstant", rawconstant}};
  return table;
}

}  // namespace fogbow
