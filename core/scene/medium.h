// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/math/ray.h"
#include "core/math/vec.h"
#include "core/scene/phase_function.h"

namespace fogbow {

/// A participating medium; coefficients per world unit of length. Vacuum is a null pointer.
class Medium {
 public:
  explicit Medium(std::shared_ptr<const PhaseFunction> phase, std::string id = {})
      : phase_(std::move(phase)), id_(std::move(id)) {}
  virtual ~Medium() = default;

  virtual RGB sigma_t(const Vec3& p) const = 0;
  virtual RGB sigma_s(const Vec3& p) const = 0;
  /// Emitted radiance per unit length, L_e where c₁ = 1.
  virtual RGB emission(const Vec3& p) const = 0;
  virtual bool scatters() const = 0;
  virtual bool emits() const = 0;

  /// ∫σ_t dt over [t0, t1] of the ray, exactly; t1 may be infinite.
  virtual RGB optical_depth(const Ray& ray, double t0, double t1) const = 0;
  /// The t in (t0, t1) where the optical depth from t0 in one channel equals `target` ≥ 0; nothing
  /// if t1 comes first.
  virtual std::optional<double> distance(const Ray& ray, double t0, double t1, int channel,
                                         double target) const = 0;

  const PhaseFunction& phase() const { return *phase_; }
  const std::string& id() const { return id_; }

 private:
  std::shared_ptr<const PhaseFunction> phase_;
  std::string id_;
};

}  // namespace fogbow
