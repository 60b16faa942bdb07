// SPDX-License-Identifier: GPL-3.0-or-later
#include "mlt/primary_sample.h"

#include <algorithm>

#include "core/util/binary_io.h"

namespace fogbow {

namespace {

/// Hands out uniform numbers and keeps them.
class DrawingStream final : public SampleStream {
 public:
  DrawingStream(std::vector<double>& kept, Rng& rng) : kept_(kept), rng_(rng) { kept_.clear(); }
  double next() override { return kept_.emplace_back(rng_.uniform()); }

 private:
  std::vector<double>& kept_;
  Rng& rng_;
};

/// Hands out perturbed coordinates of another sample, and uniform ones past its end.
class PerturbingStream final : public SampleStream {
 public:
  PerturbingStream(std::vector<double>& kept, const std::vector<double>& from, Rng& rng)
      : kept_(kept), from_(from), rng_(rng) {
    kept_.clear();
  }
  double next() override {
    const double u = rng_.uniform();
    const std::size_t i = kept_.size();
    return kept_.emplace_back(i < from_.size() ? perturb_primary_sample(from_[i], u) : u);
  }

 private:
  std::vector<double>& kept_;
  const std::vector<double>& from_;
  Rng& rng_;
};

}  // namespace

double perturb_primary_sample(double value, double u) {
  constexpr double kSmallest = 1.0 / 1024, kLargest = 1.0 / 64;
  const bool up = u < 0.5;
  const double v = up ? 2 * u : 2 * u - 1;
  const double offset = kLargest * std::exp(-std::log(kLargest / kSmallest) * v);
  double moved = up ? value + offset : value - offset;
  if (moved >= 1) moved -= 1;
  if (moved < 0) moved += 1;
  return std::min(moved, kOneMinusEpsilon);
}

void PrimarySample::evaluate(const Estimator& estimator, SampleStream& light, SampleStream& eye) {
  estimator.sample(light, eye, workspace_);
  f_star_ = workspace_.refused > 0 ? std::numeric_limits<double>::quiet_NaN() : 0;
  workspace_.refused = 0;
  for (const Contribution& c : workspace_.contributions)
    f_star_ += luminance(c.value) * (*importance_)(c.raster);
}

void PrimarySample::draw(const Estimator& estimator, Rng& rng) {
  DrawingStream light(light_, rng), eye(eye_, rng);
  evaluate(estimator, light, eye);
}

void PrimarySample::perturb(const Estimator& estimator, const PrimarySample& x, Rng& rng) {
  PerturbingStream light(light_, x.light_, rng), eye(eye_, x.eye_, rng);
  evaluate(estimator, light, eye);
}

void PrimarySample::serialize(std::ostream& out) const {
  write_binary_vector(out, light_);
  write_binary_vector(out, eye_);
  write_binary_vector(out, workspace_.contributions);
  write_binary(out, f_star_);
}

PrimarySample PrimarySample::deserialize(std::istream& in, const PictureImportance& importance) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 24;
  PrimarySample x(importance);
  x.light_ = read_binary_vector<double>(in, kMost);
  x.eye_ = read_binary_vector<double>(in, kMost);
  x.workspace_.contributions = read_binary_vector<Contribution>(in, kMost);
  x.f_star_ = read_binary<double>(in);
  return x;
}

}  // namespace fogbow
