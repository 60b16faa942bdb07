// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/scene_builder.h"

#include <algorithm>
#include <stdexcept>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene_io/film_window.h"
#include "core/scene_io/mesh_attributes.h"
#include "core/scene_io/parse_values.h"
#include "core/scene_io/read_property.h"
#include "core/util/log.h"

namespace fogbow {

namespace {

constexpr std::size_t kMaxProperties = 256;
constexpr std::size_t kMaxDepth = 64;
constexpr std::size_t kMaxInstancedShapes = 1 << 20;

const std::vector<std::string>& object_tags() {
  static const std::vector<std::string> tags{"bsdf",   "emitter", "film",    "integrator",
                                             "medium", "phase",   "rfilter", "sampler",
                                             "sensor", "shape",   "texture", "volume"};
  return tags;
}

bool is_object_tag(const std::string& tag) {
  return std::find(object_tags().begin(), object_tags().end(), tag) != object_tags().end();
}

bool is_shared_tag(const std::string& tag) {
  return tag == "bsdf" || tag == "medium" || tag == "phase" || tag == "rfilter" ||
         tag == "texture" || tag == "volume";
}

/// The constructor that a table has for a plugin.
template <class Table>
const auto& find_plugin(const Table& table, const std::string& kind, const std::string& plugin,
                        const SourceLocation& where) {
  if (const auto it = table.find(plugin); it != table.end()) return it->second;
  std::vector<std::string> known;
  for (const auto& [name, constructor] : table) known.push_back(name);
  throw Error(ErrorKind::Scene, where,
              "the " + kind + " plugin " + quote(plugin) + " is not supported" +
                  suggestion(plugin, known) + "; known: " + listed(known));
}

/// What the constructor throws gets the place of the object.
template <class Table, class... Arguments>
auto construct(const Table& table, Properties& p, Arguments&&... arguments) {
  const auto& constructor = find_plugin(table, p.kind(), p.plugin(), p.where());
  try {
    return constructor(p, std::forward<Arguments>(arguments)...);
  } catch (const std::domain_error& error) {
    throw Error(ErrorKind::Scene, p.where(), error.what());
  } catch (const std::invalid_argument& error) {
    throw Error(ErrorKind::Scene, p.where(), error.what());
  }
}

void check_version(const XmlNode& root) {
  const std::string& text = root.required("version");
  std::string_view rest = text;
  double version = 0;
  if (!consume_number(rest, version))
    throw Error(ErrorKind::Scene, root.where("version"),
                "expected a version such as \"3.0.0\", found " + quote(text));
}

/// Of the volume that a shape bounds, where it overlaps others.
int priority(Properties& p) {
  const std::int64_t value = p.integer("priority", 0);
  constexpr std::int64_t kLargest = 1'000'000;
  if (value < -kLargest || value > kLargest)
    p.fail("priority", "\"priority\" must lie between -1000000 and 1000000");
  return static_cast<int>(value);
}

/// Names of the files themselves say nothing of the scene: their bytes are hashed instead.
std::uint64_t hash_of(const Property& property) {
  ContentHash hash;
  if (property.name == "filename") return 0;
  hash.add(property.name);
  std::visit(
      [&](const auto& value) {
        using T = std::decay_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::int64_t>)
          hash.add(static_cast<double>(value));
        else if constexpr (std::is_same_v<T, Property::Color>)
          hash.add(value.c);
        else if constexpr (std::is_same_v<T, Property::Point> ||
                           std::is_same_v<T, Property::Vector>)
          hash.add(value.v);
        else
          hash.add(value);
      },
      property.value);
  return hash.value();
}

}  // namespace

/// Guards against objects that contain themselves, and against nesting without end.
class SceneBuilder::Nesting {
 public:
  Nesting(std::vector<const XmlNode*>& open, const XmlNode& node) : open_(open) {
    if (std::find(open.begin(), open.end(), &node) != open.end())
      throw Error(ErrorKind::Scene, node.where(),
                  "<" + node.tag + "> contains itself by reference");
    if (open.size() >= kMaxDepth)
      throw Error(ErrorKind::Scene, node.where(),
                  "objects are nested deeper than " + std::to_string(kMaxDepth));
    open.push_back(&node);
  }
  ~Nesting() { open_.pop_back(); }
  Nesting(const Nesting&) = delete;

