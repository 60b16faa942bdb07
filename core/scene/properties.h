// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/image/filter.h"
#include "core/math/transform.h"
#include "core/scene/bsdf.h"
#include "core/scene/medium.h"
#include "core/scene/phase_function.h"
#include "core/scene/texture.h"
#include "core/scene/volume.h"
#include "core/util/error.h"

namespace fogbow {

/// One named value of a plugin, as read from a scene.
struct Property {
  struct Point {
    Vec3 v;
  };
  struct Vector {
    Vec3 v;
  };
  struct Color {
    RGB c;
    bool measured = false;  ///< of a spectrum: what is brighter than the range allows is cut
  };
  using Value =
      std::variant<bool, std::int64_t, double, std::string, Point, Vector, Color, Transform>;

  std::string name;
  Value value;
  SourceLocation where;
  bool used = false;

  /// The tag that writes such a value.
  const char* type_name() const {
    static constexpr const char* kNames[] = {"boolean", "integer", "float", "string",
                                             "point",   "vector",  "rgb",   "transform"};
    return kNames[value.index()];
  }
};

/// An object inside another one: written there, or referred to.
struct NestedObject {
  using Object = std::variant<std::shared_ptr<const Bsdf>, std::shared_ptr<const Medium>,
                              std::shared_ptr<const PhaseFunction>,
                              std::shared_ptr<const ReconstructionFilter>,
                              std::shared_ptr<const Texture>, std::shared_ptr<const Volume>>;
  std::string name;
  Object object;
  SourceLocation where;
  bool used = false;

  const char* type_name() const {
    static constexpr const char* kNames[] = {"bsdf",    "medium",  "phase",
                                             "rfilter", "texture", "volume"};
    return kNames[object.index()];
  }
};

/// What a scene file says of one plugin. Every value asked for is marked as used; what is left over
/// had no effect. Values of the wrong type or out of range throw Error(Scene) with their place.
class Properties {
 public:
  struct Warning {
    SourceLocation where;
    std::string message;
  };

  /// `kind` is the tag ("bsdf"), `plugin` its type ("diffuse").
  Properties(std::string kind, std::string plugin, std::string id, SourceLocation where)
      : kind_(std::move(kind)),
        plugin_(std::move(plugin)),
        id_(std::move(id)),
        where_(std::move(where)) {}

  const std::string& kind() const { return kind_; }
  const std::string& plugin() const { return plugin_; }
  const std::string& id() const { return id_; }
  const SourceLocation& where() const { return where_; }

  void add(Property property) {
    if (const Property* other = lookup(property.name))
      throw Error(
          ErrorKind::Scene, property.where,
          "\"" + property.name + "\" is given twice (first at " + to_string(other->where) + ")");
    values_.push_back(std::move(property));
  }
  void add(NestedObject object) { objects_.push_back(std::move(object)); }

  bool has(const std::string& name) const {
    remember(name);
    return lookup(name) != nullptr;
  }

  /// As a value or as a nested object.
  bool given(const std::string& name) const {
    return has(name) || std::any_of(objects_.begin(), objects_.end(),
                                    [&](const NestedObject& o) { return o.name == name; });
  }

