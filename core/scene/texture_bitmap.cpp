// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/scene/textures.h"

namespace fogbow {
namespace {

/// The inverse of the sRGB curve (IEC 61966-2-1).
double decode_srgb(double encoded) {
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

/// Texel that stands for the (whole) number i outside of [0, n) too.
int wrapped(double i, int n, TextureWrap mode) {
  const double size = n;
  if (mode == TextureWrap::Clamp) return static_cast<int>(std::min(std::max(0.0, i), size - 1));
  const double period = mode == TextureWrap::Mirror ? 2 * size : size;
  double j = i - period * std::floor(i / period);
  if (j >= size) j = period - 1 - j;
  // Coordinates so large that they are no numbers any more look up the first texel.
  return j >= 0 && j < size ? static_cast<int>(j) : 0;
}

/// Texels of one (Value = float) or three channels.
template <class Value>
class Bitmap final : public Texture {
  static constexpr bool kColor = std::is_same_v<Value, glm::vec3>;
  using Wide = std::conditional_t<kColor, RGB, double>;

 public:
  Bitmap(int width, int height, std::vector<Value> texels, const BitmapSettings& settings)
      : width_(width), height_(height), texels_(std::move(texels)), settings_(settings) {
    Wide sum(0);
    for (const Value& texel : texels_) {
      sum += Wide(texel);
      extend_range(RGB(texel));
    }
    mean_ = RGB(sum / static_cast<double>(texels_.size()));
  }

  RGB color(const SurfacePoint& x) const override { return RGB(evaluate(x.uv)); }
  double number(const SurfacePoint& x) const override { return as_number(evaluate(x.uv)); }
  Vec2 gradient(const SurfacePoint& x) const override;
  Range range() const override { return range_; }
  RGB mean() const override { return mean_; }
  std::array<int, 2> resolution() const override { return {width_, height_}; }

 private:
  /// The four texels around a point, and where it lies between them.
  struct Cell {
    Wide corner[2][2];  ///< [row][column]
    Vec2 within;
  };

  static double as_number(const Wide& value) {
    if constexpr (kColor)
      return luminance(value);
    else
      return value;
  }
  void extend_range(const RGB& c) {
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(c[i]))
        throw std::domain_error("the picture has a pixel that is not finite");
      range_.least = std::min(range_.least, c[i]);
      range_.greatest = std::max(range_.greatest, c[i]);
    }
  }
  Vec2 texel_coordinates(const Vec2& uv) const {
    const Vec3 p = settings_.to_uv.point(Vec3(uv, 0));
    return {p.x * width_, p.y * height_};
  }
  Wide texel(double column, double row) const {
    const int i = wrapped(column, width_, settings_.wrap),
              j = wrapped(row, height_, settings_.wrap);
    return Wide(texels_[static_cast<std::size_t>(j) * width_ + i]);
  }
  Cell cell(const Vec2& uv) const {
    const Vec2 at = texel_coordinates(uv) - 0.5;
    const Vec2 first(std::floor(at.x), std::floor(at.y));
    Cell c;
    for (int row = 0; row < 2; ++row)
      for (int column = 0; column < 2; ++column)
        c.corner[row][column] = texel(first.x + column, first.y + row);
    c.within = at - first;
    return c;
  }
  Wide evaluate(const Vec2& uv) const {
    if (settings_.filter == TextureFilter::Nearest) {
      const Vec2 at = texel_coordinates(uv);
      return texel(std::floor(at.x), std::floor(at.y));
    }
    const Cell c = cell(uv);
    const double u = c.within.x, v = c.within.y;
    return (1 - v) * ((1 - u) * c.corner[0][0] + u * c.corner[0][1]) +
           v * ((1 - u) * c.corner[1][0] + u * c.corner[1][1]);
  }

  int width_, height_;
  std::vector<Value> texels_;
  BitmapSettings settings_;
  Range range_{kInfinity, -kInfinity};
  RGB mean_;
};

template <class Value>
Vec2 Bitmap<Value>::gradient(const SurfacePoint& x) const {
  if (settings_.filter == TextureFilter::Nearest) return Vec2(0);
  const Cell c = cell(x.uv);
  const double u = c.within.x, v = c.within.y;
  const auto difference = [](const Wide& b, const Wide& a) { return as_number(b) - as_number(a); };
  const auto& [top, bottom] = c.corner;
  const double du = (1 - v) * difference(top[1], top[0]) + v * difference(bottom[1], bottom[0]);
  const double dv = (1 - u) * difference(bottom[0], top[0]) + u * difference(bottom[1], top[1]);
  const Vec2 d(du * width_, dv * height_);
  const Vec3 along_u = settings_.to_uv.vector({1, 0, 0}),
             along_v = settings_.to_uv.vector({0, 1, 0});
  return {dot(d, Vec2(along_u)), dot(d, Vec2(along_v))};
}

template <class Value, class Read>
std::shared_ptr<const Texture> make_bitmap(const Image& image, const BitmapSettings& settings,
                                           Read&& read) {
  std::vector<Value> texels;
  texels.reserve(static_cast<std::size_t>(image.width) * image.height);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) texels.push_back(read(column, row));
  return std::make_shared<Bitmap<Value>>(image.width, image.height, std::move(texels), settings);
}

}  // namespace

std::shared_ptr<const Texture> make_bitmap_texture(const Image& image,
                                                   const BitmapSettings& settings) {
  const int channels = static_cast<int>(image.channels.size());
  if (image.width <= 0 || image.height <= 0 || channels == 0)
    throw std::domain_error("a texture needs a picture with pixels");
  const bool encoded = image.integers && !settings.raw;
  const auto value = [&](int column, int row, int channel) {
    const double v = image.at(column, row, channel);
    return static_cast<float>(encoded ? decode_srgb(v) : v);
  };
  if (channels < 3)
    return make_bitmap<float>(image, settings,
                              [&](int column, int row) { return value(column, row, 0); });
  int rgb[3] = {image.channel("R"), image.channel("G"), image.channel("B")};
  if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0)
    for (int i = 0; i < 3; ++i) rgb[i] = i;
  return make_bitmap<glm::vec3>(image, settings, [&](int column, int row) {
    return glm::vec3(value(column, row, rgb[0]), value(column, row, rgb[1]),
                     value(column, row, rgb[2]));
  });
}

}  // namespace fogbow
