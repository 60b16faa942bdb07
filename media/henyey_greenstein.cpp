// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>

#include "core/math/frame.h"
#include "core/math/warp.h"
#include "media/media.h"

namespace fogbow {
namespace {

class Isotropic final : public PhaseFunction {
 public:
  RGB f_p(const Vec3&, const Vec3&) const override { return RGB(warp::pdf_sphere()); }
  double pdf_sigma(const Vec3&, const Vec3&) const override { return warp::pdf_sphere(); }
  Vec3 sample(const Vec3&, const Vec2& u) const override { return warp::sample_sphere(u); }
  Vec2 invert(const Vec3&, const Vec3& to) const override { return warp::invert_sphere(to); }
  double mean_cosine() const override { return 0; }
};

/// Directions point away from the vertex, so light goes on straight where to = −from: 1 − cosθ =
/// |from + to|²/2.
class HenyeyGreenstein final : public PhaseFunction {
 public:
  explicit HenyeyGreenstein(double g) : g_(g) {
    if (!(g > -1 && g < 1)) throw std::domain_error("the mean cosine g must lie in (-1, 1)");
  }

  RGB f_p(const Vec3& from, const Vec3& to) const override { return RGB(pdf_sigma(from, to)); }
  double pdf_sigma(const Vec3& from, const Vec3& to) const override {
    return warp::pdf_henyey_greenstein(g_, one_minus_cos(from, to), one_plus_cos(from, to));
  }
  Vec3 sample(const Vec3& from, const Vec2& u) const override {
    return Frame(-from).to_world(warp::sample_henyey_greenstein(u, g_));
  }
  Vec2 invert(const Vec3& from, const Vec3& to) const override {
    const Frame frame(-from);
    return {warp::invert_henyey_greenstein(g_, one_minus_cos(from, to), one_plus_cos(from, to)),
            warp::invert_azimuth(dot(to, frame.s), dot(to, frame.t))};
  }
  double mean_cosine() const override { return g_; }

 private:
  static double one_minus_cos(const Vec3& a, const Vec3& b) { return 0.5 * length_squared(a + b); }
  static double one_plus_cos(const Vec3& a, const Vec3& b) { return 0.5 * length_squared(a - b); }

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
