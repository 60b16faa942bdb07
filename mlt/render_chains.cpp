// SPDX-License-Identifier: GPL-3.0-or-later
#include <sstream>

#include "mlt/chain_ensemble.h"
#include "mlt/diagnostics.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "mlt/render_parts.h"

namespace fogbow {

namespace {

/// Fraction bits of the chains' film: an expected-value splat is of the order of one.
constexpr int kChainFilmExponent = -36;
/// Standard error of b between groups, relative to b, above which the groups are said to disagree:
/// the picture's brightness is then anyone's guess.
constexpr double kDisagreement = 0.1;
/// Path lengths that carry less of the light are left out of the verdict on convergence.
constexpr double kNotableShare = 0.01;
/// Steps of every chain between two looks at the clock.
constexpr std::uint64_t kStepsPerRound = 64;

/// Everything a render by chains of primary samples holds.
struct ChainRender {
  std::unique_ptr<Estimator> estimator;
  MutationTable<PrimarySample> table;
  Bootstrap bootstrap;
  ChainEnsemble<PrimarySample> ensemble;

  ChainRender(const Scene& scene, const RenderSettings& settings, std::uint64_t seed)
      : estimator(make_estimator(scene, settings)),
        table(make_primary_sample_mutations(*estimator, settings.large_step_probability)),
        bootstrap(*estimator, seed, std::max(1, settings.bootstrap_samples / Film::kGroups)),
        ensemble(table, seed, settings.chains_per_group,
                 [this](int group, std::uint64_t chain) { return bootstrap.start(group, chain); }) {
  }

  /// Bootstrap and large steps together: consistent.
  Normalization normalization() const {
    Normalization n = bootstrap.normalization();
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      const ChainRecord& r = ensemble.record(i);
      n.add(ensemble.group_of(i), r.independent_f_star, r.independent_squares, r.independent_steps);
    }
    return n;
  }

  std::array<std::uint64_t, Film::kGroups> group_steps() const {
    std::array<std::uint64_t, Film::kGroups> steps{};
    for (std::size_t i = 0; i < ensemble.size(); ++i)
      steps[ensemble.group_of(i)] += ensemble.chain(i).steps();
    return steps;
  }

  GroupScale group_scale(const Normalization& n) const {
    const auto steps = group_steps();
    GroupScale scale{};
    for (int g = 0; g < Film::kGroups; ++g)
      if (steps[g] > 0) scale[g] = n.b(g) / static_cast<double>(steps[g]);
    return scale;
  }

  Image develop(const Film& film) const {
    const Normalization n = normalization();
    const auto scale = group_scale(n);
    return film.develop(n.b() / static_cast<double>(ensemble.total_steps()),
                        {scale.begin(), scale.end()});
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

  /// Of the time share of one path length, over all chains.
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

  std::vector<MutationReport> reports() const {
    std::vector<MutationReport> result;
    for (std::size_t m = 0; m < table.size(); ++m) {
      MutationCounts sum;
      for (std::size_t i = 0; i < ensemble.size(); ++i) sum.add(ensemble.chain(i).counts()[m]);
      MutationReport report{table[m]->name(), sum.proposed, sum.accepted, {}};
      for (std::size_t r = 0; r < sum.rejected.size(); ++r)
        if (sum.rejected[r] > 0) report.rejected[std::string(kRejectionNames[r])] = sum.rejected[r];
      result.push_back(std::move(report));
    }
    return result;
  }
};

/// R̂ and effective sample size of each notable path length, and the worst of them.
void diagnose(const ChainRender& r, double render_seconds, RenderResult& result) {
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
  result.diagnostics["ess_per_second"] = ess / std::fmax(render_seconds, 1e-9);
}

}  // namespace

RenderResult render_chains(const Scene& scene, const RenderOptions& options,
                           const RenderSettings& settings, Session& session) {
  session.announce("bootstrap");
  ChainRender r(scene, settings, options.seed);
  Film film(scene.film(), kChainFilmExponent);
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
    const Normalization n = r.normalization();
    session.report(r.ensemble.total_steps(), n.b(), n.standard_error(),
                   [&] { return r.develop(film); });
  } while (r.ensemble.total_steps() < target && !session.out_of_time() && !session.interrupted());
  r.ensemble.finish(film);

  RenderResult result;
  result.interrupted = session.interrupted() && r.ensemble.total_steps() < target;
  const Normalization n = r.normalization();
  result.image = r.develop(film);
  result.b = n.b();
  result.b_stderr = n.standard_error();
  result.samples = r.ensemble.total_steps();
  result.chains = static_cast<int>(chains);
  result.lengths = length_shares(r.tally(), r.group_scale(n));
  result.mutations = r.reports();
  result.groups_disagree = n.standard_error() > kDisagreement * n.b();
  result.diagnostics["normalization_chi2"] = n.disagreement();
  result.diagnostics["normalization_samples"] = static_cast<double>(n.samples());
  diagnose(r, session.render_seconds(), result);
  result.non_finite = film.refused();
  for (const MutationReport& m : result.mutations)
    if (const auto it = m.rejected.find("non-finite"); it != m.rejected.end())
      result.non_finite += it->second;
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
  ChainRender r(scene, settings, seed);
  Film film(scene.film(), kChainFilmExponent);
  while (r.ensemble.chain(chain).steps() < step) r.ensemble.step(chain, film);

  std::ostringstream out;
  out.precision(17);
  const auto print_state = [&](const char* title, const PrimarySample& x) {
    out << title << ": f* = " << x.f_star() << ", " << x.light().size() << " + " << x.eye().size()
        << " primary samples of light and eye\n";
    for (const Contribution& c : x.contributions())
      out << "  k=" << c.k << " s=" << c.s << " t=" << c.t << " raster=(" << c.raster.x << ", "
          << c.raster.y << ") value=(" << c.value.x << ", " << c.value.y << ", " << c.value.z
          << ")\n";
  };
  print_state("current", r.ensemble.chain(chain).state());
  const StepInfo info = r.ensemble.step(chain, film);
  const Chain<PrimarySample>& c = r.ensemble.chain(chain);
  print_state("proposal", info.accepted ? c.state() : c.proposed());
  out << "mutation " << r.table[info.mutation]->name() << ": log ratio " << info.proposal.log_ratio
      << ", pi " << info.selection_x << " -> " << info.selection_y << ", f* " << info.f_star_x
      << " -> " << info.f_star_y << ", a = " << info.a
      << (info.accepted ? ", accepted" : ", not accepted");
  if (info.proposal.rejection)
    out << ", refused: " << kRejectionNames[static_cast<std::size_t>(*info.proposal.rejection)];
  out << "\n";
  return out.str();
}

}  // namespace fogbow
