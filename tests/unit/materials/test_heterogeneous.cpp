// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "core/math/random.h"
#include "core/math/warp.h"
#include "media/media.h"
#include "media/null_collision.h"
#include "tests/helpers/statistics.h"
#include "tests/helpers/triples.h"

namespace fogbow {
namespace {

using enum VolumeFilter;
using enum VolumeWrap;

/// Voxels of which many are zero, in all channels or in some, with an empty region and a uniform
/// one, each larger than a block.
VoxelData patchy(std::array<int, 3> size, int channels, std::uint64_t stream) {
  Rng rng(testing::suite_seed(), RngDomain::Test, stream, 0);
  VoxelData data{size, channels, {}};
  for (int z = 0; z < size[2]; ++z)
    for (int y = 0; y < size[1]; ++y)
      for (int x = 0; x < size[0]; ++x)
        for (int c = 0; c < channels; ++c) {
          double v = rng.uniform() < 0.4 ? 0 : rng.uniform();
          if (x < size[0] / 2 && z < size[2] / 2) v = 0;
          if (x >= size[0] / 2 && z >= size[2] / 2) v = 0.25 * (c + 1);
          data.values.push_back(static_cast<float>(v));
        }
  return data;
}

std::shared_ptr<const Medium> medium(std::shared_ptr<const Volume> sigma_t, double scale = 1,
                                     const RGB& albedo = RGB(0.5),
                                     std::shared_ptr<const Volume> emission = nullptr) {
  return make_heterogeneous_medium(
      {std::move(sigma_t), scale, std::make_shared<Volume>(albedo), std::move(emission)},
      make_isotropic_phase());
}

struct Case {
  std::string name;
  VoxelData data;
  VolumeSettings settings;
  std::shared_ptr<const Medium> m;
  double unit;  ///< of length
  std::shared_ptr<const Volume> volume;
};

std::vector<Case> cases() {
  Mat4 sheared(1.0);
  sheared[1][0] = 0.6;
  sheared[0][2] = -0.3;
  const Transform rotated = Transform::rotate(Vec3(1, 2, -1), 40);
  const Transform mirrored = Transform::scale(Vec3(-1, 1.5, 0.7));
  std::vector<Case> result;
  std::uint64_t stream = 1000;
  for (const VolumeFilter filter : {Trilinear, Nearest})
    for (const VolumeWrap wrap : {Clamp, Repeat, Mirror})
      for (const int channels : {1, 3})
        for (const auto& [name, to_world] : {std::pair{"unit cube", Transform()},
                                             {"rotated", rotated},
                                             {"sheared", Transform(sheared)},
                                             {"mirrored", mirrored}})
          for (const double unit : {1.0, 1000.0}) {
            Case c;
            c.name = std::string(name) + (filter == Nearest ? " nearest" : "") + " wrap " +
                     std::to_string(static_cast<int>(wrap)) + " channels " +
                     std::to_string(channels) + " unit " + std::to_string(unit);
            c.data = patchy({19, 23, 17}, channels, stream);
            c.settings = {Transform::scale(Vec3(unit)) * to_world, filter, wrap};
            c.volume = std::make_shared<Volume>(c.data, c.settings);
            c.m = medium(c.volume, 7 / unit);
            c.unit = unit;
            result.push_back(std::move(c));
            stream += unit == 1000;
          }
  return result;
}

/// Between all planes of the lattice that the ray crosses, found and sorted without walking, by
/// three-point Gauss quadrature of what the medium has at points.
RGB depth_by_quadrature(const Case& c, const Ray& ray, double t0, double t1) {
  const Transform to_local = c.settings.to_world.inverse();
  const Vec3 o = to_local.point(ray.o), d = to_local.vector(ray.d);
  if (!clip(c.volume->bounds(), ray, t0, t1)) return RGB(0);
  std::vector<double> cuts{t0, t1};
  const double shift = c.settings.filter == Trilinear ? 0.5 : 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int plane = -100; plane <= 150; ++plane) {
      const double t = ((plane + shift) / c.data.size[axis] - o[axis]) / d[axis];
      if (t > t0 && t < t1) cuts.push_back(t);
    }
  std::ranges::sort(cuts);
  RGB sum(0);
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    const double half = 0.5 * (cuts[i] - cuts[i - 1]), middle = cuts[i - 1] + half;
    const double node = std::sqrt(0.6) * half;
    sum += half / 9 *
           (5.0 * c.m->sigma_t(ray(middle - node)) + 8.0 * c.m->sigma_t(ray(middle)) +
            5.0 * c.m->sigma_t(ray(middle + node)));
  }
  return sum;
}

