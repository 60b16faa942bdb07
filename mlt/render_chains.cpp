// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <map>
#include <ostream>
#include <sstream>

#include "mlt/bootstrap.h"
#include "mlt/chain_ensemble.h"
#include "mlt/diagnostics.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "mlt/pilot.h"
#include "mlt/registry.h"
#include "mlt/render_parts.h"
#include "mlt/seen_light_picture.h"
#include "mlt/technique_distribution.h"

namespace fogbow {

namespace {

/// One count of the chains' film is 2 to this: expected-value splats are of the order of one over
/// the importance, and all of a long render may fall on one pixel.
int chain_film_exponent(const PictureImportance& importance) {
  constexpr int kFractionBits = 32;
  return std::ilogb(1 / importance.least()) - kFractionBits;
}

/// Path lengths that carry less of the light are left out of the verdict on convergence.
constexpr double kNotableShare = 0.01;
/// Samples of the bootstrap for one of the pilot.
constexpr int kSamplesPerPilot = 4;
/// Of the bootstrap: where a few samples hold all the light that was found, most was not.
constexpr double kEffectiveSamples = 128;
/// Steps of every chain between two looks at the clock.
constexpr std::uint64_t kStepsPerRound = 32;

double aspect(const FilmSettings& film) {
  const auto [width, height] = rendered_size(film);
  return static_cast<double>(width) / height;
}

std::ostream& operator<<(std::ostream& out, const Vec2& v) {
  return out << '(' << v.x << ", " << v.y << ')';
}
std::ostream& operator<<(std::ostream& out, const Vec3& v) {
  return out << '(' << v.x << ", " << v.y << ", " << v.z << ')';
}

/// Where a chain may start. The first attempts of a group's chains are one systematic sample of its
/// bootstrap: no part of the light gets more or fewer chains than its due by chance. Further ones
/// are drawn from all of it, so that refusals, too, shift nothing between the parts.
struct StartOfChain {
  const Bootstrap& bootstrap;
  std::uint64_t seed;
  int chains_per_group;
  std::uint64_t chain;

  PrimarySample operator()(std::uint64_t attempt) const {
    const int group = static_cast<int>(chain % Film::kGroups);
    if (attempt > 0)
      return bootstrap.start(group, Rng(seed, RngDomain::WarmUp, chain, 4 * attempt).uniform());
    Rng offset(seed, RngDomain::WarmUp, static_cast<std::uint64_t>(group), 1);
    const auto rank = static_cast<double>(chain / Film::kGroups);
    return bootstrap.start(group, (rank + offset.uniform()) / chains_per_group);
  }
};

/// What the chains of an integrator are made of; starts and readers of saved states.
struct PrimarySampleChains {
  using State = PrimarySample;
  MutationTable<State> table;

  PrimarySampleChains(const Scene&, const RenderSettings& settings, const Estimator& estimator,
                      const Pilot&)
      : table(make_primary_sample_mutations(estimator, settings.large_step_probability)) {}
  double weight(const Mutation<State>& mutation) const {
    return mutation.selection_weight(State());
  }
  State start(const StartOfChain& start) const { return start(0); }
  /// log f*/p of the state that a chain would start from if the bootstrap gave it `x`.
  double log_ratio(const PrimarySample& x, double) const { return x.log_f_star(); }
};

struct PathChains {
  using State = PathSample;
  static constexpr std::uint64_t kMostAttempts = 1000;
  const Scene& scene;
  int max_vertices;
  MutationWeights weights;
  TechniqueDistribution techniques;
  MutationTable<State> table;

  PathChains(const Scene& s, const RenderSettings& settings, const Estimator&, const Pilot& pilot)
      : scene(s),
        max_vertices(settings.max_depth + 1),
        weights(settings.mutations),
        techniques(pilot.techniques, max_vertices),
        table(make_path_mutations(settings.mutations, techniques, max_vertices)) {}
  double weight(const Mutation<State>& mutation) const { return weights.at(mutation.name()); }
  State start(const StartOfChain& start) const {
    for (std::uint64_t attempt = 0;; ++attempt) {
      Rng rng(start.seed, RngDomain::WarmUp, start.chain, 4 * attempt + 2);
      auto x = PathSample::choose(scene, max_vertices, start(attempt), rng.uniform());
      if (x) return *std::move(x);
      FOGBOW_CHECK(attempt < kMostAttempts);
    }
  }
  double log_ratio(const PrimarySample& x, double u) const {
    const auto state = PathSample::choose(scene, max_vertices, x, u);
    return state ? state->log_f_star() - log_large_step_density(*state, techniques)
                 : -std::numeric_limits<double>::infinity();
  }
};

/// Everything a render by chains holds.
template <class Chains>
struct ChainRender {
  using State = typename Chains::State;
  std::unique_ptr<Estimator> estimator;
  Pilot pilot;
  Chains chains;
  Bridge bridge;
  Bootstrap bootstrap;
  ChainEnsemble<State> ensemble;

