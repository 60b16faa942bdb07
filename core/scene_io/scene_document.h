// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/files.h"
#include "core/scene_io/xml_document.h"

namespace fogbow {

/// A scene file with <default>, <include>, <path>, <alias> and $name carried out: what remains are
/// objects and their properties.
class SceneDocument {
 public:
  /// `definitions` win over <default>; those that no $name asked for are warned of.
  SceneDocument(const std::string& path, const std::map<std::string, std::string>& definitions,
                FileResolver& files, Diagnostics& diagnostics, const XmlLimits& limits = {});
  SceneDocument(const SceneDocument&) = delete;

  const XmlNode& root() const { return root_; }
  /// The element with this id or alias; null if there is none.
  const XmlNode* find(const std::string& id) const;

 private:
  struct Definition {
    std::string value;
    bool used;
  };
  struct Alias {
    std::string id, as;
    SourceLocation where;
  };

  XmlNode load(const std::filesystem::path& path, const SourceLocation& where);
  void upgrade(XmlNode& source);
  void expand(XmlNode& source, std::vector<XmlNode>& out);
  void include(const XmlNode& node, std::vector<XmlNode>& out);
  void substitute(XmlNode& node);
  std::string substituted(const std::string& text, const SourceLocation& where);
  Definition& definition(std::string_view text, std::size_t& length, const SourceLocation& where);
  void collect_ids(const XmlNode& node);
  void add_id(const std::string& id, const XmlNode& node, const SourceLocation& where);

  FileResolver& files_;
  Diagnostics& diagnostics_;
  XmlLimits limits_;
  std::map<std::string, Definition, std::less<>> definitions_;
  std::vector<std::filesystem::path> open_files_;
  std::size_t nodes_ = 0, substituted_bytes_ = 0;
  std::uint64_t bytes_ = 0;
  int includes_ = 0;
  std::optional<double> version_;  ///< of the scene, which included parts share
  XmlNode root_;
  std::vector<Alias> aliases_;
  std::map<std::string, const XmlNode*> ids_;
};

}  // namespace fogbow
