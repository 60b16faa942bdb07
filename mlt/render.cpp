// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/render.h"

#include <chrono>
#include <ctime>
#include <sstream>

#include "core/estimators/sampling.h"
#include "core/util/parallel.h"
#include "mlt/chain_ensemble.h"
#include "mlt/diagnostics.h"
#include "mlt/mutations/primary_sample_mutations.h"
#include "mlt/render_settings.h"

namespace fogbow {

namespace {

/// Fraction bits of the chains' film: an expected-value splat is of the order of one.
constexpr int kChainFilmExponent = -36;
/// Fraction bits of the other films below the mean luminance.
constexpr int kRadianceFractionBits = 30;
/// Standard error of b between groups, relative to b, above which the groups are said to disagree:
/// the picture's brightness is then anyone's guess.
constexpr double kDisagreement = 0.1;
/// Path lengths that carry less of the light are left out of the verdict on convergence.
constexpr double kNotableShare = 0.01;
/// Steps of every chain between two looks at the clock.
constexpr std::uint64_t kStepsPerRound = 64;

/// Time, targets and the calls to whoever watches.
class Session {
 public:
  Session(const RenderOptions& options, double default_samples_per_pixel, std::uint64_t pixels)
      : options_(options), pixels_(static_cast<double>(pixels)) {
    if (options.samples_per_pixel)
      target_ = *options.samples_per_pixel * pixels_;
    else if (!options.seconds)
      target_ = default_samples_per_pixel * pixels_;
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  static double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }
  double cpu_since_start() const { return cpu_seconds() - cpu_start_; }
  std::uint64_t rays_since_start() const { return rays_traced() - rays_start_; }

  /// Samples to make in all; 2⁶³ where only time counts.
  std::uint64_t target() const {
    return target_ > 0 ? static_cast<std::uint64_t>(std::llround(target_)) : std::uint64_t{1} << 63;
  }
  bool interrupted() const { return options_.stop && *options_.stop; }
  bool out_of_time() const { return options_.seconds && seconds() >= *options_.seconds; }

  void begin_rendering() { render_start_ = seconds(); }
  double render_seconds() const { return seconds() - render_start_; }

  template <class Develop>
  void report(std::uint64_t samples, double b, double b_stderr, Develop&& develop) {
    if (options_.on_progress) {
      RenderProgress p;
      p.stage = "render";
      p.seconds = seconds();
      p.samples_per_pixel = static_cast<double>(samples) / pixels_;
      p.samples_per_second = static_cast<double>(samples) / std::fmax(render_seconds(), 1e-9);
      p.b = b;
      p.b_stderr = b_stderr;
      if (target_ > 0) p.fraction = static_cast<double>(samples) / target_;
      if (options_.seconds) p.fraction = std::fmax(p.fraction, p.seconds / *options_.seconds);
      p.fraction = std::fmin(p.fraction, 1.0);
      options_.on_progress(p);
    }
    const bool due =
        options_.picture_interval > 0 && seconds() - last_picture_ >= options_.picture_interval;
    if (options_.on_picture && (due || (options_.save_now && *options_.save_now))) {
      options_.on_picture(develop());
      last_picture_ = seconds();
    }
  }

  void announce(const char* stage) const {
    if (!options_.on_progress) return;
    RenderProgress p;
    p.stage = stage;
    p.seconds = seconds();
    options_.on_progress(p);
  }

