// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/helpers/triples.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <sstream>
#include <vector>

#include "tests/helpers/statistics.h"

namespace fogbow::testing {
namespace {

/// More comparisons than the triples of all suites together make.
constexpr int kComparisons = 5000;

// --- Quadrature
// ------------------------------------------------------------------------------------------------------

constexpr int kDepth = 9;

/// Gauss–Legendre, 5 points a side.
double gauss(const std::function<double(const Vec2&)>& f, const Vec2& lo, const Vec2& hi) {
  constexpr std::array<double, 5> node{-0.906179845938664, -0.5384693101056831, 0.0,
                                       0.5384693101056831, 0.906179845938664};
  constexpr std::array<double, 5> weight{0.23692688505618908, 0.47862867049936647,
                                         0.5688888888888889, 0.47862867049936647,
                                         0.23692688505618908};
  const Vec2 center = 0.5 * (lo + hi), half = 0.5 * (hi - lo);
  double sum = 0;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 5; ++j)
      sum += weight[i] * weight[j] * f(center + half * Vec2(node[i], node[j]));
  return sum * half.x * half.y;
}

double refine(const std::function<double(const Vec2&)>& f, const Vec2& lo, const Vec2& hi,
              double whole, double tolerance, int depth) {
  const Vec2 mid = 0.5 * (lo + hi);
  const std::array<std::pair<Vec2, Vec2>, 4> parts{{{lo, mid},
                                                    {Vec2(mid.x, lo.y), Vec2(hi.x, mid.y)},
                                                    {Vec2(lo.x, mid.y), Vec2(mid.x, hi.y)},
                                                    {mid, hi}}};
  std::array<double, 4> value;
  double sum = 0;
  for (int i = 0; i < 4; ++i) sum += value[i] = gauss(f, parts[i].first, parts[i].second);
  // The first division is never the last: an edge close to a side slips between the nodes.
  if (depth == 0 || (depth < kDepth && std::fabs(sum - whole) <= tolerance)) return sum;
  sum = 0;
  for (int i = 0; i < 4; ++i)
    sum += refine(f, parts[i].first, parts[i].second, value[i], 0.5 * tolerance, depth - 1);
  return sum;
}

// --- Random numbers that owe nothing to the code under test
// ---------------------------------------------------------

class Random {
 public:
  explicit Random(const std::string& name) {
    std::uint64_t hash = 14695981039346656037u;  // FNV-1a
    for (const unsigned char c : name) hash = (hash ^ c) * 1099511628211u;
    engine_.seed(hash ^ suite_seed());
  }
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }
  Vec3 uniform3() {
    const double x = uniform(), y = uniform();
    return {x, y, uniform()};
  }

 private:
  std::mt19937_64 engine_;
};

std::size_t bin(double coordinate, int count) {
  const int i = static_cast<int>(coordinate * count);
  return static_cast<std::size_t>(i < 0 ? 0 : (i >= count ? count - 1 : i));
}

// --- The laws
// --------------------------------------------------------------------------------------------------------

class Check {
 public:
  Check(const std::string& name, const Triple& triple, const Chart& chart,
        const TripleOptions& options)
      : name_(name), triple_(triple), chart_(chart), options_(options), random_(name) {}

  std::string run() {
    integrate_density();
    count_samples();
    check_spread_points();
    check_law_of_inverse();
    return faults_.str();
  }

 private:
  template <class... Args>
  void fault(const Args&... args) {
    faults_ << name_ << ": ";
    (faults_ << ... << args) << '\n';
  }
  void require_p(double p, const std::string& what) {
    if (!(p >= sidak(kSuiteFalseAlarm, kComparisons))) fault(what, ", p = ", p);
  }

  void integrate_density() {
    const auto density = [this](const Vec2& c) {
      return triple_.pdf(chart_.point(c)) * chart_.jacobian(c);
    };
    const Vec2 step(1.0 / chart_.columns, 1.0 / chart_.rows);
    double mass = 0;
    for (int j = 0; j < chart_.rows; ++j)
      for (int i = 0; i < chart_.columns; ++i) {
        const Vec2 lo(i * step.x, j * step.y);
        const double p = integrate(density, lo, lo + step, 1e-8);
        expected_.push_back(p * options_.samples);
        mass += p;
      }
    constexpr double kQuadratureError = 2e-5;
    if (options_.mass && !(std::fabs(mass - *options_.mass) < kQuadratureError))
      fault("the density integrates to ", mass, " instead of ", *options_.mass);
    if (!(mass < 1 + kQuadratureError)) fault("the density integrates to ", mass);
    expected_.push_back(std::fmax(1 - mass, 0.0) * options_.samples);
  }

