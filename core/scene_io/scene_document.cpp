// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/scene_document.h"

#include <algorithm>
#include <system_error>

#include "core/scene_io/parse_values.h"
#include "core/scene_io/upgrade.h"

namespace fogbow {

namespace fs = std::filesystem;

namespace {

/// Counted for every $name on top of its value, so that empty values cannot be substituted without
/// end.
constexpr std::size_t kSubstitutionCost = 16;

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// Warns of attributes that an element does not have.
void check_attributes(const XmlNode& node, const std::vector<std::string>& known,
                      Diagnostics& diagnostics) {
  for (const XmlAttribute& a : node.attributes)
    if (std::find(known.begin(), known.end(), a.name) == known.end())
      diagnostics.warn(node.where(a.name), "attribute " + quote(a.name) + " of <" + node.tag +
                                               "> has no effect" + suggestion(a.name, known));
}

}  // namespace

SceneDocument::SceneDocument(const std::string& path,
                             const std::map<std::string, std::string>& definitions,
                             FileResolver& files, Diagnostics& diagnostics, const XmlLimits& limits)
    : files_(files), diagnostics_(diagnostics), limits_(limits) {
  for (const auto& [name, value] : definitions) definitions_[name] = {value, false};
  XmlNode source = load(path, {path, 0, 0});
  if (source.tag != "scene")
    throw Error(ErrorKind::Scene, source.where(),
                "expected <scene> as the outermost element, found <" + source.tag + ">");
  std::vector<XmlNode> expanded;
  expand(source, expanded);
  root_ = std::move(expanded.front());
  for (const XmlNode& child : root_.children) collect_ids(child);
  for (const Alias& alias : aliases_) {
    const XmlNode* target = find(alias.id);
    if (!target)
      throw Error(ErrorKind::Scene, alias.where, "alias of an unknown id " + quote(alias.id));
    add_id(alias.as, *target, alias.where);
  }
  for (const auto& [name, value] : definitions)
    if (!definitions_.find(name)->second.used)
      diagnostics_.warn({path, 0, 0}, "the definition of " + quote(name) +
                                          " has no effect: the scene does not use $" + name);
}

const XmlNode* SceneDocument::find(const std::string& id) const {
  const auto it = ids_.find(id);
  return it == ids_.end() ? nullptr : it->second;
}

XmlNode SceneDocument::load(const fs::path& path, const SourceLocation& where) {
  std::error_code status;
  const fs::path identity = fs::weakly_canonical(path, status);
  if (std::find(open_files_.begin(), open_files_.end(), identity) != open_files_.end())
    throw Error(ErrorKind::Scene, where, quote(path.string()) + " includes itself");
  if (open_files_.size() > static_cast<std::size_t>(limits_.include_depth))
    throw Error(ErrorKind::Scene, where,
                "includes are nested deeper than " + std::to_string(limits_.include_depth));
  const std::string text = read_file(path, limits_.bytes - bytes_, where);
  bytes_ += text.size();
  open_files_.push_back(identity);
  XmlNode source = parse_xml(text, path.string(), limits_, nodes_, diagnostics_);
  upgrade(source);
  return source;
}

/// An included scene may be of another version than the one that includes it.
void SceneDocument::upgrade(XmlNode& source) {
  double version = version_.value_or(kFirstVersionOfToday);
  if (const std::string* text = source.attribute("version"); text && source.tag == "scene") {
    std::string_view rest = *text;
    if (!consume_number(rest, version)) return;  // an error that the builder tells
  }
  if (!version_) version_ = version;
  if (version < kFirstVersionOfToday) upgrade_scene(source);
}

void SceneDocument::expand(XmlNode& source, std::vector<XmlNode>& out) {
  substitute(source);
  if (source.tag == "default") {
    check_attributes(source, {"name", "value"}, diagnostics_);
    definitions_.try_emplace(source.required("name"), Definition{source.required("value"), true});
  } else if (source.tag == "path") {
    check_attributes(source, {"value"}, diagnostics_);
    files_.add_folder(source.required("value"), source.where("value"));
  } else if (source.tag == "alias") {
    check_attributes(source, {"id", "as"}, diagnostics_);
    aliases_.push_back({source.required("id"), source.required("as"), source.where()});
  } else if (source.tag == "include") {
    check_attributes(source, {"filename"}, diagnostics_);
    include(source, out);
  } else {
    std::vector<XmlNode> children;
    children.reserve(source.children.size());
    for (XmlNode& child : source.children) expand(child, children);
    source.children = std::move(children);
    out.push_back(std::move(source));
  }
}

void SceneDocument::include(const XmlNode& node, std::vector<XmlNode>& out) {
  if (++includes_ > limits_.includes)
    throw Error(ErrorKind::Scene, node.where(),
                "more than " + std::to_string(limits_.includes) + " includes");
  const SourceLocation where = node.where("filename");
  XmlNode source = load(files_.resolve(node.required("filename"), where), where);
  std::vector<XmlNode> expanded;
  expand(source, expanded);
  open_files_.pop_back();
  for (XmlNode& object : expanded) {
    if (object.tag != "scene") {
      out.push_back(std::move(object));
      continue;
    }
    for (XmlNode& child : object.children) out.push_back(std::move(child));
  }
}

void SceneDocument::substitute(XmlNode& node) {
  for (XmlAttribute& a : node.attributes)
    if (a.value.find('$') != std::string::npos)
      a.value = substituted(a.value, {*node.file, a.line, a.column});
}

std::string SceneDocument::substituted(const std::string& text, const SourceLocation& where) {
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] != '$') {
      result += text[i++];
      continue;
    }
    std::size_t length = 0;
    const Definition& found = definition(std::string_view(text).substr(i + 1), length, where);
    substituted_bytes_ += found.value.size() + kSubstitutionCost;
    if (substituted_bytes_ > limits_.substituted_bytes)
      throw Error(
          ErrorKind::Scene, where,
          "substitutions grow beyond " + std::to_string(limits_.substituted_bytes) + " bytes");
    result += found.value;
    i += 1 + length;
  }
  return result;
}

/// The longest defined name that `text` starts with, as in Mitsuba: "$xy" is y after the value of x
/// where no xy is defined.
SceneDocument::Definition& SceneDocument::definition(std::string_view text, std::size_t& length,
                                                     const SourceLocation& where) {
  constexpr std::size_t kMaxName = 128;
  const auto end = std::find_if_not(text.begin(), text.end(), is_name_character);
  const std::string_view name = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  for (length = std::min(name.size(), kMaxName); length > 0; --length)
    if (const auto it = definitions_.find(name.substr(0, length)); it != definitions_.end()) {
      it->second.used = true;
      return it->second;
    }
  std::vector<std::string> known;
  for (const auto& [key, value] : definitions_)
    if (known.size() < 100) known.push_back(key);
  throw Error(ErrorKind::Scene, where,
              "$" + quote(name) + " is not defined by a <default> before it, nor by -D" +
                  suggestion(name, known));
}

void SceneDocument::collect_ids(const XmlNode& node) {
  if (const std::string* id = node.attribute("id"); id && node.tag != "ref")
    add_id(*id, node, node.where("id"));
  for (const XmlNode& child : node.children) collect_ids(child);
}

void SceneDocument::add_id(const std::string& id, const XmlNode& node,
                           const SourceLocation& where) {
  const auto [it, added] = ids_.emplace(id, &node);
  if (!added)
    throw Error(
        ErrorKind::Scene, where,
        "the id " + quote(id) + " is taken (first at " + to_string(it->second->where()) + ")");
}

}  // namespace fogbow
