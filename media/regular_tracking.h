// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "core/scene/volume.h"

namespace fogbow {

/// A ray on its way through the cells of a volume, one after the other [AmanatidesWoo1987]: the
/// blocks first, then the cells of those that vary. Distances are those of the world.
class RegularTracking {
 public:
  RegularTracking(const Volume& volume, const Ray& ray)
      : volume_(volume), ray_(ray), o_(volume.lattice_point(ray.o)) {
    d_ = volume.lattice_vector(ray.d);
    for (int axis = 0; axis < 3; ++axis) {
      up_[axis] = d_[axis] > 0;
      inverse_[axis] = d_[axis] == 0 ? 0 : 1 / d_[axis];
      never_[axis] = d_[axis] == 0 ? kInfinity : 0;
    }
    curvature_ = Vec3(d_.y * d_.z, d_.x * d_.z, d_.x * d_.y) / 12.0;
  }

  /// The part of [t0, t1] within the volume's bounds where it may not be zero; false where there is
  /// none.
  bool clip(double& t0, double& t1) const {
    return fogbow::clip(volume_.bounds(), ray_, t0, t1) &&
           fogbow::clip(volume_.occupied(), {o_, d_}, t0, t1);
  }

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
  /// The same for the cells of a block: visit(cell, where it is in the block, ta, tb).
  template <class Visit>
  bool cells(const Index& block, double t0, double t1, Visit&& visit) const {
    Index first, count;
    for (int axis = 0; axis < 3; ++axis) {
      const int before = Volume::kBlock * block[axis];
      first[axis] = volume_.first_cell(axis) + before;
      count[axis] = std::min(Volume::kBlock, volume_.cell_count(axis) - before);
    }
    return traverse<1>(first, count, t0, t1, [&](const Index& i, double ta, double tb) {
      return visit(Index{first[0] + i[0], first[1] + i[1], first[2] + i[2]}, i, ta, tb);
    });
  }

  const Volume& volume() const { return volume_; }
  /// d_y d_z, d_x d_z and d_x d_y, over twelve.
  const Vec3& curvature() const { return curvature_; }
  std::size_t block_index(const Index& b) const { return volume_.block_index(b[0], b[1], b[2]); }
  /// Lattice coordinates at t within a cell.
  Vec3 local(const Index& cell, double t) const {
    return {o_.x + t * d_.x - cell[0], o_.y + t * d_.y - cell[1], o_.z + t * d_.z - cell[2]};
  }

 private:
  /// Cubes of a side of kSide cells, of which `count` lie side by side from cell `first`.
  template <int kSide, class Visit>
  bool traverse(const Index& first, const Index& count, double t0, double t1, Visit&& visit) const {
    Index i, beyond;
    double next[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double at = o_[axis] + t0 * d_[axis] - first[axis];
      i[axis] = std::min(static_cast<int>(std::max(at, 0.0)) / kSide, count[axis] - 1);
      beyond[axis] = up_[axis] ? count[axis] : -1;
      next[axis] = plane<kSide>(axis, first[axis], i[axis]);
    }
    double ta = t0;
    bool goes_on = true;
    // One copy for each axis: all of it in registers.
    const auto leave_by = [&](auto axis) {
      // Rounding may put a plane a little before where the last one was met.
      const double tb = std::min(std::max(next[axis], ta), t1);
      goes_on = visit(i, ta, tb);
      if (!goes_on || !(tb < t1)) return false;
      i[axis] += 2 * up_[axis] - 1;
      if (i[axis] == beyond[axis]) return false;
      next[axis] = plane<kSide>(axis, first[axis], i[axis]);
      ta = tb;
      return true;
    };
    const std::integral_constant<int, 0> x;
    const std::integral_constant<int, 1> y;
    const std::integral_constant<int, 2> z;
    while (next[0] < next[1] ? (next[0] < next[2] ? leave_by(x) : leave_by(z))
                             : (next[1] < next[2] ? leave_by(y) : leave_by(z))) {
    }
    return goes_on;
  }

