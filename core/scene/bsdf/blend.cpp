// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include "core/scene/bsdf/bsdfs.h"
#include "core/scene/bsdf/lobes.h"
#include "core/scene/bsdf/reflecting.h"

namespace fogbow {
namespace {

/// (1 − weight) of one BSDF and `weight` of another; Base says whether it only reflects.
template <class Base>
class Blend final : public Base {
 public:
  Blend(std::shared_ptr<const Bsdf> first, std::shared_ptr<const Bsdf> second,
        const Textured<double>& weight)
      : parts_{std::move(first), std::move(second)}, weight_(weight) {}

  bool has_smooth() const override { return parts_[0]->has_smooth() || parts_[1]->has_smooth(); }
  bool has_dirac() const override { return parts_[0]->has_dirac() || parts_[1]->has_dirac(); }
  bool has_passage() const override { return parts_[0]->has_passage() || parts_[1]->has_passage(); }
  RGB passage(const SurfacePoint& x, const Vec3& w) const override {
    return sum<RGB>(x, [&](const Bsdf& b) { return b.passage(x, w); });
  }
  RGB f_s(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return sum<RGB>(x, [&](const Bsdf& b) { return b.f_s(x, w_light, w_eye); });
  }
  RGB f_dirac(const SurfacePoint& x, const Vec3& w_light, const Vec3& w_eye) const override {
    return sum<RGB>(x, [&](const Bsdf& b) { return b.f_dirac(x, w_light, w_eye); });
  }
  double pdf_sigma(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    const LobeChoice<2> lobes = choice(x, from);
    return lobes.probability(0) * parts_[0]->pdf_sigma(x, from, to) +
           lobes.probability(1) * parts_[1]->pdf_sigma(x, from, to);
  }
  double pdf_dirac(const SurfacePoint& x, const Vec3& from, const Vec3& to) const override {
    const LobeChoice<2> lobes = choice(x, from);
    return lobes.probability(0) * parts_[0]->pdf_dirac(x, from, to) +
           lobes.probability(1) * parts_[1]->pdf_dirac(x, from, to);
  }
  std::optional<BsdfSample> sample(const SurfacePoint& x, const Vec3& from,
                                   const Vec3& u) const override {
    Vec3 u_part = u;
    const std::size_t part = choice(x, from).choose(u_part.x);
    auto result = parts_[part]->sample(x, from, u_part);
    if (result)
      result->pdf_sigma =
          result->dirac ? pdf_dirac(x, from, result->w) : pdf_sigma(x, from, result->w);
    return result;
  }
  std::optional<Vec3> invert(const SurfacePoint& x, const Vec3& from, const Vec3& to, bool dirac,
                             const Vec3& auxiliary) const override {
    const LobeChoice<2> prior = choice(x, from);
    LobeChoice<2> posterior = prior;
    for (std::size_t i = 0; i < 2; ++i)
      posterior.weights[i] *=
          dirac ? parts_[i]->pdf_dirac(x, from, to) : parts_[i]->pdf_sigma(x, from, to);
    if (!(posterior.total() > 0)) return std::nullopt;
    Vec3 auxiliary_part = auxiliary;
    const std::size_t part = posterior.choose(auxiliary_part.x);
    auto u = parts_[part]->invert(x, from, to, dirac, auxiliary_part);
    if (u) u->x = prior.place(part, u->x);
    return u;
  }

  double eta() const override {
    return parts_[0]->eta() != 1 ? parts_[0]->eta() : parts_[1]->eta();
  }
  RGB albedo(const SurfacePoint& x) const override {
    return sum<RGB>(x, [&](const Bsdf& b) { return b.albedo(x); });
  }
  const char* name() const override { return "blendbsdf"; }

 private:
  /// By how much of the light each part stops.
  LobeChoice<2> choice(const SurfacePoint& x, const Vec3& from) const {
    const double w = weight_(x);
    LobeChoice<2> lobes{{1 - w, w}};
    for (std::size_t i = 0; i < 2; ++i)
      if (parts_[i]->has_passage()) lobes.weights[i] *= 1 - mean(parts_[i]->passage(x, from));
    // Where all passes nothing is sampled; any choice will do.
    return lobes.total() > 0 ? lobes : LobeChoice<2>{{1, 0}};
  }
  template <class T, class Part>
  T sum(const SurfacePoint& x, Part&& part) const {
    const double w = weight_(x);
    return (1 - w) * part(*parts_[0]) + w * part(*parts_[1]);
  }

  std::shared_ptr<const Bsdf> parts_[2];
  Textured<double> weight_;
};

bool reflects_only(const std::shared_ptr<const Bsdf>& bsdf) {
  return dynamic_cast<const ReflectingBsdf*>(bsdf.get()) != nullptr;
}

/// Directions and formal deltas inside mean the same to b as to a, or b has nothing to do with
/// them.
bool agree(const std::shared_ptr<const Bsdf>& a, const std::shared_ptr<const Bsdf>& b) {
  return a->eta() == b->eta() || a->eta() == 1 || reflects_only(b) ||
         (!b->has_smooth() && !b->has_dirac());
}

}  // namespace

std::shared_ptr<const Bsdf> make_blend(std::shared_ptr<const Bsdf> first,
                                       std::shared_ptr<const Bsdf> second,
                                       const Textured<double>& weight) {
  if (!first || !second) throw std::domain_error("a blend needs two BSDFs");
  if (const auto range = weight.range(); !(range.least >= 0 && range.greatest <= 1))
    throw std::domain_error("the weight of a blend must lie in [0, 1]");
  if (!agree(first, second) || !agree(second, first))
    throw std::domain_error("the two BSDFs of a blend differ in index of refraction");
  if (reflects_only(first) && reflects_only(second))
    return std::make_shared<Blend<ReflectingBsdf>>(std::move(first), std::move(second), weight);
  return std::make_shared<Blend<Bsdf>>(std::move(first), std::move(second), weight);
}

}  // namespace fogbow
