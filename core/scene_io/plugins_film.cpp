// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/filter.h"
#include "core/scene_io/film_window.h"
#include "core/scene_io/plugins.h"

namespace fogbow {

namespace {

using Filter = std::shared_ptr<const ReconstructionFilter>;

Filter box(Properties&) { return make_box_filter(); }
Filter tent(Properties& p) { return make_tent_filter(p.positive_number("radius", 1)); }
Filter gaussian(Properties& p) { return make_gaussian_filter(p.positive_number("stddev", 0.5)); }

int pixels(Properties& p, const std::string& name, int fallback) {
  const std::int64_t value = p.integer(name, fallback);
  if (value < 0 || value > kMaxFilmSide)
    p.fail(name, "\"" + name + "\" must lie between 0 and " + std::to_string(kMaxFilmSide));
  return static_cast<int>(value);
}

FilmSettings hdrfilm(Properties& p) {
  FilmSettings film;
  film.width = pixels(p, "width", film.width);
  film.height = pixels(p, "height", film.height);
  const bool crop = p.has("crop_offset_x") || p.has("crop_offset_y") || p.has("crop_width") ||
                    p.has("crop_height");
  if (crop) {
    film.crop_x = pixels(p, "crop_offset_x", 0);
    film.crop_y = pixels(p, "crop_offset_y", 0);
    film.crop_width = pixels(p, "crop_width", film.width);
    film.crop_height = pixels(p, "crop_height", film.height);
    if (film.crop_width == 0 || film.crop_height == 0)
      throw Error(ErrorKind::Scene, p.where(), "the crop window is empty");
  }
  check_film(film, p.where());
  film.filter = p.take_one<ReconstructionFilter>();
  if (!film.filter) film.filter = make_gaussian_filter();
  // The output is float32 OpenEXR whatever these ask for.
  for (const char* format : {"file_format", "pixel_format", "component_format"})
    p.string(format, {});
  return film;
}

}  // namespace

const PluginTable<FilmSettings(Properties&)>& film_plugins() {
  static const PluginTable<FilmSettings(Properties&)> table{{"hdrfilm", hdrfilm}};
  return table;
}

const PluginTable<Filter(Properties&)>& filter_plugins() {
  static const PluginTable<Filter(Properties&)> table{
      {"box", box}, {"tent", tent}, {"gaussian", gaussian}};
  return table;
}

}  // namespace fogbow
