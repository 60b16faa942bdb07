// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "core/scene/properties.h"
#include "core/scene_io/diagnostics.h"
#include "core/scene_io/files.h"
#include "core/scene_io/xml_document.h"

namespace fogbow {

/// Whether a tag writes a value (float, rgb, transform, …) instead of an object.
bool is_value_tag(const std::string& tag);
/// What reading a value takes.
struct ValueContext {
  Diagnostics& diagnostics;
  const FileResolver& files;  ///< for measured spectra
  bool emission;              ///< the value belongs to an emitter
};
/// The value that such an element writes.
Property read_property(const XmlNode& node, const ValueContext& context);
/// The same as text, without the blanks around it: what integrators get.
std::string property_text(const XmlNode& node);
/// All tags of values.
const std::vector<std::string>& value_tags();

}  // namespace fogbow
