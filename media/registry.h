// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include "core/scene/media_registry.h"

namespace fogbow {

/// All media and phase functions of this engine; one line each in registry.cpp.
const MediaRegistry& builtin_media();

}  // namespace fogbow
