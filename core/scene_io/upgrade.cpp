// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/upgrade.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "core/scene_io/diagnostics.h"
#include "core/util/log.h"

namespace fogbow {

namespace {

bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }

// --- The rules. After the names have become snake_case; an empty plugin stands for all.

struct PluginRule {
  const char *tag, *from, *to;
};
constexpr PluginRule kPlugins[] = {
    {"film", "ldrfilm", "hdrfilm"},
    {"film", "tiledhdrfilm", "hdrfilm"},
    {"integrator", "volpath_simple", "volpath"},
};

struct PropertyRule {
  const char *tag, *plugin, *from, *to;
};
constexpr PropertyRule kProperties[] = {
    {"bsdf", "diffuse", "diffuse_reflectance", "reflectance"},
    {"medium", "heterogeneous", "density", "sigma_t"},
};

/// Words that are others now; with an empty one the property goes away.
struct ValueRule {
  const char *tag, *plugin, *name, *from, *to;
};
constexpr ValueRule kValues[] = {
    {"texture", "bitmap", "filter_type", "trilinear", "bilinear"},
    {"texture", "bitmap", "filter_type", "ewa", "bilinear"},
    {"texture", "bitmap", "gamma", "-1", ""},
    {"bsdf", "conductor", "ext_eta", "1", ""},
    {"bsdf", "conductor", "ext_eta", "air", ""},
    {"bsdf", "roughconductor", "ext_eta", "1", ""},
    {"bsdf", "roughconductor", "ext_eta", "air", ""},
};

/// What says nothing of a linear picture of a scene at rest, or that Mitsuba 3 does by itself.
struct Dropped {
  const char *tag, *plugin, *name;
};
constexpr Dropped kDropped[] = {
    {"film", "", "gamma"},
    {"film", "", "exposure"},
    {"film", "", "banner"},
    {"film", "", "attach_log"},
    {"film", "", "tonemap_method"},
    {"film", "", "key"},
    {"film", "", "burn"},
    {"film", "", "high_quality_edges"},
    {"sensor", "", "shutter_open"},
    {"sensor", "", "shutter_close"},
    {"medium", "heterogeneous", "method"},
    {"emitter", "sky", "resolution"},
    {"emitter", "sunsky", "resolution"},
    {"emitter", "sun", "resolution"},
};

/// Defaults that have changed: where none of the properties is given, the first one had a value.
struct DefaultRule {
  const char *tag, *plugin, *type, *name, *value;
  std::array<const char*, 2> or_given;
};
constexpr DefaultRule kDefaults[] = {
    {"bsdf", "conductor", "string", "material", "Cu", {"eta", "k"}},
    {"bsdf", "roughconductor", "string", "material", "Cu", {"eta", "k"}},
    // The voxels filled the box that their file tells, or that between two corners.
    {"volume", "gridvolume", "boolean", "use_grid_bbox", "true", {"min", "max"}},
};

bool applies(const char* tag, const char* plugin, const XmlNode& node) {
  const std::string* type = node.attribute("type");
  return node.tag == tag && (*plugin == '\0' || (type && *type == plugin));
}

XmlAttribute* find_attribute(XmlNode& node, const std::string& name) {
  const auto it = std::ranges::find(node.attributes, name, &XmlAttribute::name);
  return it == node.attributes.end() ? nullptr : &*it;
}

XmlNode* find_child(XmlNode& node, const std::string& name) {
  const auto it = std::ranges::find_if(node.children, [&](const XmlNode& child) {
    const std::string* own = child.attribute("name");
    return own && *own == name;
  });
  return it == node.children.end() ? nullptr : &*it;
}

/// An element at the place of another.
XmlNode make_node(const XmlNode& place, const std::string& tag,
                  std::initializer_list<std::pair<const char*, std::string>> attributes) {
  XmlNode node;
  node.tag = tag;
  node.file = place.file;
  node.line = place.line;
  node.column = place.column;
  for (const auto& [name, value] : attributes)
    node.attributes.push_back({name, value, place.line, place.column});
  return node;
}

class Upgrade {
 public:
  explicit Upgrade(XmlNode& root) { collect_tags(root); }

