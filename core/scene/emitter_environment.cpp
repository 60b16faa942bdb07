// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/math/discrete_distribution.h"
#include "core/math/warp.h"
#include "core/scene/emitters.h"
#include "core/scene/parallel_light.h"

namespace fogbow {
namespace {

/// A picture of all directions: columns are azimuths, centred in their pixels, rows are polar
/// angles from the +y axis, the first and the last on the poles. Between four pixels the radiance
/// is bilinear; such cells are chosen by their flux, directions in them uniform in solid angle.
class EnvironmentMap {
 public:
  EnvironmentMap(const Image& image, double scale) : width_(image.width), height_(image.height) {
    if (width_ < 2 || height_ < 3)
      throw std::domain_error("an environment map needs at least 2x3 pixels");
    load(image, scale);
    for (int j = 0; j < height_; ++j) {
      const double half = 0.5 * kPi * j / (height_ - 1);
      from_top_.push_back(2 * sqr(std::sin(half)));
      from_bottom_.push_back(2 * sqr(std::cos(half)));
    }
    build_distribution();
  }

  /// ∫ L dσ.
  const RGB& flux() const { return flux_; }

  RGB radiance(const Vec3& d) const {
    const double x = azimuth(d) * width_ - 0.5, y = polar(d) * kInvPi * (height_ - 1);
    const int i = static_cast<int>(std::floor(x)),
              j = std::clamp(static_cast<int>(y), 0, rows() - 1);
    const double fx = x - i, fy = y - j;
    return (1 - fy) * ((1 - fx) * pixel(i, j) + fx * pixel(i + 1, j)) +
           fy * ((1 - fx) * pixel(i, j + 1) + fx * pixel(i + 1, j + 1));
  }

  Vec3 sample(const Vec2& u) const {
    const std::size_t j = by_row_.sample(u.y);
    const DiscreteDistribution& row = by_column_[j];
    const std::size_t i = row.sample(u.x);
    const double fy = within(by_row_, j, u.y), fx = within(row, i, u.x);
    const double turn = (static_cast<double>(i) + 0.5 + fx) / width_;
    const double top = from_top_[j] + fy * (from_top_[j + 1] - from_top_[j]);
    const double bottom = from_bottom_[j] + fy * (from_bottom_[j + 1] - from_bottom_[j]);
    const Vec3 w = warp::spherical_direction(std::min(top, bottom), turn);
    return {w.y, top < bottom ? w.z : -w.z, -w.x};
  }
  double pdf(const Vec3& d) const {
    const Place p = place(d);
    return by_row_.probability(p.j) * by_column_[p.j].probability(p.i) / solid_angle(p.j);
  }
  std::optional<Vec2> invert(const Vec3& d) const {
    const Place p = place(d);
    if (!(by_row_.probability(p.j) * by_column_[p.j].probability(p.i) > 0)) return std::nullopt;
    return Vec2(by_column_[p.j].invert(p.i, p.fx), by_row_.invert(p.j, p.fy));
  }

 private:
  /// A cell, and where in it: linear in azimuth and in the cosine.
  struct Place {
    std::size_t i, j;
    double fx, fy;
  };

  int rows() const { return height_ - 1; }
  const glm::vec3& texel(int i, int j) const {
    return pixels_[static_cast<std::size_t>(j) * width_ + (i + width_) % width_];
  }
  RGB pixel(int i, int j) const { return RGB(texel(i, j)); }
  double solid_angle(std::size_t j) const { return 2 * kPi / width_ * height_of(j); }
  /// Difference of the cosines.
  double height_of(std::size_t j) const {
    return 2 * static_cast<int>(j) < height_ - 1 ? from_top_[j + 1] - from_top_[j]
                                                 : from_bottom_[j] - from_bottom_[j + 1];
  }

  static double azimuth(const Vec3& d) { return warp::invert_azimuth(-d.z, d.x); }
  static double polar(const Vec3& d) { return std::atan2(std::hypot(d.x, d.z), d.y); }
  static double within(const DiscreteDistribution& law, std::size_t i, double u) {
    return warp::clamp_unit((u - law.invert(i, 0)) / law.probability(i));
  }

  void load(const Image& image, double scale) {
    const int gray = image.channels.size() < 3 ? 0 : -1;
    const std::array<int, 3> channel{gray < 0 ? image.channel("R") : gray,
                                     gray < 0 ? image.channel("G") : gray,
                                     gray < 0 ? image.channel("B") : gray};
    if (std::ranges::min(channel) < 0)
      throw std::domain_error("an environment map needs the channels R, G and B, or one alone");
    pixels_.reserve(static_cast<std::size_t>(width_) * height_);
    for (int j = 0; j < height_; ++j)
      for (int i = 0; i < width_; ++i) {
        glm::vec3 p;
        for (int c = 0; c < 3; ++c) p[c] = static_cast<float>(scale * image.at(i, j, channel[c]));
        if (!is_finite(RGB(p)) || p.x < 0 || p.y < 0 || p.z < 0)
          throw std::domain_error("an environment map's pixel " + std::to_string(i) + ", " +
                                  std::to_string(j) + " is negative or not finite");
        pixels_.push_back(p);
      }
  }

