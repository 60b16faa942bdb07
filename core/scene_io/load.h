// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <array>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/image/image.h"
#include "core/scene/media_registry.h"
#include "core/scene/scene.h"

namespace fogbow {

/// Reads a picture as float32 without conversion of colour; throws Error.
using ImageReader = std::function<Image(const std::string& path)>;

struct LoadOptions {
  std::map<std::string, std::string> definitions;  ///< -D name=value
  std::optional<std::pair<int, int>> size;         ///< overrides the film's width and height
  std::optional<std::array<int, 4>> crop;          ///< x, y, width, height
  ImageReader read_image;                          ///< none: scenes with pictures are refused
  bool strict = false;                             ///< warnings become errors
  bool sandbox_paths = false;                      ///< files must lie inside the scene's folder
  bool repair =
      false;  ///< meshes that bound media or refract are made closed where they nearly are
  /// Is told of each repair, which goes through log() as well.
  std::function<void(const std::string&)> on_repair;
};

/// Reads a Mitsuba scene; throws Error(Scene or InputOutput) with file:line:column. Every property
/// that has no effect is warned of through log() and in `warnings`.
SceneDescription load_mitsuba_xml(const std::string& path, const MediaRegistry& media,
                                  const LoadOptions& options, std::vector<std::string>& warnings);

}  // namespace fogbow
