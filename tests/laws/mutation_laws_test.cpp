// SPDX-License-Identifier: GPL-3.0-or-later
// What every proposal of every mutation owes, whatever it proposes: from paths of all
// configurations of all test scenes.
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "core/geometry/shapes.h"
#include "core/path/techniques.h"
#include "core/scene/bsdf/bsdfs.h"
#include "mlt/mutations/technique_sample.h"
#include "tests/helpers/statistics.h"
#include "tests/laws/naive_proposals.h"
#include "tests/laws/path_population.h"

namespace fogbow::testing {
namespace {

constexpr int kMaxDepth = 7;
constexpr std::uint64_t kSamples = 1 << 14;
constexpr int kPerConfiguration = 24;
/// Finite differences that are known so well can tell right from wrong.
constexpr double kSharp = 1e-2;

/// A scene with its paths, made once for all mutations.
struct Prepared {
  Scene scene;
  PathPopulation population;
  std::vector<PathSample> paths;
  explicit Prepared(const TestScene& test)
      : scene(test.make()),
        population(scene, kMaxDepth, suite_seed()),
        paths(population.of_every_configuration(kSamples, kPerConfiguration)) {}
};

const Prepared& prepared(const TestScene& test) {
  static std::map<std::string, std::unique_ptr<Prepared>> all;
  auto& found = all[test.name];
  if (!found) found = std::make_unique<Prepared>(test);
  return *found;
}

std::vector<std::string> mutation_names() {
  std::vector<std::string> names;
  for (const auto& [name, weight] : default_mutation_weights()) names.push_back(name);
  return names;
}

std::string bytes(const PathSample& x) {
  std::ostringstream out;
  x.serialize(out);
  return out.str();
}

/// The largest error seen, and where.
struct Worst {
  double error = 0;
  std::string where = "nowhere";
  void see(double e, const std::string& at) {
    if (e <= error) return;  // a NaN counts as the worst
    error = std::isnan(e) ? kInfinity : e;
    where = at;
  }
};

double relative(double a, double b) {
  const double size = std::max(std::abs(a), std::abs(b));
  return a == b ? 0 : std::abs(a - b) / size;
}
/// Components in parts of the largest.
double relative(const Vec3& a, const Vec3& b) {
  const double size = std::max(max_component(glm::abs(a)), max_component(glm::abs(b)));
  return a == b ? 0 : max_component(glm::abs(a - b)) / size;
}

std::string describe(const MeasuredPath& path) {
  std::string kinds;
  for (const Vertex& x : path.vertices())
    kinds += x.degenerate                       ? 's'
             : x.in_medium()                    ? 'V'
             : x.on_sensor()                    ? 'E'
             : x.kind == VertexKind::PointLight ? 'P'
             : x.infinite()                     ? 'I'
                                                : 'D';
  return kinds;
}

/// Whether light runs along a surface: on which side of it rounding decides, and f with it.
bool grazes(const MeasuredPath& path) {
  for (int i = 0; i < path.size(); ++i) {
    if (!path[i].on_surface()) continue;
    const Vec3& n = path[i].point.n_g;
    if (i > 0 && std::abs(dot(n, path.to_light(i))) < 1e-9) return true;
    if (i < path.last() && std::abs(dot(n, path.to_eye(i))) < 1e-9) return true;
  }
  return false;
}

class MutationLaws : public ::testing::TestWithParam<std::tuple<TestScene, std::string>> {
 protected:
  MutationLaws()
      : at_(prepared(std::get<0>(GetParam()))),
        name_(std::get<1>(GetParam())),
        table_(make_path_mutations({{name_, 1.0}}, at_.population.techniques(),
                                   at_.population.max_vertices())) {}

  const Mutation<PathSample>& mutation() const { return *table_[0]; }
  /// From each path; of what is mostly refused more.
  int proposals() const {
    return name_ == "bidirectional" ? 60 : name_ == "large_step" || name_ == "switch" ? 8 : 3;
  }
  /// Whether no path of the scene can be moved in this way: what stops the rays in fog-in-glass is
  /// glass, to which nothing switches.
  bool idle() const {
    if (name_ == "switch" && std::get<0>(GetParam()).name == "fog-in-glass") return true;
    return std::ranges::none_of(
        at_.paths, [&](const PathSample& x) { return mutation().selection_weight(x) > 0; });
  }

