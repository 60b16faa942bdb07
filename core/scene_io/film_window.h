// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cstdint>

#include "core/image/film.h"
#include "core/util/error.h"

namespace fogbow {

inline constexpr int kMaxFilmSide = 1 << 20;
inline constexpr std::int64_t kMaxFilmPixels = std::int64_t{1} << 28;

/// Throws on an empty or enormous film, or a crop window that is not inside it.
inline void check_film(const FilmSettings& film, const SourceLocation& where,
                       ErrorKind kind = ErrorKind::Scene) {
  if (film.width < 1 || film.height < 1) throw Error(kind, where, "the film has no pixels");
  if (std::int64_t{film.width} * film.height > kMaxFilmPixels)
    throw Error(kind, where,
                "the film has more than " + std::to_string(kMaxFilmPixels) + " pixels");
  const bool cropped =
      film.crop_x != 0 || film.crop_y != 0 || film.crop_width != 0 || film.crop_height != 0;
  if (!cropped) return;
  if (film.crop_x < 0 || film.crop_y < 0 || film.crop_width < 1 || film.crop_height < 1 ||
      std::int64_t{film.crop_x} + film.crop_width > film.width ||
      std::int64_t{film.crop_y} + film.crop_height > film.height)
    throw Error(kind, where, "the crop window does not lie inside the film");
}

}  // namespace fogbow
