// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "core/scene_io/diagnostics.h"
#include "core/util/error.h"

namespace fogbow {

struct XmlAttribute {
  std::string name, value;
  int line = 0, column = 0;  ///< of its name
};

/// An element with its place: that of its `<`.
struct XmlNode {
  std::string tag;
  std::vector<XmlAttribute> attributes;
  std::vector<XmlNode> children;
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;

  SourceLocation where() const { return {*file, line, column}; }
  /// Place of an attribute, or of the element if it has none of that name.
  SourceLocation where(const std::string& name) const;
  /// Null if absent.
  const std::string* attribute(const std::string& name) const;
  /// Throws Error(Scene) if absent.
  const std::string& required(const std::string& name) const;
};

/// What a scene may cost to read, all its files together.
struct XmlLimits {
  std::size_t nodes = 1'000'000;
  int depth = 64;
  std::uint64_t bytes = 256u << 20;
  int include_depth = 16;
  int includes = 1000;
  std::size_t substituted_bytes = 16u << 20;
};

/// Parses a text; comments, doctype and processing instructions are dropped, bytes need not be
/// valid UTF-8. `nodes` counts on. Text between elements is warned of. Throws Error(Scene) on
/// malformed text, null bytes, repeated attributes and exceeded limits.
XmlNode parse_xml(const std::string& text, const std::string& file, const XmlLimits& limits,
                  std::size_t& nodes, Diagnostics& diagnostics);

}  // namespace fogbow