  void count_samples() {
    std::vector<std::uint64_t> observed(expected_.size(), 0);
    int without_density = 0;
    for (int n = 0; n < options_.samples; ++n) {
      const auto x = triple_.sample(random_.uniform3());
      if (!x) {
        ++observed.back();
        continue;
      }
      const Vec2 c = chart_.coordinates(*x);
      ++observed[bin(c.y, chart_.rows) * chart_.columns + bin(c.x, chart_.columns)];
      if (!(triple_.pdf(*x) > 0)) ++without_density;
      if (n % 10 == 0) check_round_trip(*x, true);
    }
    if (without_density > 0) fault(without_density, " samples where the density is zero");
    if (options_.mass == 1.0 && observed.back() > 0) fault(observed.back(), " samples lost");
    require_p(chi2_test(observed, expected_), "samples do not follow the density");
    count_blocks(observed);
  }

  /// Once more on few cells: what differs slightly but everywhere is lost among many.
  void count_blocks(const std::vector<std::uint64_t>& fine) {
    constexpr int kBlocks = 4;
    std::vector<std::uint64_t> observed(kBlocks * kBlocks + 1, 0);
    std::vector<double> expected(kBlocks * kBlocks + 1, 0.0);
    for (std::size_t i = 0; i < fine.size(); ++i) {
      const std::size_t column = i % chart_.columns * kBlocks / chart_.columns,
                        row = i / chart_.columns * kBlocks / chart_.rows;
      const std::size_t block = std::min(row * kBlocks + column, expected.size() - 1);
      observed[block] += fine[i];
      expected[block] += expected_[i];
    }
    require_p(chi2_test(observed, expected), "samples do not follow the density in the large");
  }

  void check_spread_points() {
    for (int n = 0; n < 5000; ++n) {
      const Vec3 x = chart_.point({random_.uniform(), random_.uniform()});
      const double density = triple_.pdf(x) * chart_.jacobian(chart_.coordinates(x));
      // The 53 bits of u cannot name points of much thinner tails.
      if (density == 0 || density > 1e-6) check_round_trip(x, density > 0);
    }
  }

  /// How far a few units in the last place of u move x.
  double conditioning(const Vec3& u, const Vec3& x) const {
    double moved = 0;
    for (int i = 0; i < triple_.dimensions; ++i)
      for (const double ulps : {-0x1p-51, 0x1p-51}) {
        Vec3 v = u;
        v[i] = std::fmin(std::fmax(v[i] + ulps, 0.0), kOneMinusEpsilon);
        if (const auto y = triple_.sample(v)) moved = std::fmax(moved, length(*y - x));
      }
    return moved;
  }

  void check_round_trip(const Vec3& x, bool has_density) {
    const auto u = triple_.invert(x, random_.uniform3());
    if (u.has_value() != has_density) {
      once(missing_,
           u ? "invert finds u where the density is zero"
             : "invert finds no u where the density is positive",
           x, 0.0);
      return;
    }
    if (!u) return;
    for (int i = 0; i < triple_.dimensions; ++i)
      if (!((*u)[i] >= 0 && (*u)[i] < 1)) once(outside_, "invert leaves the unit cube", x, (*u)[i]);
    const auto y = triple_.sample(*u);
    if (!y) {
      once(lost_, "sample(invert(x)) is nothing", x, 0.0);
      return;
    }
    const double error = length(*y - x);
    const double allowed = options_.tolerance * std::fmax(1.0, length(x));
    if (!(error <= allowed) && !(error <= allowed + conditioning(*u, *y)))
      once(wrong_, "sample(invert(x)) is not x, distance", x, error);
  }

  /// Reports the first of a kind of fault.
  void once(bool& reported, const char* what, const Vec3& x, double value) {
    if (reported) return;
    reported = true;
    faults_.precision(17);
    fault(what, ' ', value, " at (", x.x, ", ", x.y, ", ", x.z, ")");
    faults_.precision(6);
  }

  /// Uniform again; u that yield nothing stand for themselves, so that the whole cube is compared.
  void check_law_of_inverse() {
    constexpr int kCells = 16;
    std::array<std::vector<double>, 3> coordinates;
    std::array<std::vector<std::uint64_t>, 3> pairs;
    pairs.fill(std::vector<std::uint64_t>(kCells * kCells, 0));
    for (int n = 0; n < options_.samples; ++n) {
      Vec3 u = random_.uniform3();
      const auto x = triple_.sample(u);
      const auto v = x ? triple_.invert(*x, random_.uniform3()) : std::nullopt;
      if (v) u = *v;
      for (int i = 0; i < triple_.dimensions; ++i) {
        coordinates[i].push_back(u[i]);
        ++pairs[i][bin(u[i], kCells) * kCells + bin(u[(i + 1) % 3], kCells)];
      }
    }
    const std::vector<double> expected(kCells * kCells,
                                       options_.samples / static_cast<double>(kCells * kCells));
    for (int i = 0; i < triple_.dimensions; ++i) {
      const std::string which = "u[" + std::to_string(i) + "] of invert(sample(u)) ";
      require_p(uniform_ks_test(std::move(coordinates[i])), which + "is not uniform");
      if (triple_.dimensions == 3 || i + 1 < triple_.dimensions)
        require_p(chi2_test(pairs[i], expected), which + "and the next are not jointly uniform");
    }
  }