  ChainRender(const Scene& scene, const RenderSettings& settings, std::uint64_t seed)
      : estimator(make_estimator(scene, settings)),
        pilot(run_pilot(*estimator, aspect(scene.film()), seed,
                        settings.bootstrap_samples / kSamplesPerPilot,
                        kEffectiveSamples / kSamplesPerPilot)),
        chains(scene, settings, *estimator, pilot),
        bridge(pilot.f_star),
        bootstrap(
            *estimator, seed, std::max(1, settings.bootstrap_samples / Film::kGroups),
            settings.two_stage ? pilot.importance : kUniformImportance,
            [this](const PrimarySample& x, double u) { return bridge(chains.log_ratio(x, u)); },
            kEffectiveSamples),
        ensemble(
            chains.table, seed, settings.chains_per_group,
            [this, seed, n = settings.chains_per_group](int, std::uint64_t chain) {
              return chains.start({bootstrap, seed, n, chain});
            },
            bridge) {}

  /// Bootstrap and large steps together: consistent.
  Normalization normalization() const {
    Normalization n = bootstrap.normalization();
    for (std::size_t i = 0; i < ensemble.size(); ++i)
      n.add(ensemble.group_of(i), ensemble.record(i).bridge);
    return n;
  }

  PictureScale scale() const {
    const Normalization n = normalization();
    std::array<std::uint64_t, Film::kGroups> steps{};
    for (std::size_t i = 0; i < ensemble.size(); ++i)
      steps[ensemble.group_of(i)] += ensemble.chain(i).steps();
    PictureScale scale{n.b() / static_cast<double>(ensemble.total_steps()), {}};
    for (int g = 0; g < Film::kGroups; ++g)
      if (steps[g] > 0) scale.group[g] = n.b(g) / static_cast<double>(steps[g]);
    return scale;
  }

  Image develop(const Film& film) const {
    const PictureScale s = scale();
    return film.develop(s.all, {s.group.begin(), s.group.end()});
  }

  LengthTally tally() const {
    LengthTally result;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      auto& sums = result[ensemble.group_of(i)];
      const auto& share = ensemble.record(i).length_share;
      if (sums.size() < share.size()) sums.resize(share.size());
      for (std::size_t k = 0; k < share.size(); ++k) sums[k] += share[k];
    }
    return result;
  }

  /// Of the picture.
  ReplicateMean luminance() const { return total_luminance(tally(), scale()); }

  /// Of the share of one path length, over all chains.
  Convergence length_convergence(int k) const {
    std::vector<ChainMoments> moments(ensemble.size());
    std::vector<double> steps(ensemble.size());
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      const ChainRecord& r = ensemble.record(i);
      if (static_cast<std::size_t>(k) < r.length_share.size())
        moments[i] = {r.length_share[k], r.length_squares[k]};
      steps[i] = static_cast<double>(ensemble.chain(i).steps());
    }
    return convergence(moments, steps);
  }

