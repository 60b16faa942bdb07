// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "core/scene/volume.h"

namespace fogbow {

/// A ray on its way through the cells of a volume, one after the other [AmanatidesWoo1987]: the
/// blocks first, then the cells of those that vary. Distances are those of the world.
class RegularTracking {
 public:
  RegularTracking(const Volume& volume, const Ray& ray)
      : volume_(volume), ray_(ray), o_(volume.lattice_point(ray.o)) {
    d_ = volume.lattice_vector(ray.d);
    inverse_ = 1.0 / d_;
  }

  /// The part of [t0, t1] within the volume's bounds; false where there is none.
  bool clip(double& t0, double& t1) const { return fogbow::clip(volume_.bounds(), ray_, t0, t1); }

  using Index = std::array<int, 3>;

  /// Calls visit(block, ta, tb) for all blocks in [t0, t1] until it says false.
  template <class Visit>
  bool blocks(double t0, double t1, Visit&& visit) const {
    Index first, count;
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = volume_.first_cell(axis);
      count[axis] = volume_.block_count(axis);
    }
    return traverse<Volume::kBlock>(first, count, t0, t1, visit);
  }
  /// The same for the cells of a block, which have the numbers that voxels have.
  template <class Visit>
  bool cells(const Index& block, double t0, double t1, Visit&& visit) const {
    Index first, count;
    for (int axis = 0; axis < 3; ++axis) {
      const int before = Volume::kBlock * block[axis];
      first[axis] = volume_.first_cell(axis) + before;
      count[axis] = std::min(Volume::kBlock, volume_.cell_count(axis) - before);
    }
    return traverse<1>(first, count, t0, t1, [&](const Index& i, double ta, double tb) {
      return visit(Index{first[0] + i[0], first[1] + i[1], first[2] + i[2]}, ta, tb);
    });
  }

  const Volume& volume() const { return volume_; }
  std::size_t block_index(const Index& b) const { return volume_.block_index(b[0], b[1], b[2]); }
  /// Lattice coordinates at t within a cell.
  Vec3 local(const Index& cell, double t) const {
    return {o_.x + t * d_.x - cell[0], o_.y + t * d_.y - cell[1], o_.z + t * d_.z - cell[2]};
  }

 private:
  /// Cubes of a side of kSide cells, of which `count` lie side by side from cell `first`.
  template <int kSide, class Visit>
  bool traverse(const Index& first, const Index& count, double t0, double t1, Visit&& visit) const {
    Index i;
    double next[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double at = o_[axis] + t0 * d_[axis] - first[axis];
      i[axis] = std::clamp(static_cast<int>(std::floor(at / kSide)), 0, count[axis] - 1);
      next[axis] = plane<kSide>(axis, first[axis], i[axis]);
    }
    for (double ta = t0;;) {
      const int axis =
          next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
      // Rounding may put a plane a little before where the last one was met.
      const double tb = std::min(std::max(next[axis], ta), t1);
      if (!visit(i, ta, tb)) return false;
      if (!(tb < t1)) return true;
      i[axis] += d_[axis] > 0 ? 1 : -1;
      if (i[axis] < 0 || i[axis] >= count[axis]) return true;
      next[axis] = plane<kSide>(axis, first[axis], i[axis]);
      ta = tb;
    }
  }

  /// Where the ray leaves cube i of an axis. The same plane has the same distance whoever asks.
  template <int kSide>
  double plane(int axis, int first, int i) const {
    if (d_[axis] == 0) return kInfinity;
    return (first + (i + (d_[axis] > 0 ? 1 : 0)) * kSide - o_[axis]) * inverse_[axis];
  }

  const Volume& volume_;
  const Ray& ray_;
  Vec3 o_, d_, inverse_;
};

/// The part of a ray in one cell.
struct CellStep {
  RegularTracking::Index index;
  double ta, tb;
};

/// All of them in one block: a ray leaves a cell through one of the planes in the block.
class CellSteps {
 public:
  bool empty() const { return size_ == 0; }
  void clear() { size_ = 0; }
  void push_back(const CellStep& step) { steps_[size_++] = step; }
  const CellStep* begin() const { return steps_; }
  const CellStep* end() const { return steps_ + size_; }

 private:
  int size_ = 0;
  CellStep steps_[3 * Volume::kBlock];
};

/// Asks for the corners of a cell.
inline void prefetch(const Volume& volume, const RegularTracking::Index& cell) {
#ifdef __GNUC__
  const std::uint32_t* x = volume.offsets(0) + cell[0];
  const std::uint32_t* y = volume.offsets(1) + cell[1];
  const std::uint32_t* z = volume.offsets(2) + cell[2];
  for (int i = 0; i < 8; ++i)
    __builtin_prefetch(volume.voxels() + x[i & 1] + y[i >> 1 & 1] + z[i >> 2]);
#endif
}

/// One channel of the field in one cell, along the ray.
template <VolumeFilter kFilter>
class CellDensity {
 public:
  CellDensity(const RegularTracking& tracking, const RegularTracking::Index& cell, int channel)
      : tracking_(tracking), cell_(cell) {
    const Volume& volume = tracking.volume();
    const float* voxels = volume.voxels() + channel;
    const std::uint32_t* x = volume.offsets(0) + cell[0];
    const std::uint32_t* y = volume.offsets(1) + cell[1];
    const std::uint32_t* z = volume.offsets(2) + cell[2];
    if constexpr (kFilter == VolumeFilter::Nearest) {
      v_[0] = voxels[x[0] + y[0] + z[0]];
    } else {
      for (int i = 0; i < 8; ++i) v_[i] = voxels[x[i & 1] + y[i >> 1 & 1] + z[i >> 2]];
    }
  }

  double operator()(double t) const {
    if constexpr (kFilter == VolumeFilter::Nearest) return v_[0];
    const Vec3 p = tracking_.local(cell_, t);
    return trilinear(v_, p.x, p.y, p.z);
  }

  /// Over [ta, tb]. A trilinear field is a cubic along the ray, which two-point Gauss quadrature
  /// integrates exactly.
  double integral(double ta, double tb) const {
    const double length = tb - ta;
    if constexpr (kFilter == VolumeFilter::Nearest) return v_[0] * length;
    constexpr double kNode = 0.28867513459481288;  // √3/6
    const double middle = 0.5 * (ta + tb), offset = kNode * length;
    return std::max(0.5 * length * ((*this)(middle - offset) + (*this)(middle + offset)), 0.0);
  }

  /// The t in [ta, tb] where the integral from ta is `target`, which that up to tb exceeds.
  double invert(double ta, double tb, double target) const {
    double lo = ta, hi = tb, t = ta + (tb - ta) * (target / integral(ta, tb));
    constexpr int kSteps = 100;  // bisection alone needs some sixty
    for (int step = 0; step < kSteps; ++step) {
      const double excess = integral(ta, t) - target, slope = (*this)(t);
      (excess > 0 ? hi : lo) = t;
      // Newton's step, halving where it leads out of the bracket.
      double better = t - excess / slope;
      if (!(better > lo && better < hi)) better = 0.5 * (lo + hi);
      if (better == t || !(better > lo && better < hi)) break;
      const bool settled = std::abs(better - t) <= 1e-16 * std::abs(t);
      t = better;
      if (settled) break;
    }
    return t;
  }

 private:
  const RegularTracking& tracking_;
  const RegularTracking::Index& cell_;
  double v_[8];
};

}  // namespace fogbow
