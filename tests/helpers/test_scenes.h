// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace fogbow::testing {

/// A small scene built in code that holds one kind of difficulty.
struct TestScene {
  std::string name;
  std::function<SceneDescription()> make;
};

/// One for every kind of vertex, boundary and end point that the engine knows.
const std::vector<TestScene>& test_scenes();

SceneDescription make_test_scene(const std::string& name);

}  // namespace fogbow::testing