  const std::string& name_;
  const Triple& triple_;
  const Chart& chart_;
  const TripleOptions& options_;
  Random random_;
  std::vector<double> expected_;
  std::ostringstream faults_;
  bool missing_ = false, outside_ = false, lost_ = false, wrong_ = false;
};

}  // namespace

double integrate(const std::function<double(const Vec2&)>& f, const Vec2& lo, const Vec2& hi,
                 double tolerance) {
  return refine(f, lo, hi, gauss(f, lo, hi), tolerance, kDepth);
}

namespace {

/// A chart of directions from one of q = (1 − cosθ)/2 ∈ (0, 1) by the first coordinate.
template <class FromSquare, class ToSquare, class Derivative>
Chart chart_around(const Frame& frame, FromSquare q_of, ToSquare of_q, Derivative dq) {
  Chart chart;
  chart.point = [=](const Vec2& c) {
    const double q = q_of(c.x), sin_theta = 2 * std::sqrt(q * (1 - q)), phi = 2 * kPi * c.y;
    return frame.to_world({sin_theta * std::cos(phi), sin_theta * std::sin(phi), 1 - 2 * q});
  };
  chart.coordinates = [=](const Vec3& w) {
    const double turn = std::atan2(dot(w, frame.t), dot(w, frame.s)) / (2 * kPi);
    return Vec2(of_q(std::fmin(0.25 * length_squared(w - frame.n), 1.0)),
                turn < 0 ? turn + 1 : turn);
  };
  chart.jacobian = [=](const Vec2& c) { return 4 * kPi * dq(c.x); };
  return chart;
}

}  // namespace

Chart sphere_chart(const Frame& frame) {
  const auto same = [](double q) { return q; };
  return chart_around(frame, same, same, [](double) { return 1.0; });
}

Chart lobe_chart(const Frame& frame, double width) {
  // 1 − q = v²/(v² + κ(1 − v²)) with v = 1 − c: the far side, where little happens, keeps a share
  // √κ of the chart.
  const double k = width / (3 * (2 - width));
  const auto Q = [k](double c) { return sqr(1 - c) + k * c * (2 - c); };
  return chart_around(
      frame, [=](double c) { return k * c * (2 - c) / Q(c); },
      [=](double q) {
        const double sum = q + k * (1 - q);
        return q / (sum * (1 + std::sqrt(k * (1 - q) / sum)));
      },
      [=](double c) { return 2 * k * (1 - c) / sqr(Q(c)); });
}

Chart box_chart(const Vec2& lo, const Vec2& hi) {
  Chart chart;
  chart.point = [lo, hi](const Vec2& c) { return Vec3(lo + c * (hi - lo), 0); };
  chart.coordinates = [lo, hi](const Vec3& x) { return (Vec2(x.x, x.y) - lo) / (hi - lo); };
  chart.jacobian = [lo, hi](const Vec2&) { return (hi.x - lo.x) * (hi.y - lo.y); };
  return chart;
}

Chart interval_chart(double lo, double hi, double scale) {
  Chart chart;
  chart.columns = 256;
  chart.rows = 1;
  if (std::isinf(hi)) {
    chart.point = [lo, scale](const Vec2& c) { return Vec3(lo + scale * c.x / (1 - c.x), 0, 0); };
    chart.coordinates = [lo, scale](const Vec3& x) {
      return Vec2((x.x - lo) / (x.x - lo + scale), 0.5);
    };
    chart.jacobian = [scale](const Vec2& c) { return scale / sqr(1 - c.x); };
    return chart;
  }
  chart.point = [lo, hi](const Vec2& c) { return Vec3(lo + c.x * (hi - lo), 0, 0); };
  chart.coordinates = [lo, hi](const Vec3& x) { return Vec2((x.x - lo) / (hi - lo), 0.5); };
  chart.jacobian = [lo, hi](const Vec2&) { return hi - lo; };
  return chart;
}

std::string check_triple(const std::string& name, const Triple& triple, const Chart& chart,
                         const TripleOptions& options) {
  return Check(name, triple, chart, options).run();
}

}  // namespace fogbow::testing
