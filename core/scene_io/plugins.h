// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/geometry/shape.h"
#include "core/image/film.h"
#include "core/scene/emitter.h"
#include "core/scene/properties.h"
#include "core/scene/sensor.h"
#include "core/scene/volume.h"
#include "core/scene_io/content_hash.h"
#include "core/scene_io/files.h"
#include "core/scene_io/load.h"

namespace fogbow {

// One table a kind, from the name of a plugin to its constructor; defaults are those of
// Mitsuba 3.9.1. A new plugin is one line there.

template <class Constructor>
using PluginTable = std::map<std::string, std::function<Constructor>>;

/// What objects made from files need besides their properties; the files' bytes go into the hash.
struct FileContext {
  const FileResolver& files;
  ContentHash& hash;
  bool repair = false;  ///< meshes, whether or not they ask for it
  /// By the instance that shows the shape, not by the shape's own "to_world": outside stays
  /// outside.
  bool mirrored = false;
  /// Is told what was done.
  std::function<void(const std::string&)> repaired = {};
};

/// What emitters and textures need: files, whose bytes go into the hash, and a reader of pictures.
struct PictureContext {
  const FileResolver& files;
  ContentHash& hash;
  const ImageReader& read_image;
};

const PluginTable<std::shared_ptr<const Shape>(Properties&, const FileContext&)>& shape_plugins();
const PluginTable<std::shared_ptr<const Bsdf>(Properties&)>& bsdf_plugins();
const PluginTable<std::shared_ptr<const Texture>(Properties&, const PictureContext&)>&
texture_plugins();
/// Emitters that stand alone, one plugin possibly several; "area" needs a shape.
const PluginTable<std::vector<std::shared_ptr<Emitter>>(Properties&, const PictureContext&)>&
emitter_plugins();
const PluginTable<std::shared_ptr<Emitter>(Properties&, std::shared_ptr<const Shape>)>&
surface_emitter_plugins();
const PluginTable<std::shared_ptr<const Sensor>(Properties&, const FilmSettings&)>&
sensor_plugins();
const PluginTable<std::shared_ptr<const Volume>(Properties&, const FileContext&)>& volume_plugins();
const PluginTable<FilmSettings(Properties&)>& film_plugins();
const PluginTable<std::shared_ptr<const ReconstructionFilter>(Properties&)>& filter_plugins();

}  // namespace fogbow
