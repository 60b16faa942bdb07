// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <string>
#include <type_traits>

#include "core/math/random.h"
#include "tests/helpers/statistics.h"
#include "tests/unit/scene_io/scene_folder.h"

namespace fogbow::testing {

/// Of a grid with one channel or three.
template <class Value>
Value make_value(double x) {
  if constexpr (std::is_arithmetic_v<Value>)
    return Value(x);
  else
    return Value(x, 0.5 * x, 2 - x);
}
template <class Value>
RGB to_rgb(const Value& v) {
  if constexpr (std::is_arithmetic_v<Value>)
    return RGB(v);
  else
    return {v[0], v[1], v[2]};
}

/// A medium whose extinction is a grid of a file.
class VdbScene : public ::testing::Test {
 protected:
  static std::string body(const std::string& file, const std::string& more = "") {
    return "<shape type=\"cube\"><medium type=\"heterogeneous\" name=\"interior\">"
           "<volume type=\"gridvolume\" name=\"sigma_t\">\n<string name=\"filename\" value=\"" +
           file + "\"/>\n" + more + "</volume></medium></shape>";
  }
  static std::string grid(const std::string& name) {
    return "<string name=\"grid\" value=\"" + name + "\"/>";
  }
  std::shared_ptr<const Medium> load(const std::string& file, const std::string& more = "") {
    return folder_.load(body(file, more)).surfaces.at(0).interior;
  }
  /// The file's name stands in line 3, whatever follows in line 4.
  void expect_error(const std::string& file, const std::string& message,
                    const std::string& more = "", int line = 3) {
    const std::string text = folder_.error(body(file, more));
    EXPECT_NE(text.find(message), std::string::npos) << text;
    EXPECT_EQ(text.find("scene.xml:" + std::to_string(line) + ":"), 0u) << text;
    EXPECT_EQ(folder_.kind, ErrorKind::Scene);
  }
  std::string file(const std::string& name) const { return folder_.path(name).string(); }

  /// Compares with `expected`, which takes an index, at points in and around a box of indices;
  /// returns how many of them were not zero.
  template <class Expected>
  int compare(const Medium& medium, const Transform& index_to_world, const Vec3& lo, const Vec3& hi,
              double largest, const Expected& expected) {
    Rng rng(suite_seed(), RngDomain::Test, 910, 0);
    int positive = 0, wrong = 0;
    for (int i = 0; i < 4000; ++i) {
      const Vec3 index = lo - 3.0 + uniform3(rng) * (hi - lo + 6.0);
      const RGB found = medium.sigma_t(index_to_world.point(index)), truth = expected(index);
      positive += truth != RGB(0);
      // The libraries interpolate in single precision.
      for (int c = 0; c < 3; ++c)
        if (!(std::abs(found[c] - truth[c]) <= 2e-6 * largest) && ++wrong < 4)
          ADD_FAILURE() << "at (" << index.x << ", " << index.y << ", " << index.z << ") "
                        << found[c] << " instead of " << truth[c];
    }
    EXPECT_EQ(wrong, 0);
    return positive;
  }

  SceneFolder folder_;
};

}  // namespace fogbow::testing