 private:
  std::vector<const XmlNode*>& open_;
};

std::vector<const SceneBuilder::Child*> SceneBuilder::Object::take(const std::string& tag) {
  std::vector<const Child*> result;
  for (Child& child : children)
    if (child.node->tag == tag) {
      child.used = true;
      result.push_back(&child);
    }
  return result;
}

const SceneBuilder::Child* SceneBuilder::Object::take_one(const std::string& tag) {
  const auto all = take(tag);
  if (all.size() > 1)
    throw Error(ErrorKind::Scene, all[1]->where,
                "a second <" + tag + "> in a " + properties.kind());
  return all.empty() ? nullptr : all.front();
}

const XmlNode& SceneBuilder::target(const XmlNode& reference) const {
  const std::string& id = reference.required("id");
  if (const XmlNode* found = document_.find(id)) return *found;
  throw Error(ErrorKind::Scene, reference.where("id"),
              "reference to " + quote(id) + ", but no object has that id");
}

SceneBuilder::Object SceneBuilder::read(const XmlNode& node) {
  const std::string* id = node.attribute("id");
  Object object{{node.tag, node.required("type"), id ? *id : "", node.where()}, {}, {}};
  for (const XmlAttribute& a : node.attributes)
    if (a.name != "type" && a.name != "id" && a.name != "name" && a.name != "version")
      diagnostics_.warn(node.where(a.name),
                        "attribute " + quote(a.name) + " of <" + node.tag + "> has no effect");
  object.hash.add(node.tag);
  object.hash.add(object.properties.plugin());
  for (const XmlNode& child : node.children) read_child(object, child);
  // Properties may come in any order.
  std::uint64_t sum = 0;
  for (const Property& p : object.properties.values()) sum += hash_of(p);
  object.hash.add(sum);
  return object;
}

void SceneBuilder::read_child(Object& object, const XmlNode& child) {
  if (is_value_tag(child.tag)) {
    if (object.properties.values().size() >= kMaxProperties)
      throw Error(ErrorKind::Scene, child.where(),
                  "more than " + std::to_string(kMaxProperties) + " properties");
    object.properties.add(read_property(
        child, ValueContext{diagnostics_, files_, object.properties.kind() == "emitter"}));
    return;
  }
  const bool reference = child.tag == "ref";
  if (!reference && !is_object_tag(child.tag)) {
    std::vector<std::string> known = value_tags();
    known.insert(known.end(), object_tags().begin(), object_tags().end());
    throw Error(ErrorKind::Scene, child.where(),
                "unknown element <" + child.tag + ">" + suggestion(child.tag, known));
  }
  const XmlNode& node = reference ? target(child) : child;
  const std::string* name = child.attribute("name");
  if (!is_shared_tag(node.tag)) {
    object.children.push_back({name ? *name : "", &node, child.where()});
    return;
  }
  const Shared& nested = shared(node);
  object.hash.add(name ? std::string_view(*name) : std::string_view());
  object.hash.add(nested.hash);
  object.needs.insert(object.needs.end(), nested.needs.begin(), nested.needs.end());
  object.properties.add(NestedObject{name ? *name : "", nested.object, child.where()});
}

const SceneBuilder::Shared& SceneBuilder::shared(const XmlNode& node) {
  if (const auto it = shared_.find(&node); it != shared_.end()) return it->second;
  const Nesting guard(open_, node);
  check_plugin(node);
  Object object = read(node);
  NestedObject::Object made = make_shared_object(object);
  finish(object);
  return shared_.emplace(&node, Shared{std::move(made), object.hash.value(), all_needs(object)})
      .first->second;
}

