// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <cmath>
#include <iosfwd>
#include <vector>

#include "core/estimators/estimator.h"
#include "core/util/rng.h"
#include "mlt/picture_importance.h"

namespace fogbow {

/// A point of the unit hypercube that an estimator turns into contributions [Kelemen2002].
/// Coordinates that the estimator did not read are not stored: they are uniform whatever the rest
/// is.
class PrimarySample {
 public:
  explicit PrimarySample(const PictureImportance& importance = kUniformImportance)
      : importance_(&importance) {}

  const PictureImportance& importance() const { return *importance_; }
  /// Luminance of all contributions together, each times its importance.
  double f_star() const { return f_star_; }
  double log_f_star() const { return std::log(f_star_); }
  std::uint64_t selection_key() const { return 1; }
  /// Of the eye's subpath.
  Vec2 raster() const { return eye_.size() < 2 ? Vec2(0) : Vec2(eye_[0], eye_[1]); }
  /// The subpaths that the contributions are made of.
  const Workspace& workspace() const { return workspace_; }
  const std::vector<Contribution>& contributions() const { return workspace_.contributions; }
  const std::vector<double>& light() const { return light_; }
  const std::vector<double>& eye() const { return eye_; }

  /// Fresh uniform coordinates, evaluated.
  void draw(const Estimator& estimator, Rng& rng);
  /// Coordinates perturbed from those of `x` by the symmetric kernel of Kelemen et al., evaluated.
  void perturb(const Estimator& estimator, const PrimarySample& x, Rng& rng);

  /// Coordinates and the contributions they had.
  void serialize(std::ostream& out) const;
  static PrimarySample deserialize(std::istream& in,
                                   const PictureImportance& importance = kUniformImportance);

 private:
  void evaluate(const Estimator& estimator, SampleStream& light, SampleStream& eye);

  const PictureImportance* importance_;
  std::vector<double> light_, eye_;
  Workspace workspace_;
  double f_star_ = 0;
};

/// Offsets between 1/1024 and 1/64 with density ∝ 1/|offset|, wrapped around [Kelemen2002].
double perturb_primary_sample(double value, double u);

}  // namespace fogbow
