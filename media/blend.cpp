// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdexcept>
#include <utility>

#include "core/math/warp.h"
#include "media/media.h"

namespace fogbow {
namespace {

/// (1 − weight) · first + weight · second; u.x below 1 − weight chooses the first.
class Blend final : public PhaseFunction {
 public:
  Blend(std::shared_ptr<const PhaseFunction> first, std::shared_ptr<const PhaseFunction> second,
        double weight)
      : first_(std::move(first)), second_(std::move(second)), weight_(weight) {
    if (!(weight >= 0 && weight <= 1))
      throw std::domain_error("the weight of a blend must lie in [0, 1]");
  }

  RGB f_p(const Vec3& from, const Vec3& to) const override {
    return (1 - weight_) * first_->f_p(from, to) + weight_ * second_->f_p(from, to);
  }
  double pdf_sigma(const Vec3& from, const Vec3& to) const override {
    return (1 - weight_) * first_->pdf_sigma(from, to) + weight_ * second_->pdf_sigma(from, to);
  }
  Vec3 sample(const Vec3& from, const Vec3& u) const override {
    const double border = 1 - weight_;
    if (u.x < border) return first_->sample(from, {warp::clamp_unit(u.x / border), u.y, u.z});
    return second_->sample(from, {warp::clamp_unit((u.x - border) / weight_), u.y, u.z});
  }
  /// The lobe is drawn from its posterior, what is left of its auxiliary serves the lobe itself.
  std::optional<Vec3> invert(const Vec3& from, const Vec3& to,
                             const Vec3& auxiliary) const override {
    const double border = 1 - weight_;
    const double first = border * first_->pdf_sigma(from, to);
    const double total = first + weight_ * second_->pdf_sigma(from, to);
    if (!(total > 0)) return std::nullopt;
    const double posterior = first / total;
    const bool chosen = auxiliary.x < posterior;
    const double rest =
        chosen ? auxiliary.x / posterior : (auxiliary.x - posterior) / (1 - posterior);
    auto u = (chosen ? first_ : second_)
                 ->invert(from, to, {warp::clamp_unit(rest), auxiliary.y, auxiliary.z});
    if (u)
      u->x =
          chosen ? warp::invert_interval(0, border, u->x) : warp::invert_interval(border, 1, u->x);
    return u;
  }
  double mean_cosine() const override {
    return (1 - weight_) * first_->mean_cosine() + weight_ * second_->mean_cosine();
  }

 private:
  std::shared_ptr<const PhaseFunction> first_, second_;
  double weight_;
};

}  // namespace

std::shared_ptr<const PhaseFunction> make_blend_phase(std::shared_ptr<const PhaseFunction> first,
                                                      std::shared_ptr<const PhaseFunction> second,
                                                      double weight) {
  return std::make_shared<Blend>(std::move(first), std::move(second), weight);
}

}  // namespace fogbow
