// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "core/math/discrete_distribution.h"
#include "core/math/warp.h"
#include "core/scene/emitters.h"

namespace fogbow {
namespace {

/// Points a side of the grid on which the mean emission is looked up.
constexpr int kPowerGrid = 4;
/// Cells a side into which the bounds of a heterogeneous medium are cut, each as likely as its
/// bound of the emission says.
constexpr int kCells = 32;

class VolumeEmitter final : public Emitter {
 public:
  VolumeEmitter(std::shared_ptr<const Medium> medium, const Bounds& bounds,
                std::function<const Medium*(const Vec3&)> medium_at)
      : medium_(std::move(medium)), bounds_(bounds), medium_at_(std::move(medium_at)) {
    if (!(bounds.volume() > 0) || !std::isfinite(bounds.volume()))
      throw std::domain_error("an emitting medium needs bounds with a finite volume");
    std::vector<double> weights;
    if (medium_->is_heterogeneous()) {
      cells_ = kCells;
      for (int z = 0; z < kCells; ++z)
        for (int y = 0; y < kCells; ++y)
          for (int x = 0; x < kCells; ++x) {
            const Vec3 lo(x, y, z);
            const RGB bound = medium_->max_emission(
                {in_bounds(lo / double(kCells)), in_bounds((lo + 1.0) / double(kCells))});
            weights.push_back(mean(bound));
            bound_ += bound;
          }
    } else {
      weights.push_back(1);
    }
    distribution_ = DiscreteDistribution(weights);
    cell_volume_ = bounds_.volume() / static_cast<double>(weights.size());
  }

  EmitterKind kind() const override { return EmitterKind::Volume; }
  RGB power() const override {
    if (medium_->is_heterogeneous()) return 4 * kPi * cell_volume_ * bound_;
    RGB sum(0);
    for (int i = 0; i < kPowerGrid; ++i)
      for (int j = 0; j < kPowerGrid; ++j)
        for (int k = 0; k < kPowerGrid; ++k)
          sum += medium_->emission(in_bounds((Vec3(i, j, k) + 0.5) / double(kPowerGrid)));
    return 4 * kPi * bounds_.volume() / std::pow(kPowerGrid, 3) * sum;
  }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    const std::size_t cell = distribution_.sample(u.x);
    const double within = (u.x - distribution_.invert(cell, 0)) / distribution_.probability(cell);
    EmitterPoint x;
    x.surface.position = in_bounds((corner(cell) + Vec3(within, u.y, u.z)) / double(cells_));
    if (medium_at_(x.surface.position) != medium_.get()) return std::nullopt;
    x.pdf_position = pdf_position(x);
    if (!(x.pdf_position > 0)) return std::nullopt;  // rounded into the next cell
    return x;
  }
  double pdf_position(const EmitterPoint& x) const override {
    if (!contains(x.surface.position)) return 0;
    return distribution_.probability(cell_at(x.surface.position)) / cell_volume_;
  }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3&) const override {
    if (!(pdf_position(x) > 0)) return std::nullopt;
    const std::size_t cell = cell_at(x.surface.position);
    const Vec3 u = unit_position(x.surface.position) * double(cells_) - corner(cell);
    return Vec3(distribution_.invert(cell, warp::clamp_unit(u.x)), warp::clamp_unit(u.y),
                warp::clamp_unit(u.z));
  }

  EmitterDirection sample_direction(const EmitterPoint& x, const Vec2& u) const override {
    return {warp::sample_sphere(u), x.surface.position, warp::pdf_sphere()};
  }
  double pdf_direction(const EmitterPoint&, const Vec3&) const override {
    return warp::pdf_sphere();
  }
  std::optional<Vec2> invert_direction(const EmitterPoint&,
                                       const EmitterDirection& d) const override {
    return warp::invert_sphere(d.w);
  }

  RGB L_e(const EmitterPoint& x, const Vec3&) const override {
    return medium_->emission(x.surface.position);
  }

 private:
  Vec3 in_bounds(const Vec3& u) const { return bounds_.lo + u * bounds_.diagonal(); }
  Vec3 unit_position(const Vec3& p) const { return (p - bounds_.lo) / bounds_.diagonal(); }
  std::size_t cell_at(const Vec3& p) const {
    const Vec3 u = unit_position(p) * double(cells_);
    std::size_t cell = 0;
    for (int axis = 2; axis >= 0; --axis)
      cell = cell * cells_ + std::clamp(static_cast<int>(u[axis]), 0, cells_ - 1);
    return cell;
  }
  Vec3 corner(std::size_t cell) const {
    return Vec3(cell % cells_, cell / cells_ % cells_, cell / cells_ / cells_);
  }
  bool contains(const Vec3& p) const {
    return glm::all(glm::greaterThanEqual(p, bounds_.lo)) &&
           glm::all(glm::lessThanEqual(p, bounds_.hi));
  }

  std::shared_ptr<const Medium> medium_;
  Bounds bounds_;
  std::function<const Medium*(const Vec3&)> medium_at_;
  int cells_ = 1;
  double cell_volume_ = 0;
  RGB bound_{0};  ///< of the emission, summed over cells
  DiscreteDistribution distribution_;
};

}  // namespace

std::shared_ptr<Emitter> make_volume_emitter(std::shared_ptr<const Medium> medium,
                                             const Bounds& bounds,
                                             std::function<const Medium*(const Vec3&)> medium_at) {
  return std::make_shared<VolumeEmitter>(std::move(medium), bounds, std::move(medium_at));
}

}  // namespace fogbow