 private:
  const RenderOptions& options_;
  double pixels_, target_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  double cpu_start_ = cpu_seconds();
  std::uint64_t rays_start_ = rays_traced();
  double render_start_ = 0, last_picture_ = 0;
};

std::unique_ptr<Estimator> make_estimator(const Scene& scene, const RenderSettings& settings) {
  EstimatorSettings s;
  s.max_depth = settings.max_depth;
  s.rr_depth = settings.rr_depth;
  if (settings.integrator == "path") return make_path_tracer(scene, s);
  if (settings.integrator == "light") return make_light_tracer(scene, s);
  return make_bdpt(scene, s);
}

/// Mean luminance by path length from sums per group; group g's sums times scale[g] estimate it.
std::vector<ClassShare> shares(const LengthTally& tally,
                               const std::array<double, Film::kGroups>& scale) {
  std::size_t longest = 0;
  for (const auto& sums : tally) longest = std::max(longest, sums.size());
  std::vector<ClassShare> result;
  for (std::size_t k = 0; k < longest; ++k) {
    std::array<double, Film::kGroups> groups{};
    for (int g = 0; g < Film::kGroups; ++g)
      if (k < tally[g].size()) groups[g] = tally[g][k] * scale[g];
    const ReplicateMean m = replicate_mean(groups);
    if (m.mean > 0) result.push_back({static_cast<int>(k), m.mean, m.standard_error});
  }
  return result;
}

ReplicateMean total(const LengthTally& tally, const std::array<double, Film::kGroups>& scale) {
  std::array<double, Film::kGroups> groups{};
  for (int g = 0; g < Film::kGroups; ++g)
    for (const double sum : tally[g]) groups[g] += sum * scale[g];
  return replicate_mean(groups);
}

void finish(RenderResult& result, const Session& session, const RenderSettings& settings) {
  result.integrator = settings.integrator;
  result.groups = Film::kGroups;
  result.seconds = session.seconds();
  result.render_seconds = session.render_seconds();
  result.cpu_seconds = session.cpu_since_start();
  result.rays = session.rays_since_start();
  result.notes.insert(result.notes.begin(), settings.notes.begin(), settings.notes.end());
  if (!settings.depth_capped || result.lengths.empty()) return;
  const ClassShare& last = result.lengths.back();
  const double cut = last.k == settings.max_depth + 1 ? last.value : 0;
  std::ostringstream note;
  note << "the scene sets no max_depth: paths are cut at " << settings.max_depth
       << " edges; the longest kept carry " << (result.b > 0 ? 100 * cut / result.b : 0)
       << "% of the light";
  result.notes.push_back(note.str());
}

RenderResult render_independent(const Scene& scene, const RenderOptions& options,
                                const RenderSettings& settings, Session& session) {
  const auto estimator = make_estimator(scene, settings);
  session.announce("bootstrap");
  const int exponent = luminance_exponent(*estimator, options.seed) - kRadianceFractionBits;
  IndependentSampling sampling(*estimator, scene.film(), options.seed, exponent);
  session.begin_rendering();
  std::array<double, Film::kGroups> scale{};
  do {
    sampling.run_round();
    scale.fill(Film::kGroups / static_cast<double>(sampling.samples()));
    const ReplicateMean b = total(sampling.tally(), scale);
    session.report(sampling.samples(), b.mean, b.standard_error,
                   [&] { return sampling.develop(); });
  } while (sampling.samples() < session.target() && !session.out_of_time() &&
           !session.interrupted());

  RenderResult result;
  result.interrupted = session.interrupted() && sampling.samples() < session.target();
  result.image = sampling.develop();
  const ReplicateMean b = total(sampling.tally(), scale);
  result.b = b.mean;
  result.b_stderr = b.standard_error;
  result.samples = sampling.samples();
  result.non_finite = sampling.refused();
  result.lengths = shares(sampling.tally(), scale);
  return result;
}

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

  /// Bootstrap and large steps together: consistent [mutations of the design: section 7].
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

  std::array<double, Film::kGroups> group_scale(const Normalization& n) const {
    const auto steps = group_steps();
    std::array<double, Film::kGroups> scale{};
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
  result.lengths = shares(r.tally(), r.group_scale(n));
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

bool uses_chains(const RenderSettings& settings) { return settings.integrator == "pssmlt"; }

}  // namespace

RenderResult render(const Scene& scene, const RenderOptions& options) {
  const RenderSettings settings = read_render_settings(scene, options);
  const ThreadLimit limit(options.threads);
  const auto [width, height] = rendered_size(scene.film());
  Session session(options, settings.samples_per_pixel, static_cast<std::uint64_t>(width) * height);
  RenderResult result = uses_chains(settings)
                            ? render_chains(scene, options, settings, session)
                            : render_independent(scene, options, settings, session);
  finish(result, session, settings);
  return result;
}

std::string replay(const Scene& scene, const RenderOptions& options, std::uint64_t seed,
                   std::uint64_t chain, std::uint64_t step) {
  const RenderSettings settings = read_render_settings(scene, options);
  if (!uses_chains(settings))
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

std::map<std::string, std::size_t> render_memory(const Scene& scene, const RenderOptions& options) {
  const RenderSettings settings = read_render_settings(scene, options);
  std::map<std::string, std::size_t> parts;
  parts["acceleration"] = scene.accel().memory_bytes();
  parts["film"] = Film::memory_bytes(scene.film());
  const auto depth = static_cast<std::size_t>(settings.max_depth);
  const std::size_t workspace = 2 * depth * sizeof(SubpathVertex);
  if (uses_chains(settings)) {
    const std::size_t primary_samples = 12 * depth * sizeof(double);
    const std::size_t chain = 2 * (workspace + primary_samples);
    parts["chains"] = Film::kGroups * static_cast<std::size_t>(settings.chains_per_group) * chain;
    parts["bootstrap"] = static_cast<std::size_t>(settings.bootstrap_samples) * sizeof(double);
  } else {
    parts["workspaces"] = static_cast<std::size_t>(hardware_threads()) * workspace;
  }
  return parts;
}

}  // namespace fogbow
