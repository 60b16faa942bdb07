// SPDX-License-Identifier: GPL-3.0-or-later
// The only file outside the tests that includes ceres.h: its headers leak macros and cost seconds.
#include <ceres/ceres.h>

#include <array>
#include <stdexcept>
#include <vector>

#include "media/media.h"
#include "media/phase_fit.h"

namespace fogbow {

namespace {

/// ln f_p at one angle.
struct Sample {
  double one_minus_cos, log_value;
};

/// Midpoints of quarter degrees: uniform in θ, so that bow and glory weigh as much as the peak.
std::vector<Sample> samples_of(const PhaseFunction& original) {
  constexpr int kAngles = 720;
  std::vector<Sample> samples;
  for (int i = 0; i < kAngles; ++i) {
    const double theta = kPi * (i + 0.5) / kAngles;
    const double value =
        original.pdf_sigma(Vec3(0, 0, 1), Vec3(std::sin(theta), 0, -std::cos(theta)));
    if (!(value > 0))
      throw std::domain_error("a phase function that is zero at some angle cannot be fitted");
    samples.push_back({2 * sqr(std::sin(0.5 * theta)), std::log(value)});
  }
  return samples;
}

/// ln(fit/original). The formulas stand here once more, for ceres::Jet; phase_fit_test compares
/// them with the phase functions.
struct Residual {
  Sample sample;

  template <class T>
  bool operator()(const T* g_hg, const T* g_draine, const T* alpha, const T* weight,
                  T* residual) const {
    const auto henyey_greenstein = [this](const T& g) {
      const T base = (1.0 - g) * (1.0 - g) + 2.0 * g * sample.one_minus_cos;
      return 0.25 * kInvPi * (1.0 - g) * (1.0 + g) / (base * sqrt(base));
    };
    const double square = sqr(1 - sample.one_minus_cos);
    const T g = *g_draine;
    const T draine =
        henyey_greenstein(g) * (1.0 + *alpha * square) / (1.0 + *alpha * (1.0 + 2.0 * g * g) / 3.0);
    *residual =
        log((1.0 - *weight) * henyey_greenstein(*g_hg) + *weight * draine) - sample.log_value;
    return true;
  }
};

struct Parameters {
  double g_hg, g_draine, alpha, weight;
};

/// Improves `p`; Henyey–Greenstein alone if the weight of Draine's part is 0. Returns the rms
/// error.
double minimize(const std::vector<Sample>& samples, Parameters& p) {
  ceres::Problem problem;
  for (const Sample& sample : samples)
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Residual, 1, 1, 1, 1, 1>(new Residual{sample}), nullptr,
        &p.g_hg, &p.g_draine, &p.alpha, &p.weight);
  const auto bound = [&problem](double& parameter, double lo, double hi) {
    problem.SetParameterLowerBound(&parameter, 0, lo);
    problem.SetParameterUpperBound(&parameter, 0, hi);
  };
  bound(p.g_hg, -0.9999, 0.9999);
  if (p.weight == 0) {
    for (double* fixed : {&p.g_draine, &p.alpha, &p.weight})
      problem.SetParameterBlockConstant(fixed);
  } else {
    bound(p.g_draine, -0.9999, 0.9999);
    bound(p.alpha, 0, 1000);
    bound(p.weight, 0, 1);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 300;
  options.function_tolerance = 1e-12;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return std::sqrt(2 * summary.final_cost / static_cast<double>(samples.size()));
}

}  // namespace

PhaseFit fit_phase(const PhaseFunction& original) {
  const std::vector<Sample> samples = samples_of(original);
  Parameters alone{original.mean_cosine(), 0, 0, 0};
  PhaseFit best{};
  best.hg_error = minimize(samples, alone);
  best.hg_alone = alone.g_hg;
  best.error = kInfinity;
  // There are local minima: from several starts, always the same.
  for (const double g_hg : {0.5, 0.95, 0.99})
    for (const double g_draine : {0.0, 0.5, 0.8})
      for (const double alpha : {1.0, 20.0}) {
        Parameters p{g_hg, g_draine, alpha, 0.5};
        const double error = minimize(samples, p);
        if (error < best.error) {
          best.error = error;
          best.g_hg = p.g_hg;
          best.g_draine = p.g_draine;
          best.alpha = p.alpha;
          best.weight = p.weight;
        }
      }
  return best;
}

std::shared_ptr<const PhaseFunction> make_fitted_phase(const PhaseFit& fit) {
  return make_blend_phase(make_henyey_greenstein(fit.g_hg), make_draine(fit.g_draine, fit.alpha),
                          fit.weight);
}

}  // namespace fogbow
