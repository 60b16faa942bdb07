// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <iosfwd>
#include <span>

#include "core/estimators/estimator.h"
#include "core/path/measured_path.h"
#include "mlt/mutation.h"
#include "mlt/primary_sample.h"

namespace fogbow {

/// A path as the state of a chain; its target is the luminance of f times the importance of where
/// it lies, without the seen light.
class PathSample {
 public:
  /// To be written; room for `max_vertices`.
  PathSample(const Scene& scene, int max_vertices,
             const PictureImportance& importance = kUniformImportance)
      : scene_(&scene), importance_(&importance) {
    path_.reserve(max_vertices);
  }

  /// One of the paths that a sample of BDPT without seen light holds, in proportion to its part of
  /// f*. Nothing, once in a long while, where rounding lets the path miss the film or be occluded
  /// when it is measured as a whole.
  static std::optional<PathSample> choose(const Scene& scene, int max_vertices,
                                          const PrimarySample& sample, double u);

  const Scene& scene() const { return *scene_; }
  const PictureImportance& importance() const { return *importance_; }
  MeasuredPath& path() { return path_; }
  const MeasuredPath& path() const { return path_; }

  /// The path of technique (s, t) over two subpaths, whose ends are joined here.
  std::optional<Rejection> assemble(const Subpath& light, int s, const Subpath& eye, int t);
  /// When every factor of path() is known: f, f* and the raster position; false off the film.
  bool settle();
  double log_f_star() const { return log_f_star_; }
  const Vec2& raster() const { return path_.raster(); }
  /// k, the kinds of vertices, whether rays run into x₁ and which edges lead through sampled media;
  /// 0 for long paths.
  std::uint64_t selection_key() const { return selection_key_; }
  /// One, of f but for a power of two.
  std::span<const Contribution> contributions() const { return {&contribution_, 1}; }

  void serialize(std::ostream& out) const;
  static PathSample deserialize(std::istream& in, const Scene& scene, int max_vertices,
                                const PictureImportance& importance = kUniformImportance);

 private:
  std::uint64_t key() const;

  const Scene* scene_;
  const PictureImportance* importance_;
  MeasuredPath path_;
  Contribution contribution_{};
  std::uint64_t selection_key_ = 0;
  double log_f_star_ = -std::numeric_limits<double>::infinity();
};

}  // namespace fogbow
