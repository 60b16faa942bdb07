// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>
#include <utility>

#include "media/media.h"
#include "media/regular_tracking.h"

namespace fogbow {
namespace {

/// Adds up the integral of each channel of a volume along a ray, until that of one exceeds a
/// target.
template <int kChannels, VolumeFilter kFilter>
class Tracker {
 public:
  using Index = RegularTracking::Index;

  Tracker(const RegularTracking& tracking, int channel, double target)
      : tracking_(tracking), channel_(kChannels == 1 ? 0 : channel), target_(target) {}

  /// Over [t0, t1], within the volume's bounds.
  FlightEnd track(double t0, double t1) {
    // Voxels are far away: those of some blocks are asked for before the first is added up.
    constexpr unsigned kAhead = 2;
    Block ring[kAhead];
    unsigned first = 0, last = 0;  // blocks added up, and found
    bool goes_on = tracking_.blocks(t0, t1, [&](const Index& at, double ta, double tb) {
      const std::size_t index = tracking_.block_index(at);
      const Volume::BlockKind kind = tracking_.volume().block_kind(index);
      if (kind == Volume::BlockKind::Empty) return true;
      if (last - first == kAhead && !add(ring[first++ % kAhead])) return false;
      Block& next = ring[last++ % kAhead];
      next.index = index;
      next.ta = ta;
      next.tb = tb;
      next.steps.clear();
      if (kind == Volume::BlockKind::Varying) {
        const float* samples = tracking_.volume().block_samples(index);
        tracking_.cells(at, ta, tb, [&](const Index& cell, const Index& i, double a, double b) {
          const int corner = Volume::sample_index(i[0], i[1], i[2]);
          next.steps.add({cell, a, b, samples + corner * kChannels}, kChannels);
          return true;
        });
      }
      return true;
    });
    while (goes_on && first != last) goes_on = add(ring[first++ % kAhead]);
    if (kChannels == 1) end_.depth = RGB(end_.depth.x);
    return end_;
  }

 private:
  struct Block {
    std::size_t index;
    double ta, tb;
    CellSteps steps;  ///< none where it is uniform
  };

  /// False where the flight ends.
  bool add(const Block& block) {
    if (block.steps.empty()) return add_uniform(block);
    for (const CellStep& step : block.steps)
      if (!add_cell(step)) return false;
    return true;
  }

  bool add_uniform(const Block& block) {
    RGB value(0);
    for (int c = 0; c < kChannels; ++c) value[c] = tracking_.volume().block_max(block.index)[c];
    const double length = (target_ - end_.depth[channel_]) / value[channel_];
    if (length < block.tb - block.ta) return stop(block.ta + length, length * value);
    end_.depth += (block.tb - block.ta) * value;
    return true;
  }

  bool add_cell(const CellStep& step) {
    RGB part(0);
    for (int c = 0; c < kChannels; ++c)
      part[c] = CellDensity<kChannels, kFilter>(tracking_, step, c).integral(step.ta, step.tb);
    if (end_.depth[channel_] + part[channel_] > target_) return end_in_cell(step);
    end_.depth += part;
    return true;
  }

  bool end_in_cell(const CellStep& step) {
    const CellDensity<kChannels, kFilter> density(tracking_, step, channel_);
    const double t = density.invert(step.ta, step.tb, target_ - end_.depth[channel_]);
    RGB part(0);
    for (int c = 0; c < kChannels; ++c)
      part[c] = CellDensity<kChannels, kFilter>(tracking_, step, c).integral(step.ta, t);
    return stop(t, part);
  }

  bool stop(double t, const RGB& part) {
    end_.t = t;
    end_.inside = true;
    end_.depth += part;
    return false;
  }

  const RegularTracking& tracking_;
  int channel_;
  double target_;
  FlightEnd end_{0, false};
};

/// Integral of each channel over [t0, t1], without the volume's factor: up to where that of
/// `channel` exceeds `target`, if it does.
template <int kChannels, VolumeFilter kFilter>
FlightEnd track(const Volume& volume, const Ray& ray, double t0, double t1, int channel,
                double target) {
  const RegularTracking tracking(volume, ray);
  const FlightEnd through{t1, false};
  if (!tracking.clip(t0, t1)) return through;
  FlightEnd end = Tracker<kChannels, kFilter>(tracking, channel, target).track(t0, t1);
  if (!end.inside) end.t = through.t;
  return end;
}

FlightEnd track(const Volume& volume, const Ray& ray, double t0, double t1, int channel,
                double target) {
  if (volume.filter() == VolumeFilter::Trilinear)
    return volume.channels() == 1
               ? track<1, VolumeFilter::Trilinear>(volume, ray, t0, t1, channel, target)
               : track<3, VolumeFilter::Trilinear>(volume, ray, t0, t1, channel, target);
  return volume.channels() == 1
             ? track<1, VolumeFilter::Nearest>(volume, ray, t0, t1, channel, target)
             : track<3, VolumeFilter::Nearest>(volume, ray, t0, t1, channel, target);
}

class Heterogeneous final : public Medium {
 public:
  Heterogeneous(const HeterogeneousSettings& s, std::shared_ptr<const PhaseFunction> phase,
                std::string id)
      : Medium(std::move(phase), std::move(id)),
        sigma_t_(s.sigma_t),
        albedo_(s.albedo),
        emission_(s.emission),
        scale_(s.scale),
        factor_(s.scale * s.sigma_t->factor()),
        max_sigma_t_(s.scale * s.sigma_t->max()) {}