  /// b_k^c of all classes, from the largest.
  std::vector<ClassShare> class_shares() const {
    const PictureScale scale = this->scale();
    std::map<PathClass, std::array<double, Film::kGroups>> groups;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      std::map<PathClass, double> sums;
      ensemble.record(i).classes.add_to(sums);
      const int g = ensemble.group_of(i);
      for (const auto& [c, share] : sums) groups[c][g] += share;
    }
    std::vector<ClassShare> result;
    for (const auto& [c, values] : groups) {
      const ReplicateMean m = scale(values);
      result.push_back({c.k, m.mean, m.standard_error, configuration_text(c)});
    }
    std::ranges::stable_sort(result, std::greater(), &ClassShare::value);
    return result;
  }

  std::vector<MutationReport> reports() const {
    std::vector<MutationCounts> sums(chains.table.size());
    double seconds = 0;  // of all steps, by those that were timed
    for (std::size_t m = 0; m < sums.size(); ++m) {
      for (std::size_t i = 0; i < ensemble.size(); ++i) sums[m].add(ensemble.chain(i).counts()[m]);
      seconds += sums[m].seconds;
    }
    std::vector<MutationReport> result;
    for (std::size_t m = 0; m < sums.size(); ++m) {
      MutationReport report = describe(*chains.table[m], sums[m]);
      report.weight = chains.weight(*chains.table[m]);
      if (seconds > 0) report.time_share = sums[m].seconds / seconds;
      result.push_back(std::move(report));
    }
    return result;
  }

 private:
  static MutationReport describe(const Mutation<State>& mutation, const MutationCounts& sum) {
    MutationReport report;
    report.name = mutation.name();
    report.proposed = sum.proposed;
    report.accepted = sum.accepted;
    for (std::size_t r = 0; r < sum.rejected.size(); ++r)
      if (sum.rejected[r] > 0) report.rejected[std::string(kRejectionNames[r])] = sum.rejected[r];
    if (sum.proposed > 0)
      report.mean_squared_jump = sum.squared_jump / static_cast<double>(sum.proposed);
    if (sum.timed > 0) report.seconds_per_proposal = sum.seconds / static_cast<double>(sum.timed);
    const auto kinds = mutation.kinds();
    for (std::size_t i = 0; i < kinds.size(); ++i)
      report.kinds.push_back({std::string(kinds[i]), sum.proposed_kind[i], sum.accepted_kind[i]});
    return report;
  }
};

/// R̂ and effective sample size of each notable path length, and the worst of them.
template <class Render>
void diagnose(const Render& r, double render_seconds, RenderResult& result) {
  double r_hat = 0, ess = std::numeric_limits<double>::infinity();
  for (const ClassShare& length : result.lengths) {
    if (length.value < kNotableShare * result.b) continue;
    const Convergence c = r.length_convergence(length.k);
    const std::string suffix = "_k" + std::to_string(length.k);
    result.diagnostics["R_hat" + suffix] = c.r_hat;
    result.diagnostics["ess" + suffix] = c.effective_samples;
    r_hat = std::max(r_hat, c.r_hat);
    ess = std::min(ess, c.effective_samples);
  }
  if (r_hat == 0) return;
  result.diagnostics["R_hat"] = r_hat;
  result.diagnostics["ess"] = ess;
  result.diagnostics["ess_per_second"] = ess / std::max(render_seconds, 1e-9);
}

template <class Chains>
RenderResult render_by(const Scene& scene, const RenderOptions& options,
                       const RenderSettings& settings, Session& session) {
  session.announce("bootstrap");
  ChainRender<Chains> r(scene, settings, options.seed);
  Film film(scene.film(), chain_film_exponent(r.pilot.importance));
  SeenLightPicture seen(scene, settings, options.seed, r.pilot.f_star);
  session.begin_rendering();

  const std::uint64_t chains = r.ensemble.size();
  const std::uint64_t target = session.target();
  std::uint64_t round = 0;
  do {
    ++round;
    r.ensemble.run(
        [&](std::size_t i) {
          const std::uint64_t share = target / chains + (i < target % chains ? 1 : 0);
          return std::min(share, round * kStepsPerRound);
        },
        film);
    seen.keep_up(r.ensemble.total_steps());
    const ReplicateMean b = r.luminance(), directly = seen.luminance();
    session.report(r.ensemble.total_steps(), b.mean + directly.mean,
                   std::hypot(b.standard_error, directly.standard_error),
                   [&] { return seen.add_to(r.develop(film)); });
  } while (r.ensemble.total_steps() < target && !session.out_of_time() && !session.interrupted());
  r.ensemble.finish(film);

  RenderResult result;
  result.interrupted = session.interrupted() && r.ensemble.total_steps() < target;
  const Normalization n = r.normalization();
  result.image = r.develop(film);
  const ReplicateMean b = r.luminance();
  result.b = b.mean;
  result.b_stderr = b.standard_error;
  result.samples = r.ensemble.total_steps();
  result.chains = static_cast<int>(chains);
  result.lengths = length_shares(r.tally(), r.scale());
  result.classes = r.class_shares();
  result.mutations = r.reports();
  result.groups_disagree = n.standard_error() > kDisagreement * n.b();
  result.diagnostics["normalization_chi2"] = n.disagreement();
  result.diagnostics["normalization_samples"] = static_cast<double>(n.samples());
  diagnose(r, session.render_seconds(), result);
  result.non_finite = film.refused();
  for (const MutationReport& m : result.mutations)
    if (const auto it = m.rejected.find("non-finite"); it != m.rejected.end())
      result.non_finite += it->second;
  seen.add_to(result);
  return result;
}