std::vector<Properties::AttributeNeed> SceneBuilder::all_needs(const Object& object) {
  std::vector<Properties::AttributeNeed> all = object.needs;
  const auto& own = object.properties.attribute_needs();
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

/// Before the object is read: nothing that stands in an unknown one is worth an error.
void SceneBuilder::check_plugin(const XmlNode& node) const {
  const auto check = [&](const auto& table) {
    find_plugin(table, node.tag, node.required("type"), node.where());
  };
  if (node.tag == "shape") return check(shape_plugins());
  if (node.tag == "bsdf") return check(bsdf_plugins());
  if (node.tag == "medium") return check(media_.media);
  if (node.tag == "phase") return check(media_.phases);
  if (node.tag == "rfilter") return check(filter_plugins());
  if (node.tag == "texture") return check(texture_plugins());
  if (node.tag == "volume") return check(volume_plugins());
}

NestedObject::Object SceneBuilder::make_shared_object(Object& object) {
  Properties& p = object.properties;
  if (p.kind() == "bsdf") return construct(bsdf_plugins(), p);
  if (p.kind() == "medium") return construct(media_.media, p);
  if (p.kind() == "phase") return construct(media_.phases, p);
  if (p.kind() == "texture")
    return construct(texture_plugins(), p,
                     PictureContext{files_, object.hash, options_.read_image});
  if (p.kind() == "volume") return construct(volume_plugins(), p, FileContext{files_, object.hash});
  return construct(filter_plugins(), p);
}

/// Warns of whatever was not asked for.
void SceneBuilder::finish(Object& object) {
  const Properties& p = object.properties;
  const std::string owner = p.kind() + " \"" + p.plugin() + "\"";
  for (const Properties::Warning& w : p.warnings()) diagnostics_.warn(w.where, w.message);
  for (const Property& value : p.values())
    if (!value.used)
      diagnostics_.warn(value.where, std::string(value.type_name()) + " " + quote(value.name) +
                                         " of " + owner + " has no effect" +
                                         suggestion(value.name, p.known_names()));
  for (const NestedObject& o : p.objects())
    if (!o.used)
      diagnostics_.warn(
          o.where, std::string("the ") + o.type_name() + " nested in " + owner + " has no effect");
  for (const Child& child : object.children)
    if (!child.used)
      diagnostics_.warn(child.where,
                        "the " + child.node->tag + " nested in " + owner + " has no effect");
}

FilmSettings SceneBuilder::film(const Child* child, ContentHash& hash) {
  FilmSettings result;
  if (child) {
    const Nesting guard(open_, *child->node);
    Object object = read(*child->node);
    result = construct(film_plugins(), object.properties);
    finish(object);
  } else {
    result.filter = make_gaussian_filter();
  }
  apply_overrides(result);
  hash.add(std::string_view(result.filter->name()));
  hash.add(result.filter->radius());
  hash.add(result.filter->evaluate(0));
  for (const int value : {result.width, result.height, result.crop_x, result.crop_y,
                          result.crop_width, result.crop_height})
    hash.add(static_cast<double>(value));
  return result;
}

/// A new size drops the file's crop window, which was meant for the old one.
void SceneBuilder::apply_overrides(FilmSettings& film) const {
  if (options_.size) {
    film.width = options_.size->first;
    film.height = options_.size->second;
    film.crop_x = film.crop_y = film.crop_width = film.crop_height = 0;
  }
  if (options_.crop) {
    const auto& [x, y, width, height] = *options_.crop;
    film.crop_x = x;
    film.crop_y = y;
    film.crop_width = width;
    film.crop_height = height;
  }
  check_film(film, {}, ErrorKind::Usage);
}

/// Any sampler means ours: only its sample count is kept.
void SceneBuilder::sampler(const XmlNode& node, ContentHash& hash) {
  Object object = read(node);
  if (object.properties.has("sample_count"))
    sample_count_ = std::to_string(object.properties.integer("sample_count", 0));
  hash.add(object.hash.value());
  finish(object);
}

void SceneBuilder::sensor(const XmlNode& node) {
  if (scene_.sensor) {
    diagnostics_.warn(node.where(), "a second sensor has no effect: the first one is used");
    return;
  }
  const Nesting guard(open_, node);
  Object object = read(node);
  scene_.film = film(object.take_one("film"), object.hash);
  if (const Child* child = object.take_one("sampler")) sampler(*child->node, object.hash);
  scene_.sensor_medium = object.properties.take_one<Medium>();
  scene_.sensor_medium_declared = scene_.sensor_medium != nullptr;
  scene_.sensor = construct(sensor_plugins(), object.properties, scene_.film);
  finish(object);
  hash_.add(object.hash.value());
}

void SceneBuilder::integrator(const XmlNode& node) {
  if (has_integrator_) throw Error(ErrorKind::Scene, node.where(), "a second integrator");
  has_integrator_ = true;
  integrator_settings(node);
}

/// One that holds another ("moment", "aov", "multichannel") says what to note of its picture: the
/// inner one says which picture it is.
void SceneBuilder::integrator_settings(const XmlNode& node) {
  const Nesting guard(open_, node);
  Object object = read(node);
  if (const Child* inner = object.take_one("integrator")) {
    integrator_settings(*inner->node);
    finish(object);
  } else {
    scene_.integrator.type = object.properties.plugin();
    hash_.add(scene_.integrator.type);
    for (const XmlNode& child : node.children)
      if (is_value_tag(child.tag))
        scene_.integrator.properties.emplace_back(*child.attribute("name"), property_text(child));
    for (const Child& child : object.children)
      diagnostics_.warn(child.where,
                        "the " + child.node->tag + " nested in an integrator has no effect");
  }
  hash_.add(object.hash.value());
}

/// Groups are seen through their instances alone.
void SceneBuilder::shape(const XmlNode& node) {
  const std::string& type = node.required("type");
  if (type == "instance")
    instance(node);
  else if (type != "shapegroup")
    surface(node);
}

/// The shapes of the group once more, in their new place.
void SceneBuilder::instance(const XmlNode& node) {
  const Nesting guard(open_, node);
  Object object = read(node);
  const Transform to_world = object.properties.transform("to_world");
  const Child* child = object.take_one("shape");
  if (!child || child->node->required("type") != "shapegroup")
    throw Error(ErrorKind::Scene, node.where(), "an instance needs a shape of type \"shapegroup\"");
  finish(object);
  hash_.add(object.hash.value());
  const Nesting group_guard(open_, *child->node);
  Object group = read(*child->node);
  for (const Child* member : group.take("shape")) {
    const std::string& type = member->node->required("type");
    if (type == "instance" || type == "shapegroup")
      throw Error(ErrorKind::Scene, member->where, "groups and instances do not stand in groups");
    if (++instanced_shapes_ > kMaxInstancedShapes)
      throw Error(ErrorKind::Scene, node.where(),
                  "instances show more than " + std::to_string(kMaxInstancedShapes) + " shapes");
    surface(*member->node, &to_world);
  }
  finish(group);
}

void SceneBuilder::surface(const XmlNode& node, const Transform* instance) {
  const Nesting guard(open_, node);
  check_plugin(node);
  Object object = read(node);
  Properties& p = object.properties;
  if (instance) p.append_transform("to_world", *instance);
  Surface surface;
  surface.id = p.id();
  surface.where = p.where();
  surface.bsdf = p.take_one<Bsdf>();
  surface.interior = p.take<Medium>("interior");
  surface.exterior = p.take<Medium>("exterior");
  surface.medium_boundary = surface.interior || surface.exterior;
  const bool encloses = surface.medium_boundary || (surface.bsdf && surface.bsdf->eta() != 1);
  surface.shape = construct(shape_plugins(), p,
                            FileContext{files_, object.hash, options_.repair && encloses,
                                        instance && instance->flips_orientation(),
                                        [&](const std::string& what) { repaired(surface, what); }});
  if (const Child* child = object.take_one("emitter")) {
    if (instance)
      throw Error(ErrorKind::Scene, child->where, "shapes that emit light cannot be instanced");
    attach_emitter(surface, *child, object.hash);
  }
  if (!surface.bsdf) {
    auto& fallback = surface.emitter ? default_emitter_bsdf_ : default_bsdf_;
    if (!fallback) fallback = make_diffuse(RGB(surface.emitter ? 0 : 0.5));
    surface.bsdf = fallback;
  }
  if (surface.medium_boundary || surface.bsdf->eta() != 1) surface.priority = priority(p);
  check_attributes(*surface.shape, all_needs(object));
  finish(object);
  hash_.add(object.hash.value());
  scene_.surfaces.push_back(std::move(surface));
}

void SceneBuilder::repaired(const Surface& surface, const std::string& what) const {
  const std::string message =
      to_string(surface.where) + ": shape " + quote(surface.id) + " repaired: " + what;
  log_info(message);
  if (options_.on_repair) options_.on_repair(message);
}

void SceneBuilder::attach_emitter(Surface& surface, const Child& child, ContentHash& hash) {
  const Nesting guard(open_, *child.node);
  Object object = read(*child.node);
  // Emitters look at their texture as they are made.
  std::vector<Properties::AttributeNeed> needs = object.needs;
  for (const auto& texture : object.properties.objects())
    if (const auto* t = std::get_if<std::shared_ptr<const Texture>>(&texture.object))
      if (const auto use = (*t)->attribute()) needs.push_back({*use, 0, kInfinity, texture.where});
  check_attributes(*surface.shape, needs);
  surface.emitter = construct(surface_emitter_plugins(), object.properties, surface.shape);
  finish(object);
  hash.add(object.hash.value());
  attached_emitters_.insert(child.node);
}

void SceneBuilder::emitter(const XmlNode& node) {
  if (attached_emitters_.contains(&node)) return;
  const Nesting guard(open_, node);
  Object object = read(node);
  const std::string& plugin = object.properties.plugin();
  if (surface_emitter_plugins().contains(plugin))
    throw Error(ErrorKind::Scene, node.where(),
                "the emitter " + quote(plugin) + " must stand inside a shape");
  for (const auto& nested : object.properties.objects())
    if (const auto* t = std::get_if<std::shared_ptr<const Texture>>(&nested.object);
        !object.needs.empty() || (t && (*t)->attribute()))
      throw Error(ErrorKind::Scene, nested.where, "only on a mesh can attributes be looked up");
  for (auto& made : construct(emitter_plugins(), object.properties,
                              PictureContext{files_, object.hash, options_.read_image}))
    scene_.emitters.push_back(std::move(made));
  finish(object);
  hash_.add(object.hash.value());
}

void SceneBuilder::top_level(const XmlNode& node) {
  if (node.tag == "shape")
    shape(node);
  else if (node.tag == "sensor")
    sensor(node);
  else if (node.tag == "integrator")
    integrator(node);
  else if (is_shared_tag(node.tag))
    shared(node);
  else if (node.tag == "ref")
    diagnostics_.warn(node.where(), "the reference has no effect: \"" + target(node).tag +
                                        "\" is part of the scene already");
  else if (is_value_tag(node.tag) || node.tag == "film" || node.tag == "sampler")
    diagnostics_.warn(node.where(), "<" + node.tag + "> directly in <scene> has no effect");
  else if (node.tag != "emitter")
    throw Error(ErrorKind::Scene, node.where(),
                "unknown element <" + node.tag + ">" + suggestion(node.tag, object_tags()));
}

SceneDescription SceneBuilder::build() {
  const XmlNode& root = document_.root();
  scene_.title = *root.file;
  if (options_.repair) hash_.add("repair");
  check_version(root);
  for (const XmlNode& node : root.children) top_level(node);
  // After the shapes, which may refer to emitters defined at top level.
  for (const XmlNode& node : root.children)
    if (node.tag == "emitter") emitter(node);
  if (!scene_.sensor) throw Error(ErrorKind::Scene, root.where(), "the scene has no sensor");
  if (sample_count_) scene_.integrator.properties.emplace_back("sample_count", *sample_count_);
  scene_.content_hash = hash_.value();
  return std::move(scene_);
}

}  // namespace fogbow
