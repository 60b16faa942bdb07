// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "media/axial_phase.h"
#include "media/media.h"

namespace fogbow {
namespace {

class Isotropic final : public PhaseFunction {
 public:
  RGB f_p(const Vec3&, const Vec3&) const override { return RGB(warp::pdf_sphere()); }
  double pdf_sigma(const Vec3&, const Vec3&) const override { return warp::pdf_sphere(); }
  Vec3 sample(const Vec3&, const Vec3& u) const override { return warp::sample_sphere({u.y, u.z}); }
  std::optional<Vec3> invert(const Vec3&, const Vec3& to, const Vec3& auxiliary) const override {
    const Vec2 u = warp::invert_sphere(to);
    return Vec3(auxiliary.x, u.x, u.y);
  }
  double mean_cosine() const override { return 0; }
};

class HenyeyGreenstein final : public AxialPhase {
 public:
  explicit HenyeyGreenstein(double g) : g_(g) {
    if (!(g > -1 && g < 1)) throw std::domain_error("the mean cosine g must lie in (-1, 1)");
  }
  double mean_cosine() const override { return g_; }

 private:
  double density(const warp::PolarAngle& angle) const override {
    return warp::pdf_henyey_greenstein(g_, angle.one_minus_cos, angle.one_plus_cos);
  }
  warp::PolarAngle sample_angle(double u) const override {
    return warp::sample_henyey_greenstein_angle(u, g_);
  }
  double invert_angle(const warp::PolarAngle& angle) const override {
    return warp::invert_henyey_greenstein(g_, angle.one_minus_cos, angle.one_plus_cos);
  }

  double g_;
};

}  // namespace

std::shared_ptr<const PhaseFunction> make_isotropic_phase() {
  return std::make_shared<Isotropic>();
}

std::shared_ptr<const PhaseFunction> make_henyey_greenstein(double g) {
  return std::make_shared<HenyeyGreenstein>(g);
}

}  // namespace fogbow
