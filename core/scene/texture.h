// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "core/geometry/shape.h"
#include "core/math/vec.h"

namespace fogbow {

/// A color or a number that varies over a surface.
class Texture {
 public:
  struct Range {
    double least, greatest;
  };

  virtual ~Texture() = default;
  virtual RGB color(const SurfacePoint& x) const = 0;
  /// The same as one number: the luminance of colors, as in Mitsuba.
  virtual double number(const SurfacePoint& x) const = 0;
  /// Derivatives of number() by the texture coordinates, where there are any.
  virtual Vec2 gradient(const SurfacePoint&) const { return Vec2(0); }
  /// Between which every channel and number lies.
  virtual Range range() const = 0;
  /// Of color() over the unit square of texture coordinates, or roughly so.
  virtual RGB mean() const = 0;
  /// Columns and rows of pixels; those that have none are squares.
  virtual std::array<int, 2> resolution() const { return {1, 1}; }

  /// What the shape must bring along, by whose values color() multiplies `scale`; range() then says
  /// what they have to satisfy.
  struct AttributeUse {
    std::string name;
    double scale;
  };
  virtual std::optional<AttributeUse> attribute() const { return std::nullopt; }
};

/// What a scene gives as one value or as a texture: T is RGB or double.
template <class T>
class Textured {
 public:
  Textured(const T& value) : value_(value) {}
  Textured(double r, double g, double b) requires std::is_same_v<T, RGB> : value_(r, g, b) {}
  Textured(std::shared_ptr<const Texture> texture)
      : value_(texture_mean(*texture)), texture_(std::move(texture)) {}

  T operator()(const SurfacePoint& x) const {
    if (!texture_) [[likely]]
      return value_;
    if constexpr (std::is_same_v<T, RGB>)
      return texture_->color(x);
    else
      return texture_->number(x);
  }
  bool constant() const { return !texture_; }
  std::array<int, 2> resolution() const {
    return texture_ ? texture_->resolution() : std::array<int, 2>{1, 1};
  }
  /// The value, or the texture's mean.
  const T& mean() const { return value_; }
  Texture::Range range() const {
    if (texture_) return texture_->range();
    if constexpr (!std::is_same_v<T, RGB>)
      return {value_, value_};
    else if (!is_finite(value_))
      return {-kInfinity, kInfinity};
    else
      return {std::min(value_.x, std::min(value_.y, value_.z)), max_component(value_)};
  }

 private:
  static T texture_mean(const Texture& texture) {
    if constexpr (std::is_same_v<T, RGB>)
      return texture.mean();
    else
      return luminance(texture.mean());
  }
  T value_;
  std::shared_ptr<const Texture> texture_;
};

}  // namespace fogbow
