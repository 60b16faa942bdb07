// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/xml_document.h"

#include <pugixml.hpp>
#include <string_view>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/files.h"

namespace fogbow {

namespace {

/// Copies pugixml's tree into ours with places, which it knows for elements only; attributes are
/// found again in the text.
class Converter {
 public:
  Converter(std::string_view text, const std::string& file, const XmlLimits& limits,
            std::size_t& nodes, Diagnostics& diagnostics)
      : text_(text),
        lines_(text),
        file_(std::make_shared<const std::string>(file)),
        limits_(limits),
        nodes_(nodes),
        diagnostics_(diagnostics) {}

  SourceLocation at(std::size_t offset) const { return lines_.locate(*file_, offset); }

  [[noreturn]] void fail(std::size_t offset, const std::string& message) const {
    throw Error(ErrorKind::Scene, at(offset), message);
  }

  XmlNode convert(const pugi::xml_node& source, int depth) {
    const auto name_offset = static_cast<std::size_t>(source.offset_debug());
    const std::size_t offset = name_offset - 1;
    if (depth > limits_.depth)
      fail(offset, "elements are nested deeper than " + std::to_string(limits_.depth));
    if (++nodes_ > limits_.nodes)
      fail(offset, "more than " + std::to_string(limits_.nodes) + " elements");
    XmlNode node;
    node.tag = source.name();
    if (node.tag.size() > kMaxName) fail(offset, "the name of an element is too long");
    node.file = file_;
    const SourceLocation where = at(offset);
    node.line = where.line;
    node.column = where.column;
    read_attributes(source, name_offset + node.tag.size(), node);
    for (const pugi::xml_node& child : source.children()) {
      if (child.type() == pugi::node_element)
        node.children.push_back(convert(child, depth + 1));
      else
        diagnostics_.warn(at(static_cast<std::size_t>(child.offset_debug())),
                          "text " + quote(child.value()) + " between elements has no effect");
    }
    return node;
  }

 private:
  /// The text is known to be well formed here.
  void read_attributes(const pugi::xml_node& source, std::size_t offset, XmlNode& node) const {
    static constexpr std::string_view kSpace = " \t\r\n";
    for (const pugi::xml_attribute& attribute : source.attributes()) {
      offset = text_.find_first_not_of(kSpace, offset);
      const SourceLocation where = at(offset);
      if (node.attributes.size() >= kMaxAttributes || node.attribute(attribute.name()))
        fail(offset, node.attributes.size() >= kMaxAttributes
                         ? "too many attributes"
                         : "attribute " + quote(attribute.name()) + " is given twice");
      check_names(offset, attribute);
      node.attributes.push_back({attribute.name(), attribute.value(), where.line, where.column});
      const std::size_t open = text_.find_first_of("\"'", offset);
      offset = text_.find(text_[open], open + 1) + 1;
    }
  }

  /// Whatever names something stays short, so that messages do.
  void check_names(std::size_t offset, const pugi::xml_attribute& attribute) const {
    const std::string_view name = attribute.name(), value = attribute.value();
    const bool names = name == "name" || name == "id" || name == "type" || name == "as";
    if (name.size() > kMaxName || (names && value.size() > kMaxName))
      fail(offset, "a name of more than " + std::to_string(kMaxName) + " bytes");
  }

  static constexpr std::size_t kMaxName = 256;
  static constexpr std::size_t kMaxAttributes = 64;
  std::string_view text_;
  LineIndex lines_;
  std::shared_ptr<const std::string> file_;
  const XmlLimits& limits_;
  std::size_t& nodes_;
  Diagnostics& diagnostics_;
};

/// pugixml allocates a record for every element and attribute before we can count them. Those in
/// comments count, too.
void refuse_too_many(std::string_view text, const std::string& file, const XmlLimits& limits) {
  constexpr std::size_t kMaxAttributesPerElement = 16;
  std::size_t elements = 0, attributes = 0;
  for (std::size_t at = text.find_first_of("<="); at != std::string_view::npos;
       at = text.find_first_of("<=", at + 1)) {
    if (text[at] == '=')
      ++attributes;
    else if (at + 1 < text.size() && text[at + 1] != '/' && text[at + 1] != '!')
      ++elements;
    if (elements > limits.nodes || attributes > kMaxAttributesPerElement * limits.nodes)
      throw Error(ErrorKind::Scene, LineIndex(text).locate(file, at),
                  "more than " + std::to_string(limits.nodes) + " elements");
  }
}

}  // namespace

SourceLocation XmlNode::where(const std::string& name) const {
  for (const XmlAttribute& a : attributes)
    if (a.name == name) return {*file, a.line, a.column};
  return where();
}

const std::string* XmlNode::attribute(const std::string& name) const {
  for (const XmlAttribute& a : attributes)
    if (a.name == name) return &a.value;
  return nullptr;
}

const std::string& XmlNode::required(const std::string& name) const {
  if (const std::string* value = attribute(name)) return *value;
  throw Error(ErrorKind::Scene, where(), "<" + tag + "> needs the attribute \"" + name + "\"");
}

XmlNode parse_xml(const std::string& whole, const std::string& file, const XmlLimits& limits,
                  std::size_t& nodes, Diagnostics& diagnostics) {
  std::string_view text = whole;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  if (text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"))
    throw Error(ErrorKind::Scene, {file, 1, 1}, "UTF-16 text; scenes must be in UTF-8");
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    throw Error(ErrorKind::Scene, LineIndex(text).locate(file, zero),
                "a null byte; scenes must be UTF-8 text");
  refuse_too_many(text, file, limits);

  pugi::xml_document document;
  const pugi::xml_parse_result result = document.load_buffer(
      text.data(), text.size(), pugi::parse_default | pugi::parse_trim_pcdata, pugi::encoding_utf8);
  Converter converter(text, file, limits, nodes, diagnostics);
  if (!result)
    converter.fail(static_cast<std::size_t>(result.offset),
                   "malformed XML: " + std::string(result.description()));
  for (const pugi::xml_node& child : document.children())
    if (child != document.document_element())
      converter.fail(static_cast<std::size_t>(child.offset_debug()) - 1, "a second root element");
  return converter.convert(document.document_element(), 1);
}

}  // namespace fogbow
