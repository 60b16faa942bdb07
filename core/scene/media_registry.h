// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>

#include "core/scene/properties.h"

namespace fogbow {

/// Constructors of media and phase functions by plugin name: how scene readers build what lives in
/// a layer they do not see.
struct MediaRegistry {
  std::map<std::string, std::function<std::shared_ptr<const Medium>(Properties&)>> media;
  std::map<std::string, std::function<std::shared_ptr<const PhaseFunction>(Properties&)>> phases;
};

}  // namespace fogbow
