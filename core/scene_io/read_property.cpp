// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/read_property.h"

#include <algorithm>
#include <optional>

#include "core/math/frame.h"
#include "core/scene_io/parse_values.h"
#include "core/scene_io/spectrum.h"

namespace fogbow {

namespace {

void check_attributes(const XmlNode& node, std::initializer_list<const char*> known,
                      Diagnostics& diagnostics) {
  for (const XmlAttribute& a : node.attributes)
    if (std::find(known.begin(), known.end(), a.name) == known.end())
      diagnostics.warn(node.where(a.name), "attribute " + quote(a.name) + " of <" + node.tag +
                                               "> has no effect" +
                                               suggestion(a.name, {known.begin(), known.end()}));
}

/// Either value="x, y, z" (or one number for all) or x= y= z=, where `missing` stands for those
/// left out; without it all three must be there.
Vec3 read_triple(const XmlNode& node, std::optional<double> missing) {
  static const std::string kAxes[] = {"x", "y", "z"};
  if (const std::string* value = node.attribute("value")) {
    for (const std::string& axis : kAxes)
      if (node.attribute(axis))
        throw Error(ErrorKind::Scene, node.where(axis),
                    "give either \"value\", or \"x\", \"y\" and \"z\"");
    return parse_triple(*value, node.where("value"));
  }
  Vec3 result(missing.value_or(0));
  for (int i = 0; i < 3; ++i)
    if (node.attribute(kAxes[i]) || !missing)
      result[i] = parse_number(node.required(kAxes[i]), node.where(kAxes[i]));
  return result;
}

Transform read_matrix(const XmlNode& node) {
  const std::vector<double> v = parse_numbers(node.required("value"), node.where("value"));
  if (v.size() != 9 && v.size() != 16)
    throw Error(ErrorKind::Scene, node.where("value"),
                "expected the 9 or 16 numbers of a matrix, found " + std::to_string(v.size()));
  const std::size_t n = v.size() == 9 ? 3 : 4;
  Mat4 m(1.0);
  for (std::size_t r = 0; r < n; ++r)
    for (std::size_t c = 0; c < n; ++c) m[static_cast<int>(c)][static_cast<int>(r)] = v[r * n + c];
  return Transform(m);
}

Transform read_lookat(const XmlNode& node) {
  const auto triple = [&](const char* name) {
    return parse_triple(node.required(name), node.where(name));
  };
  const Vec3 origin = triple("origin"), target = triple("target");
  if (node.attribute("up")) return Transform::look_at(origin, target, triple("up"));
  const Vec3 view = target - origin;
  return Transform::look_at(origin, target,
                            length(view) > 0 ? Frame(normalize(view)).s : Vec3(0, 1, 0));
}

Transform read_rotate(const XmlNode& node) {
  const double angle = parse_number(node.required("angle"), node.where("angle"));
  return Transform::rotate(read_triple(node, 0), angle);
}

Transform read_step(const XmlNode& node, Diagnostics& diagnostics) {
  const std::string& tag = node.tag;
  if (tag == "translate" || tag == "scale") {
    check_attributes(node, {"value", "x", "y", "z"}, diagnostics);
    return tag == "scale" ? Transform::scale(read_triple(node, 1))
                          : Transform::translate(read_triple(node, 0));
  }
  if (tag == "rotate") {
    check_attributes(node, {"value", "x", "y", "z", "angle"}, diagnostics);
    return read_rotate(node);
  }
  if (tag == "matrix") {
    check_attributes(node, {"value"}, diagnostics);
    return read_matrix(node);
  }
  if (tag == "lookat") {
    check_attributes(node, {"origin", "target", "up"}, diagnostics);
    return read_lookat(node);
  }
  const std::vector<std::string> known{"translate", "rotate", "scale", "matrix", "lookat"};
  throw Error(ErrorKind::Scene, node.where(),
              "expected a step of a transform (" + listed(known, "or") + "), found <" + tag + ">" +
                  suggestion(tag, known));
}

void reject_children(const XmlNode& node) {
  if (!node.children.empty())
    throw Error(ErrorKind::Scene, node.children.front().where(),
                "<" + node.tag + "> holds no elements");
}

/// Steps apply from top to bottom.
Transform read_transform(const XmlNode& node, Diagnostics& diagnostics) {
  Transform result;
  for (const XmlNode& step : node.children) {
    reject_children(step);
    try {
      result = Transform(read_step(step, diagnostics).matrix() * result.matrix());
    } catch (const std::domain_error& error) {
      throw Error(ErrorKind::Scene, step.where(), error.what());
    }
  }
  return result;
}

constexpr std::uint64_t kMaxSpectrumBytes = 16 << 20;

/// Colours beyond the screen's have negative parts.
Property::Color measured(const XmlNode& node, const RGB& color, const ValueContext& context) {
  if (std::min({color.x, color.y, color.z}) < -1e-4 * max_component(color))
    context.diagnostics.warn(node.where(), "the spectrum is no colour of sRGB: cut to the nearest");
  return {glm::max(color, RGB(0)), true};
}

Property::Color read_spectrum(const XmlNode& node, const ValueContext& context) {
  if (const std::string* name = node.attribute("filename")) {
    const SourceLocation where = node.where("filename");
    const auto file = context.files.resolve(*name, where);
    const std::string text = read_file(file, kMaxSpectrumBytes, where);
    return measured(node, spectrum_to_rgb(parse_spd(text, file.string()), context.emission),
                    context);
  }
  const std::string& text = node.required("value");
  const SourceLocation where = node.where("value");
  if (text.find(':') != std::string::npos)
    return measured(node, spectrum_to_rgb(parse_spectrum(text, where), context.emission), context);
  const double value = parse_number(text, where);
  return {context.emission ? equal_energy_to_rgb(value) : RGB(value)};
}

Property::Color read_blackbody(const XmlNode& node, const ValueContext& context) {
  std::string text = node.required("temperature");
  const SourceLocation where = node.where("temperature");
  if (text.ends_with("K") || text.ends_with("k")) text.pop_back();
  const double temperature = parse_number(text, where);
  if (!(temperature > 0 && temperature <= 1e9))
    throw Error(ErrorKind::Scene, where, "a temperature must lie between 0 and 1e9 kelvin");
  const double scale =
      node.attribute("scale") ? parse_number(*node.attribute("scale"), node.where("scale")) : 1;
  return measured(node, scale * blackbody_to_rgb(temperature), context);
}

Property::Value read_value(const XmlNode& node, const ValueContext& context) {
  const std::string& tag = node.tag;
  const auto value = [&]() -> const std::string& { return node.required("value"); };
  if (tag == "float") return parse_number(value(), node.where("value"));
  if (tag == "integer") return parse_integer(value(), node.where("value"));
  if (tag == "boolean") return parse_boolean(value(), node.where("value"));
  if (tag == "string") return value();
  if (tag == "point") return Property::Point{read_triple(node, std::nullopt)};
  if (tag == "vector") return Property::Vector{read_triple(node, std::nullopt)};
  if (tag == "rgb") return Property::Color{parse_triple(value(), node.where("value"))};
  if (tag == "spectrum") return read_spectrum(node, context);
  if (tag == "blackbody") return read_blackbody(node, context);
  return read_transform(node, context.diagnostics);
}

void check_value_attributes(const XmlNode& node, Diagnostics& diagnostics) {
  if (node.tag == "transform")
    check_attributes(node, {"name"}, diagnostics);
  else if (node.tag == "blackbody")
    check_attributes(node, {"name", "temperature", "scale"}, diagnostics);
  else if (node.tag == "spectrum")
    check_attributes(node, {"name", "value", "filename"}, diagnostics);
  else if (node.tag == "point" || node.tag == "vector")
    check_attributes(node, {"name", "value", "x", "y", "z"}, diagnostics);
  else
    check_attributes(node, {"name", "value"}, diagnostics);
}

}  // namespace

const std::vector<std::string>& value_tags() {
  static const std::vector<std::string> tags{"float",     "integer",  "boolean", "string",
                                             "point",     "vector",   "rgb",     "spectrum",
                                             "blackbody", "transform"};
  return tags;
}

bool is_value_tag(const std::string& tag) {
  return std::find(value_tags().begin(), value_tags().end(), tag) != value_tags().end();
}

Property read_property(const XmlNode& node, const ValueContext& context) {
  const std::string& name = node.required("name");
  constexpr std::size_t kMaxName = 256;
  if (name.empty() || name.size() > kMaxName)
    throw Error(ErrorKind::Scene, node.where("name"),
                "the name of a property is empty or very long");
  if (node.tag != "transform") reject_children(node);
  Property::Value value = read_value(node, context);
  check_value_attributes(node, context.diagnostics);
  return {name, std::move(value), node.where(), false};
}

std::string property_text(const XmlNode& node) {
  const auto trimmed = [](const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos) return std::string();
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
  };
  if (const std::string* value = node.attribute("value")) return trimmed(*value);
  std::string result;
  for (const char* axis : {"x", "y", "z"})
    if (const std::string* value = node.attribute(axis))
      result += (result.empty() ? "" : ", ") + trimmed(*value);
  return result;
}

}  // namespace fogbow