  void visit(XmlNode& node, const std::string& parent) {
    if (node.tag == "default") return;
    if (node.tag == "lookAt") {
      tell(node, "<lookAt> is <lookat>");
      node.tag = "lookat";
    }
    rename(node);
    if (node.tag == "spectrum") upgrade_spectrum(node, parent);
    for (XmlNode& child : node.children) visit(child, node.tag);
    upgrade_plugin(node);
    upgrade_properties(node);
    if (node.tag == "shape") give_null_bsdf(node);
    if (node.tag == "texture") join_uv(node);
    if (applies("texture", "bitmap", node)) make_raw(node);
    if (applies("medium", "homogeneous", node)) give_skin(node);
    for (const char* plugin : {"sky", "sun", "sunsky"})
      if (applies("emitter", plugin, node)) turn_sky(node);
  }

 private:
  void tell(const XmlNode& node, const std::string& change) {
    if (told_.insert(change).second)
      log_info(to_string(node.where()) + ": of an older version: " + change + " now");
  }

  void collect_tags(const XmlNode& node) {
    if (const std::string* id = node.attribute("id"); id && node.tag != "ref")
      tag_of_id_.emplace(*id, node.tag);
    for (const XmlNode& child : node.children) collect_tags(child);
  }
  /// Of the element, or of what it refers to; empty if that lies in another file.
  std::string tag_of(const XmlNode& node) const {
    if (node.tag != "ref") return node.tag;
    const std::string* id = node.attribute("id");
    const auto it = id ? tag_of_id_.find(*id) : tag_of_id_.end();
    return it == tag_of_id_.end() ? std::string() : it->second;
  }

  void rename(XmlNode& node) {
    XmlAttribute* name = find_attribute(node, "name");
    if (!name) return;
    const std::string today = snake_case(name->value);
    if (today == name->value) return;
    tell(node, "\"" + name->value + "\" is \"" + today + "\"");
    name->value = today;
  }

  /// One number meant white light, and three a colour.
  void upgrade_spectrum(XmlNode& node, const std::string& parent) {
    const std::string* value = node.attribute("value");
    if (!value || value->find(':') != std::string::npos) return;
    const bool triple = value->find_first_of(", \t") != std::string::npos;
    if (!triple && parent != "emitter") return;
    tell(node, "a <spectrum> without wavelengths is <rgb>");
    node.tag = "rgb";
  }

  void upgrade_plugin(XmlNode& node) {
    for (const PluginRule& rule : kPlugins)
      if (applies(rule.tag, rule.from, node)) {
        tell(node,
             std::string("the ") + rule.tag + " \"" + rule.from + "\" is \"" + rule.to + "\"");
        find_attribute(node, "type")->value = rule.to;
      }
  }

  void upgrade_properties(XmlNode& node) {
    for (const PropertyRule& rule : kProperties) {
      XmlNode* child = applies(rule.tag, rule.plugin, node) ? find_child(node, rule.from) : nullptr;
      if (!child) continue;
      tell(*child,
           std::string("\"") + rule.from + "\" of " + rule.plugin + " is \"" + rule.to + "\"");
      find_attribute(*child, "name")->value = rule.to;
    }
    for (const ValueRule& rule : kValues) {
      XmlNode* child = applies(rule.tag, rule.plugin, node) ? find_child(node, rule.name) : nullptr;
      XmlAttribute* value = child ? find_attribute(*child, "value") : nullptr;
      if (!value || value->value != rule.from) continue;
      const bool goes = *rule.to == '\0';
      tell(*child, quote(rule.name) + ' ' + quote(rule.from) + " is " +
                       (goes ? "what is taken for granted" : quote(rule.to)));
      value->value = rule.to;
      if (goes) node.children.erase(node.children.begin() + (child - node.children.data()));
    }
    for (const Dropped& rule : kDropped) {
      XmlNode* child = applies(rule.tag, rule.plugin, node) ? find_child(node, rule.name) : nullptr;
      if (!child) continue;
      tell(*child, std::string("\"") + rule.name + "\" of a " + rule.tag + " has no meaning");
      node.children.erase(node.children.begin() + (child - node.children.data()));
    }
    for (const DefaultRule& rule : kDefaults) {
      if (!applies(rule.tag, rule.plugin, node) || find_child(node, rule.name) ||
          std::ranges::any_of(rule.or_given,
                              [&](const char* name) { return find_child(node, name); }))
        continue;
      tell(node,
           std::string("the default \"") + rule.value + "\" of " + rule.plugin + " is written");
      node.children.push_back(
          make_node(node, rule.type, {{"name", rule.name}, {"value", rule.value}}));
    }
  }