  /// Where the ray leaves cube i of an axis. The same plane has the same distance whoever asks.
  template <int kSide>
  double plane(int axis, int first, int i) const {
    return (first + (i + up_[axis]) * kSide - o_[axis]) * inverse_[axis] + never_[axis];
  }

  const Volume& volume_;
  const Ray& ray_;
  Vec3 o_, d_, inverse_, curvature_;
  Vec3 never_;  ///< infinite where no plane of the axis is ever met
  Index up_;    ///< 1 where cells are passed upwards, else 0
};

/// The part of a ray in one cell, and the cell's first corner in its block.
struct CellStep {
  RegularTracking::Index cell;
  double ta, tb;
  const float* corner;
};

/// All of them in one block: a ray leaves each cell but the last through one of the block's inner
/// planes.
class CellSteps {
 public:
  bool empty() const { return size_ == 0; }
  const CellStep* begin() const { return steps_; }
  const CellStep* end() const { return steps_ + size_; }

  void clear() { size_ = 0; }
  /// Also asks the memory for the corners, which are far away: those of one z lie side by side.
  void add(const CellStep& step, int channels) {
    steps_[size_++] = step;
#ifdef __GNUC__
    for (const int corner : {0, 3, 4, 7})
      __builtin_prefetch(step.corner + Volume::kCorners[corner] * channels);
#endif
  }

 private:
  int size_ = 0;
  CellStep steps_[3 * Volume::kBlock];
};

/// Two numbers that one instruction adds or multiplies: what a cell's faces at x = 0 and x = 1
/// have.
using Pair [[gnu::vector_size(2 * sizeof(double))]] = double;

/// One channel of the field in one cell, along the ray.
template <int kChannels, VolumeFilter kFilter>
class CellDensity {
 public:
  CellDensity(const RegularTracking& tracking, const CellStep& step, int channel)
      : tracking_(tracking), cell_(step.cell) {
    constexpr bool kTrilinear = kFilter == VolumeFilter::Trilinear;
    for (int i = 0; i < (kTrilinear ? 4 : 1); ++i) {
      const float* v = step.corner + Volume::kCorners[2 * i] * kChannels + channel;
      v_[i] = Pair{v[0], v[kTrilinear ? kChannels : 0]};
    }
  }

  double operator()(double t) const {
    if constexpr (kFilter == VolumeFilter::Nearest) return v_[0][0];
    const Vec3 p = tracking_.local(cell_, t);
    const Pair y0 = v_[0] + p.z * (v_[2] - v_[0]), y1 = v_[1] + p.z * (v_[3] - v_[1]);
    const Pair x = y0 + p.y * (y1 - y0);
    return x[0] + p.x * (x[1] - x[0]);
  }

  /// Over [ta, tb]. A trilinear field is a cubic along the ray, which two-point Gauss quadrature
  /// integrates exactly: its nodes at m ± h/√12 see the value at the middle m and, beyond it, the
  /// second derivative alone, which is that of the products xy, xz and yz.
  double integral(double ta, double tb) const {
    const double length = tb - ta;
    if constexpr (kFilter == VolumeFilter::Nearest) return v_[0][0] * length;
    const Vec3 p = tracking_.local(cell_, 0.5 * (ta + tb)),
               k = length * length * tracking_.curvature();
    const Pair dz0 = v_[2] - v_[0], dz1 = v_[3] - v_[1], dyz = dz1 - dz0;
    const Pair y0 = v_[0] + p.z * dz0, dy = v_[1] + p.z * dz1 - y0;
    const Pair x = y0 + p.y * dy + k.x * dyz;
    const Pair xy_xz = k.z * dy + k.y * (dz0 + p.y * dyz);
    return std::max(length * (x[0] + p.x * (x[1] - x[0]) + (xy_xz[1] - xy_xz[0])), 0.0);
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
  Pair v_[4];  ///< at (y, z) = (0, 0), (1, 0), (0, 1) and (1, 1)
};

}  // namespace fogbow
