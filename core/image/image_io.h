// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "core/image/image.h"

namespace fogbow {

/// Any format OpenImageIO reads, as float32, without conversion of colour (8-bit formats in [0,1]);
/// throws Error(InputOutput).
Image read_image(const std::string& path);
/// Float32 OpenEXR with metadata and windows, written to a temporary name, fsynced and renamed;
/// throws Error(InputOutput).
void write_exr(const std::string& path, const Image& image);
/// 8-bit sRGB of R, G, B after exposure (in stops), tone-mapped only by clipping, a pixel that is
/// not finite in magenta; atomic as write_exr.
void write_png(const std::string& path, const Image& image, double exposure = 0);

}  // namespace fogbow
