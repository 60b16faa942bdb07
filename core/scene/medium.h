// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once
#include <memory>
#include <optional>
#include <string>

#include "core/math/ray.h"
#include "core/math/vec.h"
#include "core/scene/phase_function.h"

namespace fogbow {

/// Where a free flight ends.
struct FlightEnd {
  double t;
  bool inside;     ///< in the medium; else it came through
  RGB depth{0.0};  ///< optical depth on the way, in all channels
};

/// A bound of σ_t, in all channels, from where it was asked for to `end`.
struct Majorant {
  double end;
  double sigma_t;
};

struct Coefficients {
  RGB sigma_t, sigma_s;
};

/// A participating medium; coefficients per world unit of length. Vacuum is a null pointer.
class Medium {
 public:
  explicit Medium(std::shared_ptr<const PhaseFunction> phase, std::string id = {})
      : phase_(std::move(phase)), id_(std::move(id)) {}
  virtual ~Medium() = default;

  virtual RGB sigma_t(const Vec3& p) const = 0;
  virtual RGB sigma_s(const Vec3& p) const = 0;
  /// Both at once.
  virtual Coefficients coefficients(const Vec3& p) const { return {sigma_t(p), sigma_s(p)}; }
  /// Emitted radiance per unit length, L_e where c₁ = 1; 0 where σ_t is, for no flight ends there.
  virtual RGB emission(const Vec3& p) const = 0;
  virtual bool scatters() const = 0;
  virtual bool emits() const = 0;

  /// ∫σ_t dt over [t0, t1] of the ray, exactly; t1 may be infinite.
  virtual RGB optical_depth(const Ray& ray, double t0, double t1) const = 0;
  /// To the t in (t0, t1) where the optical depth from t0 in one channel equals `target` ≥ 0, or to
  /// t1 if that comes first.
  virtual FlightEnd fly(const Ray& ray, double t0, double t1, int channel, double target) const = 0;
  /// Where the flight ends; nothing if that is t1.
  std::optional<double> distance(const Ray& ray, double t0, double t1, int channel,
                                 double target) const {
    const FlightEnd end = fly(ray, t0, t1, channel, target);
    return end.inside ? std::optional(end.t) : std::nullopt;
  }

  /// Whether coefficients depend on the place: optical depths then cost more than rays.
  virtual bool is_heterogeneous() const { return false; }
  /// Where σ_t can be positive.
  virtual Bounds support() const { return {Vec3(-kInfinity), Vec3(kInfinity)}; }
  /// A bound of the emission within a box; by how much it is too high only costs time.
  virtual RGB max_emission(const Bounds& box) const = 0;
  /// From t on, t < t1.
  virtual Majorant majorant(const Ray& ray, double t, double t1) const = 0;
  virtual std::size_t memory_bytes() const { return 0; }

  const PhaseFunction& phase() const { return *phase_; }
  const std::string& id() const { return id_; }

 private:
  std::shared_ptr<const PhaseFunction> phase_;
  std::string id_;
};

}  // namespace fogbow