  /// Of one cell: ∫ L dσ with L linear in the polar angle.
  RGB cell_flux(int i, int j) const {
    const double step = kPi / rows(), top = j * step, bottom = top + step;
    const double below = (std::sin(bottom) - std::sin(top)) / step - std::cos(bottom);
    const double above = height_of(j) - below;
    return kPi / width_ *
           (above * (pixel(i, j) + pixel(i + 1, j)) +
            below * (pixel(i, j + 1) + pixel(i + 1, j + 1)));
  }

  void build_distribution() {
    std::vector<double> by_row, by_column;
    for (int j = 0; j < rows(); ++j) {
      by_column.clear();
      for (int i = 0; i < width_; ++i) {
        const RGB flux = cell_flux(i, j);
        flux_ += flux;
        by_column.push_back(luminance(flux));
      }
      by_column_.emplace_back(by_column);
      by_row.push_back(by_column_.back().total());
    }
    by_row_ = DiscreteDistribution(by_row);
    if (!(by_row_.total() > 0)) throw std::domain_error("an environment map is black");
  }

  Place place(const Vec3& d) const {
    Place p;
    const double x = azimuth(d) * width_ - 0.5, i = std::floor(x);
    p.i = static_cast<std::size_t>((static_cast<int>(i) + width_) % width_);
    p.fx = x - i;
    const bool upper = d.y >= 0;
    const double sine2 = d.x * d.x + d.z * d.z, from_pole = sine2 / (1 + std::fabs(d.y));
    const auto below = [&](std::size_t j) {  // whether d lies under the upper edge of row j
      return upper ? from_pole >= from_top_[j] : from_pole <= from_bottom_[j];
    };
    p.j = static_cast<std::size_t>(
        std::clamp(static_cast<int>(polar(d) * kInvPi * rows()), 0, rows() - 1));
    if (p.j > 0 && !below(p.j)) --p.j;
    if (p.j + 2 < from_top_.size() && below(p.j + 1)) ++p.j;
    const double into = upper ? from_pole - from_top_[p.j] : from_bottom_[p.j] - from_pole;
    p.fy = std::clamp(into / height_of(p.j), 0.0, 1.0);
    return p;
  }

  int width_, height_;
  std::vector<glm::vec3> pixels_;
  std::vector<double> from_top_, from_bottom_;  ///< 1 ∓ cosθ of each row of pixels
  std::vector<DiscreteDistribution> by_column_;
  DiscreteDistribution by_row_;
  RGB flux_{0};
};

class EnvironmentEmitter final : public ParallelLight {
 public:
  EnvironmentEmitter(const Image& image, const Transform& to_world, double scale)
      : map_(image, scale) {
    const double size = to_world.similarity_scale();
    if (!(size > 0))
      throw std::domain_error(
          "an environment map's \"to_world\" may rotate and mirror it, but not stretch or shear");
    axes_ = Mat3(to_world.matrix()) / size;
  }

  EmitterKind kind() const override { return EmitterKind::Infinite; }
  RGB power() const override { return area() * map_.flux(); }

  std::optional<EmitterPoint> sample_position(const Vec3& u) const override {
    const Vec3 d = map_.sample(Vec2(u));
    EmitterPoint x = point(-normalize(axes_ * d), 0);
    x.pdf_position = map_.pdf(to_map(x));
    return x;
  }
  double pdf_position(const EmitterPoint& x) const override { return map_.pdf(to_map(x)); }
  std::optional<Vec3> invert_position(const EmitterPoint& x, const Vec3& auxiliary) const override {
    const auto u = map_.invert(to_map(x));
    if (!u) return std::nullopt;
    return Vec3(*u, auxiliary.z);
  }

  RGB L_e(const EmitterPoint& x, const Vec3&) const override { return map_.radiance(to_map(x)); }

 private:
  /// Towards the light, in the axes of the map.
  Vec3 to_map(const EmitterPoint& x) const { return -(x.surface.n_g * axes_); }

  EnvironmentMap map_;
  Mat3 axes_;
};

}  // namespace

std::shared_ptr<Emitter> make_environment_emitter(const Image& image, const Transform& to_world,
                                                  double scale) {
  return std::make_shared<EnvironmentEmitter>(image, to_world, scale);
}

}  // namespace fogbow
