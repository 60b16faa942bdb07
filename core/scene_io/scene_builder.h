// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "core/scene_io/content_hash.h"
#include "core/scene_io/load.h"
#include "core/scene_io/plugins.h"
#include "core/scene_io/scene_document.h"

namespace fogbow {

/// Makes the objects that a scene document describes.
class SceneBuilder {
 public:
  SceneBuilder(const SceneDocument& document, const FileResolver& files, const MediaRegistry& media,
               const LoadOptions& options, Diagnostics& diagnostics)
      : document_(document),
        files_(files),
        media_(media),
        options_(options),
        diagnostics_(diagnostics) {}

  /// Also computes the hash: of all objects that take part, in their order, with references
  /// replaced by what they refer to, files by their bytes and numbers by their values. Names of
  /// files, ids, comments and unused definitions do not enter.
  SceneDescription build();

 private:
  /// An object in another one, and the name by which it is there.
  struct Child {
    std::string name;
    const XmlNode* node;
    SourceLocation where;
    bool used = false;
  };
  /// An element taken apart: its values and shared objects, and those that the parent has to deal
  /// with.
  struct Object {
    Properties properties;
    std::vector<Child> children;
    ContentHash hash;
    std::vector<Properties::AttributeNeed> needs{};  ///< of the shared objects in it

    /// All children of one tag, which thereby are used.
    std::vector<const Child*> take(const std::string& tag);
    const Child* take_one(const std::string& tag);
  };
  struct Shared {
    NestedObject::Object object;
    std::uint64_t hash;
    std::vector<Properties::AttributeNeed> needs;
  };
  class Nesting;

  Object read(const XmlNode& node);
  void read_child(Object& object, const XmlNode& child);
  const XmlNode& target(const XmlNode& reference) const;
  void check_plugin(const XmlNode& node) const;
  const Shared& shared(const XmlNode& node);
  NestedObject::Object make_shared_object(Object& object);
  void finish(Object& object);
  static std::vector<Properties::AttributeNeed> all_needs(const Object& object);

  FilmSettings film(const Child* child, ContentHash& hash);
  void apply_overrides(FilmSettings& film) const;
  void sampler(const XmlNode& node, ContentHash& hash);
  void sensor(const XmlNode& node);
  void integrator(const XmlNode& node);
  void integrator_settings(const XmlNode& node);
  void shape(const XmlNode& node);
  void surface(const XmlNode& node, const Transform* instance = nullptr);
  void instance(const XmlNode& node);
  void repaired(const Surface& surface, const std::string& what) const;
  void attach_emitter(Surface& surface, const Child& child, ContentHash& hash);
  void emitter(const XmlNode& node);
  void top_level(const XmlNode& node);

  const SceneDocument& document_;
  const FileResolver& files_;
  const MediaRegistry& media_;
  const LoadOptions& options_;
  Diagnostics& diagnostics_;
  SceneDescription scene_;
  ContentHash hash_;
  std::unordered_map<const XmlNode*, Shared> shared_;
  std::vector<const XmlNode*> open_;  ///< being built, outermost first
  std::set<const XmlNode*>
      attached_emitters_;  ///< defined at top level, attached to surfaces by reference
  std::optional<std::string> sample_count_;
  std::shared_ptr<const Bsdf> default_bsdf_, default_emitter_bsdf_;
  std::size_t instanced_shapes_ = 0;
  bool has_integrator_ = false;
};

}  // namespace fogbow
