// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/image/image.h"
#include "core/math/transform.h"
#include "core/scene/texture.h"

namespace fogbow {

enum class TextureFilter { Bilinear, Nearest };
enum class TextureWrap { Repeat, Mirror, Clamp };

struct BitmapSettings {
  TextureFilter filter = TextureFilter::Bilinear;
  TextureWrap wrap = TextureWrap::Repeat;
  /// Values as they are in the file; else those of integer formats are taken for sRGB and made
  /// linear.
  bool raw = false;
  Transform to_uv;  ///< of texture coordinates, before they are looked up
};

/// Row 0 at v = 0, texels centred at half-integers; color from the first three channels (or R, G
/// and B by name), or from the first alone. Throws std::domain_error on pixels that are not finite,
/// or none.
std::shared_ptr<const Texture> make_bitmap_texture(const Image& image,
                                                   const BitmapSettings& settings = {});
/// Squares of half a unit, `color0` at the origin; as a number the two are exchanged, as in
/// Mitsuba 3.9.1.
std::shared_ptr<const Texture> make_checkerboard_texture(const Textured<RGB>& color0,
                                                         const Textured<RGB>& color1,
                                                         const Transform& to_uv = {});

/// The same everywhere.
std::shared_ptr<const Texture> make_constant_texture(const RGB& value);
/// A value of each vertex or face of a mesh by its name, "vertex_…" or "face_…", times `scale`.
/// Shapes that have none of that name must not be asked.
std::shared_ptr<const Texture> make_mesh_attribute_texture(const std::string& name,
                                                           double scale = 1);

}  // namespace fogbow
