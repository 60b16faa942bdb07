// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstddef>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace fogbow {

/// Float32 pixels, row-major from the top left, channels interleaved.
struct Image {
  int width = 0, height = 0;
  /// Place of the pixels (data window origin) in the whole picture (display window).
  int x = 0, y = 0, full_width = 0, full_height = 0;
  bool integers = false;              ///< the file held whole numbers, which mean sRGB by custom
  std::vector<std::string> channels;  ///< "R", "G", "B", "Error.R", …
  std::vector<float> pixels;
  /// A vector holds a 4x4 matrix, row-major and for row vectors: the memory order of Mat4.
  using Attribute = std::variant<int, float, std::string, std::vector<float>>;
  std::map<std::string, Attribute> metadata;

  Image() = default;
  Image(int w, int h, std::vector<std::string> names)
      : width(w),
        height(h),
        full_width(w),
        full_height(h),
        channels(std::move(names)),
        pixels(static_cast<std::size_t>(w) * h * channels.size()) {}

  float& at(int column, int row, int channel) {
    return pixels[(static_cast<std::size_t>(row) * width + column) * channels.size() + channel];
  }
  float at(int column, int row, int channel) const {
    return pixels[(static_cast<std::size_t>(row) * width + column) * channels.size() + channel];
  }
  /// Index of a channel by name, −1 if absent.
  int channel(const std::string& name) const;
};

}  // namespace fogbow
