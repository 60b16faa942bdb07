// SPDX-License-Identifier: GPL-3.0-or-later
#include <filesystem>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/plugins.h"
#include "core/scene_io/volume_grid.h"
#include "core/scene_io/volume_vdb.h"

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
  p.fail(name, quote(name) + " must be one of " + listed(known, "or") + ", found " + quote(value));
}

/// From the unit cube to the box of the file.
Transform to_bounds(const Bounds& b) {
  return Transform::translate(b.lo) * Transform::scale(b.diagonal());
}

using GridParser = VdbGrid(std::string_view, const std::string&, const std::string&, std::uint64_t);

/// Of a sparse format, by the extension; null for Mitsuba's own.
GridParser* sparse_parser(const std::string& file) {
  const std::filesystem::path extension = std::filesystem::path(file).extension();
  return extension == ".vdb" ? parse_vdb : extension == ".nvdb" ? parse_nanovdb : nullptr;
}

VolumeSettings grid_settings(Properties& p) {
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
  return settings;
}

/// What the parser throws gets its place in the scene.
VdbGrid read_sparse(Properties& p, GridParser* parse, const std::string& bytes,
                    const std::string& path) {
  const std::string wanted = p.string("grid", {});
  if (p.has("grid") && wanted.empty()) p.fail("grid", "\"grid\" must not be empty");
  try {
    return parse(bytes, path, wanted, kMaxVdbValues);
  } catch (const GridChoiceError& error) {
    throw Error(error.kind(), p.where(p.has("grid") ? "grid" : "filename"), error.what());
  } catch (const Error& error) {
    throw Error(error.kind(), p.where("filename"), error.what());
  }
}

/// A grid of OpenVDB or NanoVDB: its samples lie at whole indices, its map says where these are.
std::shared_ptr<const Volume> sparse_grid(Properties& p, GridParser* parse, std::string bytes,
                                          const std::string& path) {
  VolumeSettings settings = grid_settings(p);
  if (settings.wrap != VolumeWrap::Clamp)
    p.fail("wrap_mode",
           "a VDB grid is empty beyond its voxels and is never repeated: \"wrap_mode\" "
           "must be \"clamp\"");
  VdbGrid grid = read_sparse(p, parse, bytes, path);
  bytes = {};
  const Vec3 first(grid.first[0], grid.first[1], grid.first[2]);
  const std::array<int, 3>& n = grid.voxels.size;
  const Vec3 size(n[0], n[1], n[2]);
  if (p.boolean("use_grid_bbox", true))
    settings.to_world = settings.to_world * grid.index_to_world;
  else
    settings.to_world =
        settings.to_world * to_bounds({first - 0.5, first - 0.5 + size - 2.0}).inverse();
  // The cube of the volume holds the layer around the active voxels as well.
  settings.to_world = settings.to_world * to_bounds({first - 1.5, first - 1.5 + size});
  return std::make_shared<Volume>(std::move(grid.voxels), settings);
}

/// Mitsuba's format.
std::shared_ptr<const Volume> dense_grid(Properties& p, std::string bytes,
                                         const std::string& path) {
  VolumeSettings settings = grid_settings(p);
  VolumeFile file = parse_vol(bytes, path);
  bytes = {};
  if (file.unread_bytes > 0)
    p.warn("filename", quote(path) + " has " + std::to_string(file.unread_bytes) +
                           " bytes behind its last voxel");
  if (p.boolean("use_grid_bbox", false)) {
    const Vec3 size = file.bounds.diagonal();
    if (!is_finite(size) || !(size.x > 0 && size.y > 0 && size.z > 0))
      p.fail("use_grid_bbox", "the bounding box of " + quote(path) + " is empty");
    settings.to_world = settings.to_world * to_bounds(file.bounds);
  }
  return std::make_shared<Volume>(std::move(file.voxels), settings);
}

std::shared_ptr<const Volume> grid(Properties& p, const FileContext& context) {
  const std::string name = p.required_string("filename");
  const SourceLocation& where = p.where("filename");
  const auto path = context.files.resolve(name, where);
  std::string bytes = read_file(path, kMaxVolumeBytes, where);
  context.hash.add(bytes);
  if (GridParser* parse = sparse_parser(name))
    return sparse_grid(p, parse, std::move(bytes), path.string());
  return dense_grid(p, std::move(bytes), path.string());
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
