// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <string>

#include "core/scene/properties.h"

namespace fogbow {

/// An index of refraction given as a number or as the name of a material ("bk7"); `fallback` is
/// such a name.
double index_of_refraction(Properties& properties, const std::string& name, const char* fallback);

}  // namespace fogbow