/// Through the medium's box, from outside of it, with |t| of its size.
Ray random_ray(const Case& c, Rng& rng) {
  const Bounds& b = c.volume->bounds();
  const Vec3 through = b.lo + uniform3(rng) * b.diagonal(), w = warp::sample_sphere(uniform2(rng));
  return {through - 2 * b.radius() * w, w};
}

void expect_near(const RGB& a, const RGB& b, double tolerance, const std::string& what) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(a[c], b[c], tolerance * std::max(1.0, b[c])) << what;
}

TEST(Heterogeneous, OpticalDepthIsTheIntegralOfTheField) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 901, 0);
  for (const Case& c : cases())
    for (int i = 0; i < 40; ++i) {
      const Ray ray = random_ray(c, rng);
      const double most = 4 * c.volume->bounds().radius();
      expect_near(c.m->optical_depth(ray, 0, kInfinity), depth_by_quadrature(c, ray, 0, kInfinity),
                  1e-12, c.name);
      // Ends anywhere: inside, outside, on either side.
      double t0 = most * rng.uniform(), t1 = most * rng.uniform();
      if (t0 > t1) std::swap(t0, t1);
      expect_near(c.m->optical_depth(ray, t0, t1), depth_by_quadrature(c, ray, t0, t1), 1e-12,
                  c.name);
    }
}

TEST(Heterogeneous, OpticalDepthAddsUpAndIsTheSameBackwards) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 902, 0);
  for (const Case& c : cases())
    for (int i = 0; i < 20; ++i) {
      const Ray ray = random_ray(c, rng);
      const double most = 4 * c.volume->bounds().radius(), t = most * rng.uniform();
      const RGB whole = c.m->optical_depth(ray, 0, most);
      expect_near(c.m->optical_depth(ray, 0, t) + c.m->optical_depth(ray, t, most), whole, 1e-12,
                  c.name);
      expect_near(c.m->optical_depth({ray(most), -ray.d}, 0, most), whole, 1e-11, c.name);
      EXPECT_EQ(c.m->optical_depth(ray, 0, most), whole);
    }
}

/// Lengths in other units give the same depths.
TEST(Heterogeneous, UnitsOfLengthDoNotMatter) {
  const auto all = cases();
  for (std::size_t i = 0; i + 1 < all.size(); i += 2) {
    const Case &a = all[i], &b = all[i + 1];
    ASSERT_EQ(a.data.values, b.data.values);
    Rng rng(testing::suite_seed(), RngDomain::Test, 903, 0);
    for (int j = 0; j < 10; ++j) {
      const Ray ray = random_ray(a, rng);
      expect_near(b.m->optical_depth({b.unit * ray.o, ray.d}, 0, kInfinity),
                  a.m->optical_depth(ray, 0, kInfinity), 1e-11, a.name);
    }
  }
}

TEST(Heterogeneous, FlightInvertsOpticalDepth) {
  Rng rng(testing::suite_seed(), RngDomain::Test, 904, 0);
  int ended = 0;
  for (const Case& c : cases())
    for (int i = 0; i < 40; ++i) {
      const Ray ray = random_ray(c, rng);
      const double r = c.volume->bounds().radius();
      const double t0 = 3 * r * rng.uniform(), t1 = t0 + 3 * r * rng.uniform();
      const RGB whole = c.m->optical_depth(ray, t0, t1);
      for (int channel = 0; channel < 3; ++channel) {
        const double target = rng.uniform() * whole[channel];
        const FlightEnd end = c.m->fly(ray, t0, t1, channel, target);
        if (target < whole[channel] * (1 - 1e-9)) {
          ASSERT_TRUE(end.inside) << c.name;
          ASSERT_TRUE(end.t >= t0 && end.t <= t1);
          ++ended;
        }
        expect_near(end.depth, c.m->optical_depth(ray, t0, end.t), 1e-12, c.name);
        if (!end.inside) continue;
        EXPECT_NEAR(end.depth[channel], target, 1e-13 * (1 + whole[channel])) << c.name;
        // Where σ_t is not tiny, t itself is found.
        const double sigma = c.m->sigma_t(ray(end.t))[channel];
        const auto again =
            c.m->fly(ray, t0, t1, channel, c.m->optical_depth(ray, t0, end.t)[channel]);
        if (sigma * r > 1e-2) {
          ASSERT_TRUE(again.inside);
          EXPECT_NEAR(again.t, end.t, 1e-10 * r) << c.name;
        }
      }
      for (int channel = 0; channel < 3; ++channel) {
        const FlightEnd through = c.m->fly(ray, t0, t1, channel, whole[channel] + 1e-9);
        EXPECT_FALSE(through.inside);
        EXPECT_EQ(through.t, t1);
        EXPECT_EQ(through.depth, whole);
      }
    }
  EXPECT_GT(ended, 3000);
}