  bool boolean(const std::string& name, bool fallback) {
    const Property* p = use(name);
    return p ? get<bool>(*p, "boolean") : fallback;
  }
  std::int64_t integer(const std::string& name, std::int64_t fallback) {
    const Property* p = use(name);
    return p ? get<std::int64_t>(*p, "integer") : fallback;
  }
  /// Integers count as numbers.
  double number(const std::string& name, double fallback) {
    const Property* p = use(name);
    if (!p) return fallback;
    if (const auto* i = std::get_if<std::int64_t>(&p->value)) return static_cast<double>(*i);
    return get<double>(*p, "float");
  }
  double positive_number(const std::string& name, double fallback) {
    const double value = number(name, fallback);
    if (!(value > 0)) fail(name, "\"" + name + "\" must be greater than zero");
    return value;
  }
  std::string string(const std::string& name, const std::string& fallback) {
    const Property* p = use(name);
    return p ? get<std::string>(*p, "string") : fallback;
  }
  std::string required_string(const std::string& name) {
    if (!has(name)) fail_missing(name, "string");
    return string(name, {});
  }
  double required_number(const std::string& name) {
    if (!has(name)) fail_missing(name, "float");
    return number(name, 0);
  }
  /// rgb, spectrum, or one number for all channels; each in [0, max].
  RGB color(const std::string& name, const RGB& fallback, double max = kInfinity) {
    const Property* p = use(name);
    if (!p) return fallback;
    RGB result;
    if (const auto* c = std::get_if<Property::Color>(&p->value))
      result = c->measured ? glm::min(c->c, RGB(max)) : c->c;
    else if (std::holds_alternative<double>(p->value) ||
             std::holds_alternative<std::int64_t>(p->value))
      result = RGB(number(name, 0));
    else
      fail_type(*p, "rgb, spectrum or float");
    for (int i = 0; i < 3; ++i)
      if (!(result[i] >= 0 && result[i] <= max))
        fail(name, "\"" + name + "\" must " +
                       (max == kInfinity ? "not be negative" : "lie between 0 and 1"));
    return result;
  }
  /// The same, or a texture.
  Textured<RGB> textured_color(const std::string& name, const RGB& fallback,
                               double max = kInfinity) {
    if (const auto texture = take_texture(name, 0, max)) return texture;
    return color(name, fallback, max);
  }
  /// A number, the mean of a colour's channels, or a texture, in [min, max].
  Textured<double> textured_number(const std::string& name, double fallback, double min = 0,
                                   double max = kInfinity) {
    if (const auto texture = take_texture(name, min, max)) return texture;
    const Property* p = use(name);
    const auto* color = p ? std::get_if<Property::Color>(&p->value) : nullptr;
    const double value = color ? mean(color->c) : number(name, fallback);
    if (!(value >= min && value <= max)) fail(name, "\"" + name + "\" " + must_lie(min, max));
    return value;
  }
  /// A point or a vector.
  Vec3 point(const std::string& name, const Vec3& fallback) {
    const Property* p = use(name);
    if (!p) return fallback;
    if (const auto* v = std::get_if<Property::Vector>(&p->value)) return v->v;
    return get<Property::Point>(*p, "point").v;
  }
  Transform transform(const std::string& name) {
    const Property* p = use(name);
    return p ? get<Transform>(*p, "transform") : Transform();
  }

  /// Lets another transform follow the one of this name.
  void append_transform(const std::string& name, const Transform& after) {
    auto* p = const_cast<Property*>(lookup(name));
    if (p)
      p->value = after * get<Transform>(*p, "transform");
    else
      add(Property{name, after, where_, false});
  }

  /// All nested objects of one class, in the order of the file.
  template <class T>
  std::vector<std::shared_ptr<const T>> take() {
    std::vector<std::shared_ptr<const T>> result;
    for (NestedObject& o : objects_)
      if (const auto* object = std::get_if<std::shared_ptr<const T>>(&o.object)) {
        o.used = true;
        result.push_back(*object);
      }
    return result;
  }
  /// The nested object of one class that bears a name; null if there is none, an error if there are
  /// two.
  template <class T>
  std::shared_ptr<const T> take(const std::string& name) {
    std::shared_ptr<const T> result;
    for (NestedObject& o : objects_)
      if (const auto* object = std::get_if<std::shared_ptr<const T>>(&o.object);
          object && o.name == name) {
        if (result)
          throw Error(ErrorKind::Scene, o.where, "a second \"" + name + "\" " + o.type_name());
        o.used = true;
        result = *object;
      }
    return result;
  }
  /// The only nested object of one class, whatever its name; null if there is none.
  template <class T>
  std::shared_ptr<const T> take_one() {
    const auto all = take<T>();
    if (all.size() > 1)
      throw Error(ErrorKind::Scene, where_,
                  kind_ + " \"" + plugin_ + "\" takes only one nested object of this kind, found " +
                      std::to_string(all.size()));
    return all.empty() ? nullptr : all.front();
  }

