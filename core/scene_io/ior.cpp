// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/ior.h"

#include <array>

#include "core/scene_io/diagnostics.h"

namespace fogbow {

namespace {

struct NamedIndex {
  const char* name;
  double value;
};

/// The names and values that Mitsuba 3.9.1 knows, probed by asking it for each.
constexpr std::array<NamedIndex, 23> kIndices{
    {{"vacuum", 1.0},      {"helium", 1.000036},        {"hydrogen", 1.000132},
     {"air", 1.000277},    {"carbon dioxide", 1.00045}, {"water", 1.333},
     {"acetone", 1.36},    {"ethanol", 1.361},          {"carbon tetrachloride", 1.461},
     {"glycerol", 1.4729}, {"benzene", 1.501},          {"silicone oil", 1.52045},
     {"bromine", 1.661},   {"water ice", 1.31},         {"fused quartz", 1.458},
     {"pyrex", 1.47},      {"acrylic glass", 1.49},     {"polypropylene", 1.49},
     {"bk7", 1.5046},      {"sodium chloride", 1.544},  {"amber", 1.55},
     {"pet", 1.575},       {"diamond", 2.419}}};

}  // namespace

double index_of_refraction(Properties& p, const std::string& name, const char* fallback) {
  const auto is_text = [&] {
    for (const Property& value : p.values())
      if (value.name == name) return std::holds_alternative<std::string>(value.value);
    return true;
  };
  if (!is_text()) return p.positive_number(name, 1);
  const std::string material = p.string(name, fallback);
  std::vector<std::string> known;
  for (const NamedIndex& entry : kIndices) {
    if (entry.name == material) return entry.value;
    known.push_back(entry.name);
  }
  p.fail(name, "no index of refraction is known for " + quote(material) +
                   suggestion(material, known) + "; known: " + listed(known));
}

}  // namespace fogbow
