// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/registry.h"

#include <charconv>
#include <functional>
#include <sstream>

#include "core/util/error.h"

namespace fogbow {

namespace {

struct Entry {
  const char* name;
  double weight;
  std::function<PathMutation(double, const TechniqueDistribution&, int)> make;
};

template <PathMutation (*make)(double)>
PathMutation simple(double weight, const TechniqueDistribution&, int) {
  return make(weight);
}

/// The one list of all mutations. The weights are those that did best at equal time on
/// glass-sphere-fog, door-ajar-fog, pool and caustic-beam (scripts/ablation takes them apart).
const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      {"bidirectional", 1,
       [](double w, const TechniqueDistribution&, int k) { return make_bidirectional(w, k); }},
      {"lens", 24, simple<make_lens>},
      {"caustic", 4, simple<make_caustic>},
      {"multichain", 2, simple<make_multichain>},
      {"scattering", 0.5, simple<make_scattering>},
      {"propagation", 0.6, simple<make_propagation>},
      {"switch", 2, simple<make_switch>},
      {"manifold", 0.1, simple<make_manifold>},
      {"primary_sample", 1,
       [](double w, const TechniqueDistribution& t, int) { return make_primary_sample(w, t); }},
      {"large_step", 0.8,
       [](double w, const TechniqueDistribution& t, int) { return make_large_step(w, t); }},
  };
  return all;
}

std::string names() {
  std::string list;
  for (const Entry& e : entries()) list += (list.empty() ? "" : ", ") + std::string(e.name);
  return list;
}

[[noreturn]] void reject(const std::string& text, const std::string& why) {
  throw Error(ErrorKind::Usage, "integrator property \"mutations\" is \"" + text + "\": " + why);
}

}  // namespace

MutationWeights default_mutation_weights() {
  MutationWeights weights;
  for (const Entry& e : entries()) weights[e.name] = e.weight;
  return weights;
}

MutationWeights parse_mutation_weights(const std::string& text) {
  MutationWeights weights;
  std::istringstream items(text);
  for (std::string item; std::getline(items, item, ',');) {
    const auto colon = item.find(':');
    const std::string name = item.substr(0, colon);
    double weight = 1;
    if (colon != std::string::npos) {
      const char* end = item.data() + item.size();
      const auto [stop, error] = std::from_chars(item.data() + colon + 1, end, weight);
      if (error != std::errc() || stop != end || !(weight >= 0) || !std::isfinite(weight))
        reject(text, "\"" + item + "\" should be name:weight with a weight of at least 0");
    }
    const auto& all = entries();
    if (std::none_of(all.begin(), all.end(), [&](const Entry& e) { return e.name == name; }))
      reject(text, "there is no mutation \"" + name + "\", expected " + names());
    if (!weights.emplace(name, weight).second) reject(text, "\"" + name + "\" is named twice");
  }
  // Only these reach every path from every other.
  if (!(weights["large_step"] > 0) && !(weights["bidirectional"] > 0))
    reject(text, "chains need large_step or bidirectional to reach every path");
  return weights;
}

MutationTable<PathSample> make_path_mutations(const MutationWeights& weights,
                                              const TechniqueDistribution& techniques,
                                              int max_vertices) {
  MutationTable<PathSample> table;
  for (const Entry& e : entries()) {
    const auto found = weights.find(e.name);
    if (found != weights.end() && found->second > 0)
      table.push_back(e.make(found->second, techniques, max_vertices));
  }
  return table;
}

}  // namespace fogbow