  /// Place of a property or nested object, or of the whole object if there is none of that name.
  const SourceLocation& where(const std::string& name) const {
    if (const Property* p = lookup(name)) return p->where;
    for (const NestedObject& o : objects_)
      if (o.name == name) return o.where;
    return where_;
  }
  [[noreturn]] void fail(const std::string& name, const std::string& message) const {
    throw Error(ErrorKind::Scene, where(name), message);
  }
  void warn(const std::string& name, const std::string& message) {
    warnings_.push_back({where(name), message});
  }

  const std::vector<Property>& values() const { return values_; }
  const std::vector<NestedObject>& objects() const { return objects_; }
  const std::vector<Warning>& warnings() const { return warnings_; }
  /// What textures need of the shape that they will lie on.
  struct AttributeNeed {
    Texture::AttributeUse use;
    double min, max;  ///< of its values times the scale
    SourceLocation where;
  };
  const std::vector<AttributeNeed>& attribute_needs() const { return attribute_needs_; }

  /// Every name asked for so far.
  const std::vector<std::string>& known_names() const { return known_names_; }

 private:
  const Property* lookup(const std::string& name) const {
    const auto it = std::find_if(values_.begin(), values_.end(),
                                 [&](const Property& p) { return p.name == name; });
    return it == values_.end() ? nullptr : &*it;
  }
  void remember(const std::string& name) const {
    if (std::find(known_names_.begin(), known_names_.end(), name) == known_names_.end())
      known_names_.push_back(name);
  }
  const Property* use(const std::string& name) {
    remember(name);
    auto* p = const_cast<Property*>(lookup(name));
    if (p) p->used = true;
    return p;
  }
  /// Null if the name is that of a value, or of nothing.
  std::shared_ptr<const Texture> take_texture(const std::string& name, double min, double max) {
    remember(name);
    auto texture = take<Texture>(name);
    if (!texture) return texture;
    if (const Property* value = lookup(name))
      throw Error(ErrorKind::Scene, value->where,
                  "\"" + name + "\" is given twice: as a value and as a texture");
    const Texture::Range range = texture->range();
    if (const auto use = texture->attribute()) {
      // Textures of textures may have to be reflectances: what holds for range() must hold for
      // them.
      attribute_needs_.push_back(
          {*use, min, kind_ == "texture" ? std::min(max, range.greatest) : max, where(name)});
      return texture;
    }
    if (!(range.least >= min && range.greatest <= max))
      fail(name, "the values of the texture \"" + name + "\" " + must_lie(min, max) +
                     "; it has some from " + std::to_string(range.least) + " to " +
                     std::to_string(range.greatest));
    return texture;
  }
  static std::string must_lie(double min, double max) {
    const auto text = [](double x) {
      std::string s = std::to_string(x);
      s.erase(s.find_last_not_of('0') + 1);
      return s.back() == '.' ? s.substr(0, s.size() - 1) : s;
    };
    if (max == kInfinity)
      return min == 0 ? "must not be negative" : "must not be less than " + text(min);
    return "must lie between " + text(min) + " and " + text(max);
  }
  template <class T>
  const T& get(const Property& p, const char* expected) const {
    if (const T* value = std::get_if<T>(&p.value)) return *value;
    fail_type(p, expected);
  }
  [[noreturn]] static void fail_type(const Property& p, const char* expected) {
    throw Error(ErrorKind::Scene, p.where,
                "\"" + p.name + "\" must be of type " + expected + ", found " + p.type_name());
  }
  [[noreturn]] void fail_missing(const std::string& name, const char* type) const {
    throw Error(ErrorKind::Scene, where_,
                kind_ + " \"" + plugin_ + "\" needs the " + type + " \"" + name + "\"");
  }

  std::string kind_, plugin_, id_;
  SourceLocation where_;
  std::vector<Property> values_;
  std::vector<NestedObject> objects_;
  std::vector<Warning> warnings_;
  std::vector<AttributeNeed> attribute_needs_;
  mutable std::vector<std::string> known_names_;
};

}  // namespace fogbow
