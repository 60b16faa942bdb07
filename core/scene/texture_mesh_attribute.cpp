// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "core/scene/textures.h"

namespace fogbow {
namespace {

/// A value that meshes bring along, found by its name.
class MeshAttributeTexture final : public Texture {
 public:
  MeshAttributeTexture(const std::string& name, double scale) : name_(name), scale_(scale) {}

  RGB color(const SurfacePoint& x) const override {
    return scale_ * x.shape->attribute(x, *x.shape->find_attribute(name_));
  }
  double number(const SurfacePoint& x) const override { return luminance(color(x)); }
  Range range() const override { return {0, 1}; }
  RGB mean() const override { return RGB(0.5); }
  std::optional<AttributeUse> attribute() const override { return AttributeUse{name_, scale_}; }

 private:
  std::string name_;
  double scale_;
};

}  // namespace

std::shared_ptr<const Texture> make_mesh_attribute_texture(const std::string& name, double scale) {
  if (!name.starts_with("vertex_") && !name.starts_with("face_"))
    throw std::domain_error(
        "the name of a mesh attribute must begin with \"vertex_\" or \"face_\"");
  if (!(scale >= 0) || !std::isfinite(scale))
    throw std::domain_error("the scale of a mesh attribute must be finite and not negative");
  return std::make_shared<MeshAttributeTexture>(name, scale);
}

}  // namespace fogbow