  /// visit(x̄, ȳ, proposal), refusals included.
  template <class Visit>
  void for_each_attempt(Visit&& visit) const {
    PathSample y = at_.population.blank();
    for (std::size_t i = 0; i < at_.paths.size(); ++i) {
      if (!(mutation().selection_weight(at_.paths[i]) > 0)) continue;
      for (int j = 0; j < proposals(); ++j) {
        Rng rng(suite_seed(), RngDomain::Chain, i, static_cast<std::uint64_t>(j));
        const Proposal proposal = mutation().propose(at_.paths[i], y, rng);
        visit(at_.paths[i], y, proposal);
      }
    }
  }
  /// Those that a chain would weigh up.
  template <class Visit>
  void for_each_proposal(Visit&& visit) const {
    int n = 0;
    for_each_attempt([&](const PathSample& x, const PathSample& y, const Proposal& proposal) {
      if (proposal.rejection || proposal.log_ratio == -kInfinity || y.log_f_star() == -kInfinity)
        return;  // refused
      if (grazes(y.path())) return;
      ++n;
      visit(x, y, proposal);
    });
    // Every law would hold of none.
    EXPECT_TRUE(n > 0 || idle()) << "nothing is proposed";
  }

  const Prepared& at_;
  std::string name_;
  MutationTable<PathSample> table_;
};

class LocalLaws : public MutationLaws {};
class TechniqueLaws : public MutationLaws {};
class BidirectionalLaws : public MutationLaws {};

TEST_P(MutationLaws, NeverWritesToTheState) {
  PathSample y = at_.population.blank();
  for (std::size_t i = 0; i < at_.paths.size(); ++i) {
    const PathSample& x = at_.paths[i];
    if (!(mutation().selection_weight(x) > 0)) continue;
    const std::string before = bytes(x);
    Rng rng(suite_seed(), RngDomain::Chain, i, 0);
    mutation().propose(x, y, rng);
    ASSERT_EQ(before, bytes(x)) << describe(x.path());
  }
}

TEST_P(MutationLaws, NeverSaysWhatIsNotANumber) {
  for_each_attempt([&](const PathSample& x, const PathSample& y, const Proposal& proposal) {
    EXPECT_FALSE(std::isnan(proposal.log_ratio)) << describe(x.path());
    if (!proposal.rejection) {
      EXPECT_LT(y.log_f_star(), kInfinity) << describe(x.path());
      EXPECT_FALSE(std::isnan(y.log_f_star())) << describe(x.path());
    }
  });
}

/// ȳ's caches against those of a path that is measured anew, and its f against the definition.
/// Directions along what was traced and those between its points differ by rounding; a chain found
/// by a walk ends 1e-9 radii beside the vertex it is joined to, which a glossy lobe, a grazing
/// cosine or a short edge magnify.
TEST_P(MutationLaws, CachesWhatMeasuringAnewFinds) {
  const Scene& scene = at_.scene;
  const double tolerance = name_ == "manifold" || name_ == "switch" ? 1e-6 : 1e-9;
  Worst edges, scattering, value, oracle;
  MeasuredPath anew;
  for_each_proposal([&](const PathSample& x, const PathSample& sample, const Proposal&) {
    const MeasuredPath& y = sample.path();
    const std::string at = describe(x.path()) + " to " + describe(y);
    ASSERT_TRUE(anew.measure(scene, y.vertices())) << at;
    for (int i = 0; i < y.size(); ++i) {
      const Scattering &a = y.scattering(i), &b = anew.scattering(i);
      scattering.see(relative(a.f_hat, b.f_hat), at);
      scattering.see(relative(a.pdf_to_light, b.pdf_to_light), at);
      scattering.see(relative(a.pdf_to_eye, b.pdf_to_eye), at);
      if (i == y.last()) continue;
      edges.see(relative(y.edge(i).w, anew.edge(i).w), at);
      if (std::isfinite(anew.edge(i).length))
        edges.see(relative(y.edge(i).length, anew.edge(i).length), at);
      edges.see(relative(y.edge(i).tau, anew.edge(i).tau), at);
      edges.see(relative(y.edge(i).tau_q, anew.edge(i).tau_q), at);
    }
    PathSample settled = sample;
    settled.path() = anew;
    ASSERT_TRUE(settled.settle()) << at;
    value.see(std::abs(settled.log_f_star() - sample.log_f_star()), at);
    EXPECT_EQ(settled.selection_key(), sample.selection_key()) << at;
    EXPECT_LT(length(settled.raster() - sample.raster()), 1e-9) << at;
    // Below, a product of plain doubles loses its digits.
    if (sample.log_f_star() < -600) return;
    const double f_star = luminance(f(scene, y.vertices())) * sample.importance()(sample.raster());
    oracle.see(std::abs(std::log(f_star) - sample.log_f_star()), at);
  });
  EXPECT_LT(edges.error, tolerance) << edges.where;
  EXPECT_LT(scattering.error, tolerance) << scattering.where;
  EXPECT_LT(value.error, tolerance) << value.where;
  EXPECT_LT(oracle.error, tolerance) << oracle.where;
}

TEST_P(MutationLaws, CanProposeBackAndStaysAmongWhatTechniquesReach) {
  for_each_proposal([&](const PathSample& x, const PathSample& y, const Proposal&) {
    const std::string at = describe(x.path()) + " to " + describe(y.path());
    EXPECT_GT(mutation().selection_weight(y), 0) << at;
    EXPECT_LE(y.path().size(), at_.population.max_vertices()) << at;
    double reached = 0;
    for (int s = 0; s < y.path().size(); ++s)
      reached += technique_density(at_.scene, y.path().vertices(), s);
    EXPECT_GT(reached, 0) << at;
  });
}

/// Only vertices that the definition moves are touched, and the ratio is the definition's.
TEST_P(LocalLaws, MoveAndWeighAsDefined) {
  Worst worst;
  int asked = 0, total = 0;
  for_each_proposal([&](const PathSample& x, const PathSample& y, const Proposal& proposal) {
    const Path &from = x.path().vertices(), &to = y.path().vertices();
    const std::string at = describe(x.path()) + " to " + describe(y.path());
    ASSERT_EQ(from.size(), to.size());
    int first = x.path().size(), last = -1, flips = 0, free = 0;
    for (int i = 0; i < x.path().size(); ++i) {
      EXPECT_EQ(from[i].degenerate, to[i].degenerate) << at;
      flips += from[i].kind != to[i].kind;
      if (same_vertex(from[i], to[i])) continue;
      first = std::min(first, i);
      last = i;
      free += !to[i].degenerate;
    }
    EXPECT_LE(flips, name_ == "propagation" ? 1 : 0 + (name_ == "switch")) << at;
    if (name_ == "switch") {
      EXPECT_EQ(flips, 1) << at;
    }
    // Of walks through glossy vertices no second derivation is here; two_point_test has them.
    if (name_ == "manifold" && free > 1) return;
    double beyond = kInfinity;  // how much of the difference rounding does not explain
    for (const Way& way : ways(name_, at_.scene, from, to)) {
      if (way.first > first || last > way.last) continue;
      const auto [expected, error] = way.log_ratio;
      const bool unknown = !std::isfinite(error);
      beyond = std::min(beyond, unknown ? 0 : std::abs(expected - proposal.log_ratio) - error);
      asked += error < kSharp;
    }
    worst.see(beyond, at);
    ++total;
  });
  EXPECT_LT(worst.error, 1e-6) << worst.where;
  EXPECT_GE(asked, 0.9 * total) << "of too few are the derivatives known";
}

/// p_s where an eye subpath that escapes ends on one of the infinite emitters, chosen uniformly;
/// BDPT takes them all at once.
double chosen_density(const Scene& scene, const Path& path, int s) {
  const auto emitters = static_cast<double>(scene.infinite_emitters().size());
  return technique_density(scene, path, s) / (s == 0 && path[0].infinite() ? emitters : 1.0);
}

/// Σ c_s p_s of x̄ and ȳ, technique by technique.
TEST_P(TechniqueLaws, WeighAllTechniques) {
  const auto log_T = [&](const PathSample& x) {
    const auto chosen = at_.population.techniques().probabilities(x.path().size());
    double sum = 0;
    for (int s = 0; s < x.path().size(); ++s)
      sum += chosen[s] * chosen_density(at_.scene, x.path().vertices(), s);
    return std::log(sum);
  };
  Worst worst;
  for_each_proposal([&](const PathSample& x, const PathSample& y, const Proposal& proposal) {
    const std::string at = describe(x.path()) + " to " + describe(y.path());
    if (mutation().independent()) worst.see(std::abs(proposal.log_density - log_T(y)), at);
    worst.see(std::abs(proposal.log_ratio - (log_T(x) - log_T(y))), at);
  });
  EXPECT_LT(worst.error, 1e-9) << worst.where;
}

/// Every technique that could have made x̄ makes it again, to rounding, from the primary samples
/// that its inverse says; a chain of specular vertices magnifies rounding.
TEST_P(TechniqueLaws, InversesMakeThePathAgain) {
  class Stored final : public SampleStream {
   public:
    explicit Stored(const std::vector<double>& u) : u_(u) {}
    double next() override { return u_.at(i_++); }
    bool at_end() const { return i_ == u_.size(); }

   private:
    const std::vector<double>& u_;
    std::size_t i_ = 0;
  };
  constexpr double kDecided = 1e-6;  // so far from an edge rounding does not decide
  Worst place, value;
  int made = 0, lost = 0;
  PathSample y = at_.population.blank();
  std::vector<double> u;
  for (std::size_t j = 0; j < at_.paths.size(); ++j) {
    const PathSample& x = at_.paths[j];
    const MeasuredPath& path = x.path();
    if (grazes(path)) continue;
    for (int s = 0; s < path.size(); ++s) {
      if (!(technique_density(at_.scene, path.vertices(), s) > 0)) continue;
      const std::string at = describe(path) + ", s = " + std::to_string(s);
      Rng rng(suite_seed(), RngDomain::Test, j, static_cast<std::uint64_t>(s));
      ASSERT_TRUE(invert_technique(at_.scene, path, s, rng, u)) << at;
      for (const double v : u) ASSERT_TRUE(v >= 0 && v < 1) << at << ": " << v;
      Stored stored(u);
      if (sample_technique(s, path.size() - s, stored, y)) {
        ++lost;
        continue;
      }
      ++made;
      EXPECT_TRUE(stored.at_end()) << at;
      EXPECT_EQ(y.selection_key(), x.selection_key()) << at;
      for (int i = 0; i < path.size(); ++i) {
        const Vertex &a = path[i], &b = y.path()[i];
        EXPECT_EQ(a.emitter, b.emitter) << at;
        if (!a.infinite()) place.see(length(a.position() - b.position()) / at_.scene.radius(), at);
      }
      value.see(std::abs(x.log_f_star() - y.log_f_star()), at);
    }
  }
  EXPECT_GT(made, 300);
  EXPECT_LE(lost, made / 1000) << "of " << made;  // at the edge of a triangle, of the film
  EXPECT_LT(place.error, kDecided) << place.where;
  EXPECT_LT(value.error, 1e-4) << value.where;
}

/// What x̄ and ȳ share cancels in Σ p_{s+l}(x̄)/Σ p_{s+l}(ȳ), whole techniques as they are; what
/// remains of the ratio are choices that depend on lengths alone, h(k, deleted, inserted), and it
/// must change its sign with the direction.
TEST_P(BidirectionalLaws, WeighAllSplits) {
  struct Choices {
    double value, most, least;
  };
  std::map<std::array<int, 3>, Choices> h;
  const auto log_T = [&](const PathSample& x, int s, int t) {
    double sum = 0;
    for (int l = s; l <= x.path().size() - t; ++l)
      sum += chosen_density(at_.scene, x.path().vertices(), l);
    return std::log(sum);
  };
  for_each_proposal([&](const PathSample& x, const PathSample& y, const Proposal& proposal) {
    const Path &a = x.path().vertices(), &b = y.path().vertices();
    const int k = x.path().size(), m = y.path().size();
    int s = 0, t = 0;
    const auto same_place = [](const Vertex& v, const Vertex& w) {
      if (v.parallel() || w.parallel()) return v.kind == w.kind && v.point.n_g == w.point.n_g;
      return v.position() == w.position();
    };
    while (s < std::min(k, m) && same_place(a[s], b[s])) ++s;
    while (t < std::min(k, m) - s && same_place(a[k - 1 - t], b[m - 1 - t])) ++t;
    // Ends that are points, or light of one direction, are the same whether or not they were
    // deleted.
    const Sensor& sensor = at_.scene.sensor();
    if (t == 1 && (sensor.dirac_position() || sensor.parallel())) return;
    if (s == 1 && is_dirac(at_.scene.emitter(a[0].emitter).kind())) return;
    if (s == k) return;
    // So is what follows from a specular vertex.
    if (s > 1 && b[s - 2].degenerate) return;
    if (t > 1 && b[m - t + 1].degenerate) return;
    const double rest = proposal.log_ratio - (log_T(x, s, t) - log_T(y, s, t));
    auto [found, added] = h.try_emplace({k, k - s - t, m - s - t}, Choices{rest, rest, rest});
    found->second.most = std::max(found->second.most, rest);
    found->second.least = std::min(found->second.least, rest);
  });
  int both_ways = 0;
  for (const auto& [key, choices] : h) {
    const auto [k, deleted, inserted] = key;
    EXPECT_LT(choices.most - choices.least, 1e-8) << k << ' ' << deleted << ' ' << inserted;
    const auto back = h.find({k - deleted + inserted, inserted, deleted});
    if (back == h.end()) continue;
    both_ways += back->first != key;
    EXPECT_NEAR(choices.value, -back->second.value, 1e-8) << k << ' ' << deleted << ' ' << inserted;
  }
  EXPECT_GE(both_ways, 2);
}

/// log_range_density() of any range, with any weights, against whole techniques.
TEST_P(BidirectionalLaws, RangesArePartsOfTechniques) {
  Worst worst;
  for (std::size_t j = 0; j < at_.paths.size(); ++j) {
    const MeasuredPath& x = at_.paths[j].path();
    Rng rng(suite_seed(), RngDomain::Test, j, 1);
    const int first = static_cast<int>(rng.uniform() * (x.size() + 1));
    const int end = first + static_cast<int>(rng.uniform() * (x.size() + 1 - first));
    std::vector<double> weights(end - first + 1), ones(end - first + 1, 1);
    double some = 0, all = 0;
    for (int l = first; l <= end; ++l) {
      weights[l - first] = rng.uniform();
      const double p = chosen_density(at_.scene, x.vertices(), l);
      some += weights[l - first] * p;
      all += p;
    }
    const double density = log_range_density(at_.scene, x, {first, end}, weights);
    if (all == 0) {
      EXPECT_EQ(density, -kInfinity) << describe(x);
      continue;
    }
    const double ratio = density - log_range_density(at_.scene, x, {first, end}, ones);
    worst.see(std::abs(ratio - std::log(some / all)), describe(x));
    if (first == 0 && end == x.size()) worst.see(std::abs(density - std::log(some)), describe(x));
  }
  EXPECT_LT(worst.error, 1e-9) << worst.where;
}

auto in_all_scenes(const std::vector<std::string>& mutations) {
  return ::testing::Combine(::testing::ValuesIn(test_scenes()), ::testing::ValuesIn(mutations));
}
std::vector<std::string> local_mutations() {
  std::vector<std::string> names = mutation_names();
  for (const char* not_local : {"large_step", "primary_sample", "bidirectional"})
    std::erase(names, not_local);
  return names;
}
std::string case_name(const ::testing::TestParamInfo<MutationLaws::ParamType>& info) {
  return test_name(std::get<0>(info.param)) + "_" + std::get<1>(info.param);
}

/// Glass above a floor of which one half is glossy: what moves from one half to the other has other
/// chains to choose from than before.
SceneDescription half_glossy_floor() {
  SceneDescription d = make_test_scene("glass-sphere-fog");
  Surface& half = d.surfaces.emplace_back();
  half.shape =
      make_rectangle(Transform::translate(Vec3(1.25, -0.99, 0)) *
                     Transform::rotate(Vec3(1, 0, 0), -90) * Transform::scale(Vec3(1.25, 2.5, 1)));
  half.bsdf =
      make_rough_conductor({MicrofacetKind::Ggx, 0.25, 0.25}, RGB(0.2, 0.9, 1.1), RGB(3.9, 2.4, 2));
  return d;
}

/// The law would hold as well if the choices were not counted and never changed.
TEST(ManifoldLaws, MovesOntoWhatIsGlossy) {
  const Scene scene(half_glossy_floor());
  const PathPopulation population(scene, 6, suite_seed());
  const auto table =
      make_path_mutations({{"manifold", 1.0}}, population.techniques(), population.max_vertices());
  int changed = 0;
  PathSample y = population.blank();
  for (const PathSample& x : population.of_every_configuration(kSamples, kPerConfiguration)) {
    if (!(table[0]->selection_weight(x) > 0)) continue;
    for (int j = 0; j < 8; ++j) {
      Rng rng(suite_seed(), RngDomain::Chain, x.selection_key(), static_cast<std::uint64_t>(j));
      if (!table[0]->propose(x, y, rng).rejection)
        changed += x.selection_key() != y.selection_key();
    }
  }
  EXPECT_GT(changed, 20);
}

INSTANTIATE_TEST_SUITE_P(HalfGlossyFloor, LocalLaws,
                         ::testing::Combine(::testing::Values(TestScene{"half-glossy-floor",
                                                                        half_glossy_floor}),
                                            ::testing::Values("manifold")),
                         case_name);
INSTANTIATE_TEST_SUITE_P(All, MutationLaws, in_all_scenes(mutation_names()), case_name);
INSTANTIATE_TEST_SUITE_P(All, LocalLaws, in_all_scenes(local_mutations()), case_name);
INSTANTIATE_TEST_SUITE_P(All, TechniqueLaws, in_all_scenes({"large_step", "primary_sample"}),
                         case_name);
INSTANTIATE_TEST_SUITE_P(All, BidirectionalLaws, in_all_scenes({"bidirectional"}), case_name);

}  // namespace
}  // namespace fogbow::testing