/// Exactly on faces, edges and corners of cells and of the box, parallel to axes and not.
TEST(Heterogeneous, RaysThroughFacesEdgesAndCorners) {
  // Powers of two keep the lattice on representable numbers.
  const VoxelData data = patchy({16, 16, 16}, 1, 950);
  for (const VolumeFilter filter : {Trilinear, Nearest}) {
    Case c{"grid", data, {Transform::scale(Vec3(16)), filter, Clamp}, nullptr, 1, nullptr};
    c.volume = std::make_shared<Volume>(c.data, c.settings);
    c.m = medium(c.volume);
    const double diagonal = std::sqrt(1.0 / 3), edge = std::sqrt(0.5);
    const Vec3 directions[] = {{1, 0, 0},       {0, -1, 0},       {0, 0, 1},
                               {edge, edge, 0}, {-edge, 0, edge}, {diagonal, -diagonal, diagonal}};
    for (const Vec3& w : directions)
      for (const double x : {0.0, 0.5, 4.0, 8.0, 8.5, 15.5, 16.0})
        for (const double y : {0.0, 3.5, 8.0, 16.0})
          for (const double z : {0.0, 6.5, 8.0, 16.0}) {
            const Ray ray{Vec3(x, y, z), w};
            // Next to it, where no rounding decides; a face between voxels counts for either side.
            RGB lo(kInfinity), hi(0);
            for (int corner = 0; corner < 8; ++corner) {
              const Vec3 aside(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
              const Vec3 tilt = 1e-9 * aside;
              const RGB near = depth_by_quadrature(c, {ray.o + tilt, w + 1e-13 * aside}, 0, 100);
              lo = glm::min(lo, near);
              hi = glm::max(hi, near);
            }
            const RGB depth = c.m->optical_depth(ray, 0, 100);
            EXPECT_TRUE(depth.x >= lo.x - 1e-6 && depth.x <= hi.x + 1e-6)
                << depth.x << " not in " << lo.x << " … " << hi.x << " from " << x << " " << y
                << " " << z << " along " << w.x << " " << w.y << " " << w.z;
          }
  }
}

/// A grid of equal voxels is a homogeneous medium within its box.
TEST(Heterogeneous, EqualVoxelsAreAHomogeneousMedium) {
  const RGB sigma_t(0.5, 0, 2.25);
  VoxelData data{{9, 20, 5}, 3, {}};
  for (int i = 0; i < 9 * 20 * 5; ++i)
    for (int c = 0; c < 3; ++c) data.values.push_back(static_cast<float>(sigma_t[c]));
  const auto uniform = make_homogeneous_medium(2.0 * sigma_t, RGB(0.5), make_isotropic_phase());
  const Transform to_world = Transform::translate(Vec3(-2)) * Transform::scale(Vec3(4));
  for (const auto& volume : {std::make_shared<Volume>(data, VolumeSettings{to_world}),
                             std::make_shared<Volume>(sigma_t, to_world)}) {
    const auto m = medium(volume, 2);
    Rng rng(testing::suite_seed(), RngDomain::Test, 905, 0);
    for (int i = 0; i < 200; ++i) {
      const Ray ray{uniform3(rng) - 0.5, warp::sample_sphere(uniform2(rng))};
      EXPECT_EQ(m->sigma_t(ray.o), uniform->sigma_t(ray.o));
      EXPECT_EQ(m->sigma_s(ray.o), uniform->sigma_s(ray.o));
      EXPECT_EQ(m->coefficients(ray.o).sigma_t, m->sigma_t(ray.o));
      EXPECT_EQ(m->coefficients(ray.o).sigma_s, m->sigma_s(ray.o));
      const double t1 = rng.uniform();
      expect_near(m->optical_depth(ray, 0, t1), uniform->optical_depth(ray, 0, t1), 1e-14, "");
      for (int channel = 0; channel < 3; ++channel) {
        const double target = rng.uniform();
        const FlightEnd a = m->fly(ray, 0, t1, channel, target);
        const FlightEnd b = uniform->fly(ray, 0, t1, channel, target);
        EXPECT_EQ(a.inside, b.inside);
        EXPECT_NEAR(a.t, b.t, 1e-14);
        expect_near(a.depth, b.depth, 1e-14, "");
      }
    }
    EXPECT_EQ(m->optical_depth({Vec3(3, 0, 0), Vec3(1, 0, 0)}, 0, kInfinity), RGB(0));
    EXPECT_EQ(m->sigma_t(Vec3(3, 0, 0)), RGB(0)) << "as in Mitsuba, nothing lies beyond the box";
    expect_near(m->optical_depth({Vec3(-3, 0, 0), Vec3(1, 0, 0)}, 0, kInfinity), 8.0 * sigma_t,
                1e-14, "");
  }
}

/// Free flight in a channel drawn uniformly, as in a homogeneous medium.
TEST(Heterogeneous, ChromaticFreeFlight) {
  std::uint64_t stream = 960;
  for (const VolumeFilter filter : {Trilinear, Nearest}) {
    VoxelData data = patchy({5, 4, 6}, 3, stream++);
    const auto volume = std::make_shared<Volume>(
        data, VolumeSettings{Transform::rotate(Vec3(1, 0, 1), 30), filter, Clamp});
    const auto m = medium(volume, 5);
    const Bounds& box = volume->bounds();
    const Vec3 through = box.lo + Vec3(0.45, 0.5, 0.6) * box.diagonal();
    const Vec3 w = normalize(Vec3(0.7, 0.3, 0.9));
    const Ray ray{through - w, w};
    const double wall = 2.1;
    const auto density = [&](int channel, double t) {
      return m->sigma_t(ray(t))[channel] * std::exp(-m->optical_depth(ray, 0, t)[channel]);
    };
    const testing::Triple flight{
        2,
        [&](const Vec3& u) -> std::optional<Vec3> {
          const auto t = m->distance(ray, 0, wall, static_cast<int>(3 * u.x), -std::log1p(-u.y));
          if (!t) return std::nullopt;
          return Vec3(*t, 0, 0);
        },
        [&](const Vec3& x) { return (density(0, x.x) + density(1, x.x) + density(2, x.x)) / 3; },
        [&](const Vec3& x, const Vec3& auxiliary) -> std::optional<Vec3> {
          const double total = density(0, x.x) + density(1, x.x) + density(2, x.x);
          if (!(total > 0)) return std::nullopt;
          double rest = auxiliary.x * total;
          int channel = 0;
          while (channel < 2 && rest >= density(channel, x.x)) rest -= density(channel++, x.x);
          const double within = std::fmin(rest / density(channel, x.x), kOneMinusEpsilon);
          return Vec3(std::fmin((channel + within) / 3, kOneMinusEpsilon),
                      -std::expm1(-m->optical_depth(ray, 0, x.x)[channel]), 0);
        }};
    const RGB through_all = glm::exp(-m->optical_depth(ray, 0, wall));
    EXPECT_GT(1 - mean(through_all), 0.3);
    EXPECT_EQ(
        testing::check_triple("flight through voxels", flight, testing::interval_chart(0, wall),
                              {.mass = 1 - mean(through_all), .tolerance = 1e-9}),
        "");
  }
}

/// What null collisions find on average is what regular tracking finds at once.
TEST(Heterogeneous, NullCollisionsAgreeWithRegularTracking) {
  constexpr int kFlights = 40000, kBins = 8;
  const auto all = cases();
  std::vector<const Case*> chosen;
  for (std::size_t i = 0; i < all.size(); i += 10) chosen.push_back(&all[i]);
  const double level =
      testing::sidak(testing::kSuiteFalseAlarm, static_cast<int>(chosen.size()) * 3 * (kBins + 2));
  std::uint64_t stream = 970;
  for (const Case* c : chosen) {
    SCOPED_TRACE(c->name);
    Rng rng(testing::suite_seed(), RngDomain::Test, stream++, 0);
    const UniformSource uniform = [&] { return rng.uniform(); };
    const Ray ray = random_ray(*c, rng);
    double begin = 0, end = kInfinity;
    ASSERT_TRUE(clip(c->volume->bounds(), ray, begin, end));
    const double t1 = begin + 0.8 * (end - begin), width = (t1 - begin) / kBins;
    // ∫τ dt over each bin, and τ(t1) twice.
    std::vector<RGB> sum(kBins + 2, RGB(0)), squares = sum;
    for (int i = 0; i < kFlights; ++i) {
      const auto flight = delta_tracking(*c->m, ray, 0, t1, uniform);
      const int bin = flight.inside ? static_cast<int>((flight.t - begin) / width) : kBins;
      // The weight estimates τ over the density of t.
      const RGB value =
          flight.inside ? flight.weight * c->m->sigma_t(ray(flight.t)) : flight.weight;
      sum[bin] += value;
      squares[bin] += value * value;
      const RGB ratio = ratio_tracking(*c->m, ray, 0, t1, uniform);
      sum[kBins + 1] += ratio;
      squares[kBins + 1] += ratio * ratio;
    }
    for (int bin = 0; bin < kBins + 2; ++bin) {
      const RGB tau = glm::exp(-c->m->optical_depth(ray, 0, t1));
      // The integral of σ_t τ is what τ loses.
      const RGB expected =
          bin >= kBins ? tau
                       : glm::exp(-c->m->optical_depth(ray, 0, begin + bin * width)) -
                             glm::exp(-c->m->optical_depth(ray, 0, begin + (bin + 1) * width));
      for (int channel = 0; channel < 3; ++channel) {
        const double mean = sum[bin][channel] / kFlights;
        const double error = std::sqrt((squares[bin][channel] / kFlights - mean * mean) / kFlights);
        // Of hits as rare as a few in all, the spread tells too little.
        const double least = std::sqrt(std::max(expected[channel], 10.0 / kFlights) / kFlights);
        const double z = (mean - expected[channel]) / std::max(error, least);
        EXPECT_GT(testing::p_value_normal(z), level)
            << "bin " << bin << " channel " << channel << ": " << mean << " ± " << error
            << ", expected " << expected[channel];
      }
    }
  }
}

TEST(Heterogeneous, Coefficients) {
  VoxelData glow{{2, 1, 1}, 1, {0, 1}};
  const auto emission = std::make_shared<Volume>(RGB(3, 2, 1));
  const auto sigma_t = std::make_shared<Volume>(glow, VolumeSettings{{}, Nearest, Clamp});
  const auto m = medium(sigma_t, 4, RGB(0.5, 0, 1), emission);
  const Vec3 empty(0.25, 0.5, 0.5), full(0.75, 0.5, 0.5), outside(1.5, 0.5, 0.5);
  EXPECT_EQ(m->sigma_t(full), RGB(4));
  EXPECT_EQ(m->sigma_s(full), RGB(2, 0, 4));
  EXPECT_EQ(m->emission(full), RGB(3, 2, 1));
  for (const Vec3& p : {empty, outside}) {
    EXPECT_EQ(m->sigma_t(p), RGB(0));
    EXPECT_EQ(m->sigma_s(p), RGB(0));
    EXPECT_EQ(m->emission(p), RGB(0)) << "no flight ends there";
  }
  EXPECT_TRUE(m->scatters() && m->emits());
  EXPECT_FALSE(medium(sigma_t, 4, RGB(0))->scatters());
  EXPECT_FALSE(medium(sigma_t, 0)->scatters());
  EXPECT_FALSE(medium(sigma_t)->emits());
  EXPECT_FALSE(medium(sigma_t, 0, RGB(0), emission)->emits());
  EXPECT_EQ(m->max_emission({Vec3(-1), Vec3(2)}), RGB(3, 2, 1));
  EXPECT_EQ(m->max_emission({Vec3(2), Vec3(3)}), RGB(0));
  EXPECT_THROW(medium(sigma_t, -1), std::domain_error);
  EXPECT_THROW(medium(sigma_t, kInfinity), std::domain_error);
  EXPECT_THROW(medium(sigma_t, 1, RGB(1.5)), std::domain_error);
}

}  // namespace
}  // namespace fogbow
