// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene/textures.h"

namespace fogbow {
namespace {

class ConstantTexture final : public Texture {
 public:
  explicit ConstantTexture(const RGB& value) : value_(value) {}

  RGB color(const SurfacePoint&) const override { return value_; }
  double number(const SurfacePoint&) const override {
    const bool gray = value_.x == value_.y && value_.y == value_.z;
    return gray ? value_.x : luminance(value_);
  }
  Range range() const override { return Textured<RGB>(value_).range(); }
  RGB mean() const override { return value_; }

 private:
  RGB value_;
};

}  // namespace

std::shared_ptr<const Texture> make_constant_texture(const RGB& value) {
  return std::make_shared<ConstantTexture>(value);
}

}  // namespace fogbow