  RGB sigma_t(const Vec3& p) const override {
    const Bounds& box = sigma_t_->bounds();
    const bool inside =
        glm::all(glm::greaterThanEqual(p, box.lo)) && glm::all(glm::lessThanEqual(p, box.hi));
    return inside ? scale_ * sigma_t_->value(p) : RGB(0);
  }
  RGB sigma_s(const Vec3& p) const override { return coefficients(p).sigma_s; }
  Coefficients coefficients(const Vec3& p) const override {
    const RGB sigma = sigma_t(p);
    return {sigma, sigma * albedo_->value(p)};
  }
  RGB emission(const Vec3& p) const override {
    if (!emission_) return RGB(0);
    const RGB value = emission_->value(p);
    return is_black(value) || is_black(sigma_t(p)) ? RGB(0) : value;
  }
  bool scatters() const override { return !is_black(max_sigma_t_ * albedo_->max()); }
  bool emits() const override {
    return emission_ && !is_black(max_emission(support())) && !is_black(max_sigma_t_);
  }

  RGB optical_depth(const Ray& ray, double t0, double t1) const override {
    return factor_ * track(*sigma_t_, ray, t0, t1, 0, kInfinity).depth;
  }
  FlightEnd fly(const Ray& ray, double t0, double t1, int channel, double target) const override {
    if (!(factor_[channel] > 0)) return {t1, false, optical_depth(ray, t0, t1)};
    FlightEnd end = track(*sigma_t_, ray, t0, t1, channel, target / factor_[channel]);
    end.depth *= factor_;
    return end;
  }

  bool is_heterogeneous() const override { return true; }
  Bounds support() const override { return sigma_t_->bounds(); }
  RGB max_emission(const Bounds& box) const override {
    if (!emission_) return RGB(0);
    const Bounds inside{glm::max(box.lo, support().lo), glm::min(box.hi, support().hi)};
    if (inside.empty() || is_black(sigma_t_->max_within(inside))) return RGB(0);
    return emission_->max_within(inside);
  }
  Majorant majorant(const Ray& ray, double t, double t1) const override {
    const RegularTracking tracking(*sigma_t_, ray);
    double begin = t, end = t1;
    if (!tracking.clip(begin, end)) return {t1, 0};
    if (begin > t) return {begin, 0};
    Majorant result{t1, 0};
    tracking.blocks(begin, end, [&](const RegularTracking::Index& block, double, double tb) {
      if (!(tb > t)) return true;
      const float* max = sigma_t_->block_max(tracking.block_index(block));
      double most = 0;
      for (int c = 0; c < 3; ++c)
        most = std::max(most, factor_[c] * max[sigma_t_->channels() == 3 ? c : 0]);
      result = {tb, most};
      return false;
    });
    return result;
  }
  std::size_t memory_bytes() const override {
    return sigma_t_->memory_bytes() + albedo_->memory_bytes() +
           (emission_ ? emission_->memory_bytes() : 0);
  }

 private:
  std::shared_ptr<const Volume> sigma_t_, albedo_, emission_;
  double scale_;
  RGB factor_, max_sigma_t_;
};

}  // namespace

std::shared_ptr<const Medium> make_heterogeneous_medium(const HeterogeneousSettings& settings,
                                                        std::shared_ptr<const PhaseFunction> phase,
                                                        std::string id) {
  if (!(settings.scale >= 0 && is_finite(settings.scale * settings.sigma_t->max())))
    throw std::domain_error("sigma_t must be finite and not negative");
  if (!(max_component(settings.albedo->max()) <= 1))
    throw std::domain_error("the albedo of a medium must lie in [0, 1]");
  return std::make_shared<Heterogeneous>(settings, std::move(phase), std::move(id));
}

}  // namespace fogbow
