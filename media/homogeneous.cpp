// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>
#include <utility>

#include "media/media.h"

namespace fogbow {
namespace {

class Homogeneous final : public Medium {
 public:
  Homogeneous(const RGB& sigma_t, const RGB& albedo, std::shared_ptr<const PhaseFunction> phase,
              const RGB& emission, std::string id)
      : Medium(std::move(phase), std::move(id)),
        sigma_t_(sigma_t),
        sigma_s_(sigma_t * albedo),
        emission_(emission) {}

  RGB sigma_t(const Vec3&) const override { return sigma_t_; }
  RGB sigma_s(const Vec3&) const override { return sigma_s_; }
  RGB emission(const Vec3&) const override { return emission_; }
  bool scatters() const override { return !is_black(sigma_s_); }
  bool emits() const override { return !is_black(emission_); }

  RGB optical_depth(const Ray&, double t0, double t1) const override {
    const double length = t1 - t0;
    if (length != kInfinity) return sigma_t_ * length;
    return {depth_at_infinity(sigma_t_.x), depth_at_infinity(sigma_t_.y),
            depth_at_infinity(sigma_t_.z)};
  }
  FlightEnd fly(const Ray& ray, double t0, double t1, int channel, double target) const override {
    const double sigma = sigma_t_[channel];
    const double t = sigma > 0 ? t0 + target / sigma : kInfinity;
    const bool inside = t < t1;
    const double end = inside ? t : t1;
    return {end, inside, optical_depth(ray, t0, end)};
  }
  RGB max_emission(const Bounds&) const override { return emission_; }
  Majorant majorant(const Ray&, double, double t1) const override {
    return {t1, max_component(sigma_t_)};
  }

 private:
  static double depth_at_infinity(double sigma) { return sigma > 0 ? kInfinity : 0.0; }

  RGB sigma_t_, sigma_s_, emission_;
};

void check_coefficients(const RGB& sigma_t, const RGB& albedo, const RGB& emission) {
  for (int i = 0; i < 3; ++i) {
    if (!(sigma_t[i] >= 0 && std::isfinite(sigma_t[i])))
      throw std::domain_error("sigma_t must be finite and not negative");
    if (!(albedo[i] >= 0 && albedo[i] <= 1))
      throw std::domain_error("the albedo of a medium must lie in [0, 1]");
    if (!(emission[i] >= 0 && std::isfinite(emission[i])))
      throw std::domain_error("the emission of a medium must be finite and not negative");
  }
  if (!is_black(emission) && is_black(sigma_t))
    throw std::domain_error("a medium that emits needs sigma_t > 0 in some channel");
}

}  // namespace

std::shared_ptr<const Medium> make_homogeneous_medium(const RGB& sigma_t, const RGB& albedo,
                                                      std::shared_ptr<const PhaseFunction> phase,
                                                      const RGB& emission, std::string id) {
  check_coefficients(sigma_t, albedo, emission);
  return std::make_shared<Homogeneous>(sigma_t, albedo, std::move(phase), emission, std::move(id));
}

}  // namespace fogbow