  /// A boundary of media that had no BSDF did not scatter.
  void give_null_bsdf(XmlNode& shape) {
    bool media = false, bsdf = false;
    for (const XmlNode& child : shape.children) {
      const std::string* name = child.attribute("name");
      const std::string tag = tag_of(child);
      const bool medium = name && (*name == "interior" || *name == "exterior");
      media |= medium;
      bsdf |= tag == "bsdf" || tag == "emitter" || (tag.empty() && !medium);
    }
    if (!media || bsdf) return;
    tell(shape, "a boundary of media without a bsdf has a \"null\" one");
    shape.children.push_back(make_node(shape, "bsdf", {{"type", "null"}}));
  }

  /// The zenith was +y, and the ground darker.
  void turn_sky(XmlNode& sky) {
    tell(sky, "a sky whose zenith is +y, not +z, is told by \"y_up\"");
    sky.children.push_back(make_node(sky, "boolean", {{"name", "y_up"}, {"value", "true"}}));
    if (find_child(sky, "albedo")) return;
    sky.children.push_back(make_node(sky, "float", {{"name", "albedo"}, {"value", "0.15"}}));
  }

  /// Texels whose gamma is one are values as they stand.
  void make_raw(XmlNode& texture) {
    XmlNode* gamma = find_child(texture, "gamma");
    const std::string* value = gamma ? gamma->attribute("value") : nullptr;
    if (!value || (*value != "1" && *value != "1.0")) return;
    tell(*gamma, "a bitmap of \"gamma\" 1 is \"raw\"");
    *gamma = make_node(*gamma, "boolean", {{"name", "raw"}, {"value", "true"}});
  }

  /// The default was the skin1 of [Jensen2001], in 1/mm.
  void give_skin(XmlNode& medium) {
    for (const char* name : {"sigma_s", "sigma_a", "sigma_t", "albedo", "material"})
      if (find_child(medium, name)) return;
    tell(medium, "the default of a homogeneous medium, which was skin, is written");
    for (const auto& [name, value] :
         {std::pair("sigma_s", "0.74, 0.88, 1.01"), std::pair("sigma_a", "0.032, 0.17, 0.48")})
      medium.children.push_back(make_node(medium, "rgb", {{"name", name}, {"value", value}}));
  }

  /// Scales and offsets of texture coordinates.
  void join_uv(XmlNode& texture) {
    std::map<std::string, std::string> given;
    for (const char* name : {"uscale", "vscale", "uoffset", "voffset"}) {
      XmlNode* child = find_child(texture, name);
      const std::string* value = child ? child->attribute("value") : nullptr;
      if (!value) continue;
      given[name] = *value;
      texture.children.erase(texture.children.begin() + (child - texture.children.data()));
    }
    if (given.empty()) return;
    tell(texture, "scales and offsets of texture coordinates are \"to_uv\"");
    const auto value = [&](const char* name, const char* missing) {
      const auto it = given.find(name);
      return it == given.end() ? std::string(missing) : it->second;
    };
    XmlNode transform = make_node(texture, "transform", {{"name", "to_uv"}});
    transform.children.push_back(
        make_node(texture, "scale", {{"x", value("uscale", "1")}, {"y", value("vscale", "1")}}));
    transform.children.push_back(make_node(
        texture, "translate", {{"x", value("uoffset", "0")}, {"y", value("voffset", "0")}}));
    texture.children.push_back(std::move(transform));
  }

  std::map<std::string, std::string> tag_of_id_;
  std::set<std::string> told_;
};

}  // namespace

std::string snake_case(std::string name) {
  std::string result;
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (i > 0 && is_upper(name[i]) && is_lower(name[i - 1])) {
      result += '_';
      for (; i < name.size() && is_upper(name[i]); ++i)
        result += static_cast<char>(name[i] - 'A' + 'a');
      if (i == name.size()) break;
    }
    result += name[i];
  }
  return result;
}

void upgrade_scene(XmlNode& root) { Upgrade(root).visit(root, {}); }

}  // namespace fogbow
