// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/image.h"

#include <algorithm>

namespace fogbow {

int Image::channel(const std::string& name) const {
  const auto it = std::find(channels.begin(), channels.end(), name);
  return it == channels.end() ? -1 : static_cast<int>(it - channels.begin());
}

}  // namespace fogbow