void print_state(std::ostream& out, const char* title, const PrimarySample& x) {
  out << title << ": log f* = " << x.log_f_star() << ", " << x.light().size() << " + "
      << x.eye().size() << " primary samples of light and eye\n";
  for (const Contribution& c : x.contributions())
    out << "  k=" << c.k << " s=" << c.s << " t=" << c.t << " raster=" << c.raster
        << " value=" << c.value << "\n";
}

void print_state(std::ostream& out, const char* title, const PathSample& x) {
  static constexpr const char* kKinds[] = {"surface",        "medium", "point light",
                                           "infinite light", "sensor", "parallel sensor"};
  const MeasuredPath& path = x.path();
  out << title << ": log f* = " << x.log_f_star() << ", k=" << path.size()
      << " raster=" << x.raster() << "\n";
  for (int i = 0; i < path.size(); ++i) {
    out << "  x" << i + 1 << ' ' << kKinds[static_cast<int>(path[i].kind)]
        << (path[i].degenerate ? " degenerate" : "") << " at " << path[i].position()
        << " f_hat=" << path.scattering(i).f_hat;
    if (i < path.last()) out << " tau=" << path.edge(i).tau << " length=" << path.edge(i).length;
    out << "\n";
  }
}

template <class Chains>
std::string replay_by(const Scene& scene, const RenderSettings& settings, std::uint64_t seed,
                      std::uint64_t chain, std::uint64_t step) {
  ChainRender<Chains> r(scene, settings, seed);
  Film film(scene.film(), chain_film_exponent(r.pilot.importance));
  SplatQueue unseen(film);
  while (r.ensemble.chain(chain).steps() < step) r.ensemble.step(chain, unseen);

  std::ostringstream out;
  out.precision(17);
  print_state(out, "current", r.ensemble.chain(chain).state());
  const StepInfo info = r.ensemble.step(chain, unseen);
  const auto& c = r.ensemble.chain(chain);
  // A refused proposal may be half written.
  if (!info.proposal.rejection)
    print_state(out, "proposal", info.accepted ? c.state() : c.proposed());
  out << "mutation " << r.chains.table[info.mutation]->name() << ": log ratio "
      << info.proposal.log_ratio << ", pi " << info.selection_x << " -> " << info.selection_y
      << ", log f* " << info.log_f_star_x << " -> " << info.log_f_star_y << ", a = " << info.a
      << (info.accepted ? ", accepted" : ", not accepted");
  if (info.proposal.rejection)
    out << ", refused: " << kRejectionNames[static_cast<std::size_t>(*info.proposal.rejection)];
  out << "\n";
  return out.str();
}

}  // namespace

RenderResult render_chains(const Scene& scene, const RenderOptions& options,
                           const RenderSettings& settings, Session& session) {
  try {
    return settings.integrator == "mlt"
               ? render_by<PathChains>(scene, options, settings, session)
               : render_by<PrimarySampleChains>(scene, options, settings, session);
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::NoLight) throw;
  }
  // Perhaps there is seen light alone, which chains leave out.
  RenderSettings without_chains = settings;
  without_chains.integrator = "bdpt";
  RenderResult result = render_independent(scene, options, without_chains, session);
  result.notes.push_back(
      "all light that was found is seen directly or through specular surfaces: sampled without "
      "chains");
  return result;
}

std::string replay(const Scene& scene, const RenderOptions& options, std::uint64_t seed,
                   std::uint64_t chain, std::uint64_t step) {
  const RenderSettings settings = read_render_settings(scene, options);
  if (!settings.uses_chains())
    throw Error(ErrorKind::Usage,
                "--replay needs an integrator of chains, not \"" + settings.integrator + "\"");
  const auto chains = static_cast<std::uint64_t>(settings.chains_per_group) * Film::kGroups;
  if (chain >= chains)
    throw Error(ErrorKind::Usage, "there is no chain " + std::to_string(chain) +
                                      ": chains are 0 to " + std::to_string(chains - 1));
  return settings.integrator == "mlt"
             ? replay_by<PathChains>(scene, settings, seed, chain, step)
             : replay_by<PrimarySampleChains>(scene, settings, seed, chain, step);
}

}  // namespace fogbow
