// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/plugins.h"
#include "core/scene_io/volume_grid.h"

namespace fogbow {

namespace {

constexpr std::uint64_t kMaxVolumeBytes = std::uint64_t{8} << 30;

template <class T>
T choice(Properties& p, const std::string& name, const std::map<std::string, T>& table,
         const std::string& fallback) {
  const std::string value = p.string(name, fallback);
  if (const auto it = table.find(value); it != table.end()) return it->second;
  std::vector<std::string> known;
  for (const auto& [key, unused] : table) known.push_back(key);
  p.fail(name, quote(name) + " must be one of " + listed(known) + ", found " + quote(value));
}

/// From the unit cube to the box of the file.
Transform to_bounds(const Bounds& b) {
  return Transform::translate(b.lo) * Transform::scale(b.diagonal());
}

std::shared_ptr<const Volume> grid(Properties& p, const FileContext& context) {
  const std::string name = p.required_string("filename");
  const SourceLocation& where = p.where("filename");
  VolumeSettings settings;
  settings.to_world = p.transform("to_world");
  settings.filter = choice<VolumeFilter>(
      p, "filter_type",
      {{"trilinear", VolumeFilter::Trilinear}, {"nearest", VolumeFilter::Nearest}}, "trilinear");
  settings.wrap = choice<VolumeWrap>(p, "wrap_mode",
                                     {{"clamp", VolumeWrap::Clamp},
                                      {"repeat", VolumeWrap::Repeat},
                                      {"mirror", VolumeWrap::Mirror}},
                                     "clamp");
  // What spectra and majorants are made of in Mitsuba: it changes no picture.
  p.boolean("raw", false);
  p.number("max_value", 0);
  const auto path = context.files.resolve(name, where);
  const std::string bytes = read_file(path, kMaxVolumeBytes, where);
  context.hash.add(bytes);
  VolumeFile file = parse_vol(bytes, path.string());
  if (file.unread_bytes > 0)
    p.warn("filename", quote(path.string()) + " has " + std::to_string(file.unread_bytes) +
                           " bytes behind its last voxel");
  if (p.boolean("use_grid_bbox", false)) {
    const Vec3 size = file.bounds.diagonal();
    if (!is_finite(size) || !(size.x > 0 && size.y > 0 && size.z > 0))
      p.fail("use_grid_bbox", "the bounding box of " + quote(path.string()) + " is empty");
    settings.to_world = settings.to_world * to_bounds(file.bounds);
  }
  return std::make_shared<Volume>(std::move(file.voxels), settings);
}

std::shared_ptr<const Volume> constant(Properties& p, const FileContext&) {
  const RGB value = p.color("value", RGB(1));
  return std::make_shared<Volume>(value, p.transform("to_world"));
}

}  // namespace

const PluginTable<std::shared_ptr<const Volume>(Properties&, const FileContext&)>&
volume_plugins() {
  static const PluginTable<std::shared_ptr<const Volume>(Properties&, const FileContext&)> table{
      {"gridvolume", grid}, {"grid", grid}, {"constvolume", constant}, {"const", constant}};
  return table;
}

}  // namespace fogbow
