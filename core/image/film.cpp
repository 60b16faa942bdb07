// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image/film.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>

#include "core/util/check.h"
#include "core/util/error.h"

namespace fogbow {
namespace {

constexpr int kMaxSide = 1 << 20;
constexpr std::int64_t kMaxPixels = std::int64_t{1} << 36;
/// Candidates of one dimension; a wider filter is refused.
constexpr int kMaxCandidates = 64;

FilmSettings complete(FilmSettings s) {
  if (s.crop_width == 0 && s.crop_height == 0) {
    s.crop_x = s.crop_y = 0;
    s.crop_width = s.width;
    s.crop_height = s.height;
  }
  if (!s.filter) s.filter = make_gaussian_filter();
  const auto inside = [](int offset, int size, int whole) {
    return whole > 0 && whole <= kMaxSide && size > 0 && offset >= 0 && offset <= whole - size;
  };
  if (!inside(s.crop_x, s.crop_width, s.width) || !inside(s.crop_y, s.crop_height, s.height) ||
      std::int64_t{s.crop_width} * s.crop_height > kMaxPixels)
    throw Error(ErrorKind::Usage,
                "impossible film: " + std::to_string(s.width) + "x" + std::to_string(s.height) +
                    ", crop " + std::to_string(s.crop_width) + "x" + std::to_string(s.crop_height) +
                    " at " + std::to_string(s.crop_x) + "," + std::to_string(s.crop_y));
  if (!(2 * s.filter->radius() + 1 < kMaxCandidates))
    throw Error(ErrorKind::Usage, "the reconstruction filter is too wide: radius " +
                                      std::to_string(s.filter->radius()) + " pixels");
  return s;
}

/// ∫ over [0, n] of the filter centred on each of n pixels.
std::vector<double> masses(const ReconstructionFilter& h, int n) {
  std::vector<double> mass(n);
  for (int j = 0; j < n; ++j) {
    const double c = j + 0.5;
    mass[j] = h.integral(n - c) - h.integral(-c);
  }
  return mass;
}

struct Choice {
  int pixel = -1;  ///< −1: no pixel's filter reaches here
  double weight = 0;
};

/// Without the call that std::floor is.
int floor_to_int(double x) {
  const int i = static_cast<int>(x);
  return i - (x < i);
}

/// Pixel j of a row or column with probability |h(x − c_j)| / S, S = Σ_j |h(x − c_j)|, and the
/// weight ±S / Z_j that makes the pixel's expected value ∫ h(x − c_j) f(x) dx / Z_j.
Choice choose(const ReconstructionFilter& h, const std::vector<double>& mass, double x, double u) {
  const double r = h.radius();
  const int n = static_cast<int>(mass.size());
  const int first = std::max(0, -floor_to_int(0.5 - (x - r)));
  const int last = std::min(n - 1, floor_to_int(x + r - 0.5));
  if (first == last) {
    const double value = h.evaluate(x - (first + 0.5));
    return value == 0 ? Choice() : Choice{first, value / mass[first]};
  }
  std::array<double, kMaxCandidates> values;
  double sum = 0;
  for (int j = first; j <= last; ++j)
    sum += std::fabs(values[j - first] = h.evaluate(x - (j + 0.5)));
  Choice choice;
  double rest = u * sum;
  for (int j = first; j <= last; ++j) {
    const double value = values[j - first];
    if (value == 0) continue;
    choice = {j, std::copysign(sum, value) / mass[j]};
    rest -= std::fabs(value);
    if (rest < 0) break;
  }
  return choice;
}

void add_or_throw(std::atomic<std::int64_t>& sum, std::int64_t count) {
  const std::int64_t before = sum.fetch_add(count, std::memory_order_relaxed);
  std::int64_t after;
  if (__builtin_add_overflow(before, count, &after))
    throw Error(ErrorKind::Numerical, "film overflow: the sum in a pixel exceeds 63 bits");
}

std::size_t pixel_count(const FilmSettings& s) {
  return static_cast<std::size_t>(s.crop_width) * s.crop_height;
}

float to_float(double value) {
  const float result = static_cast<float>(value);
  if (!std::isfinite(result))
    throw Error(ErrorKind::Numerical,
                "a pixel's value " + std::to_string(value) + " is beyond single precision");
  return result;
}

}  // namespace

Film::Film(const FilmSettings& settings, int unit_exponent)
    : settings_(complete(settings)),
      column_mass_(masses(*settings_.filter, settings_.crop_width)),
      row_mass_(masses(*settings_.filter, settings_.crop_height)) {
  set_unit(unit_exponent);
  const std::size_t pixels = pixel_count(settings_);
  try {
    rgb_ = std::vector<std::atomic<std::int64_t>>(3 * pixels);
    group_ = std::vector<std::atomic<std::int64_t>>(kGroups * pixels);
  } catch (const std::bad_alloc&) {
    throw Error(ErrorKind::Memory, "no memory for a film of " + std::to_string(pixels) + " pixels");
  }
}

void Film::set_unit(int exponent) {
  if (std::abs(exponent) > kMaxUnitExponent)
    throw Error(ErrorKind::Usage,
                "film unit 2^" + std::to_string(exponent) + " is beyond double precision");
  unit_exponent_ = exponent;
  counts_per_unit_ = std::ldexp(1.0, -exponent);
}

Film::Film(Film&& other) noexcept
    : settings_(std::move(other.settings_)),
      unit_exponent_(other.unit_exponent_),
      counts_per_unit_(other.counts_per_unit_),
      column_mass_(std::move(other.column_mass_)),
      row_mass_(std::move(other.row_mass_)),
      rgb_(std::move(other.rgb_)),
      group_(std::move(other.group_)),
      refused_(other.refused_.load()) {}

Film& Film::operator=(Film&& other) noexcept {
  settings_ = std::move(other.settings_);
  unit_exponent_ = other.unit_exponent_;
  counts_per_unit_ = other.counts_per_unit_;
  column_mass_ = std::move(other.column_mass_);
  row_mass_ = std::move(other.row_mass_);
  rgb_ = std::move(other.rgb_);
  group_ = std::move(other.group_);
  refused_ = other.refused_.load();
  return *this;
}

/// Nearest count; a single splat of 2^62 counts or more is an overflow too.
std::int64_t Film::to_count(double value) const {
  const double counts = value * counts_per_unit_;
  if (!(std::fabs(counts) < 0x1p62))
    throw Error(ErrorKind::Numerical,
                "film overflow: a splat of " + std::to_string(counts) + " counts");
  return std::llrint(counts);
}

std::optional<Film::Placed> Film::place(const Vec2& raster, const RGB& value, int group,
                                        const Vec2& u) {
  if (!is_finite(value) || !std::isfinite(raster.x) || !std::isfinite(raster.y)) {
    refused_.fetch_add(1, std::memory_order_relaxed);
    return std::nullopt;
  }
  FOGBOW_CHECK(raster.x >= 0 && raster.x < 1 && raster.y >= 0 && raster.y < 1);
  FOGBOW_CHECK(group >= 0 && group < kGroups);
  if (is_black(value)) return std::nullopt;
  const auto column = choose(*settings_.filter, column_mass_, raster.x * settings_.crop_width, u.x);
  const auto row = choose(*settings_.filter, row_mass_, raster.y * settings_.crop_height, u.y);
  if (column.pixel < 0 || row.pixel < 0) return std::nullopt;
  const RGB weighted = (column.weight * row.weight) * value;
  Placed placed;
  placed.pixel = static_cast<std::size_t>(row.pixel) * settings_.crop_width + column.pixel;
  placed.group = group;
  __builtin_prefetch(&rgb_[3 * placed.pixel], 1);
  __builtin_prefetch(&group_[group_place(placed)], 1);
  for (int c = 0; c < 3; ++c) placed.rgb[c] = to_count(weighted[c]);
  placed.luminance = to_count(luminance(weighted));
  return placed;
}

void Film::add(const Placed& splat) {
  for (int c = 0; c < 3; ++c) add_or_throw(rgb_[3 * splat.pixel + c], splat.rgb[c]);
  add_or_throw(group_[group_place(splat)], splat.luminance);
}

std::size_t Film::group_place(const Placed& splat) const {
  return splat.group * (rgb_.size() / 3) + splat.pixel;
}

namespace {

bool same_picture(const FilmSettings& a, const FilmSettings& b) {
  return a.width == b.width && a.height == b.height && a.crop_x == b.crop_x &&
         a.crop_y == b.crop_y && a.crop_width == b.crop_width && a.crop_height == b.crop_height &&
         a.filter->radius() == b.filter->radius() &&
         std::strcmp(a.filter->name(), b.filter->name()) == 0;
}

}  // namespace

void Film::add(const Film& other) {
  if (!same_picture(settings_, other.settings_) || unit_exponent_ != other.unit_exponent_)
    throw Error(ErrorKind::Usage, "films of different size, filter or unit cannot be added");
  for (std::size_t i = 0; i < rgb_.size(); ++i) add_or_throw(rgb_[i], other.rgb_[i].load());
  for (std::size_t i = 0; i < group_.size(); ++i) add_or_throw(group_[i], other.group_[i].load());
  refused_ += other.refused_.load();
}

Image Film::develop(double scale, const std::vector<double>& group_scale) const {
  FOGBOW_CHECK(group_scale.size() == kGroups);
  const bool errors = kGroups - std::count(group_scale.begin(), group_scale.end(), 0.0) >= 2;
  std::vector<std::string> names{"R", "G", "B"};
  if (errors) names.insert(names.end(), {"Error.R", "Error.G", "Error.B"});
  Image image(settings_.crop_width, settings_.crop_height, std::move(names));
  image.x = settings_.crop_x;
  image.y = settings_.crop_y;
  image.full_width = settings_.width;
  image.full_height = settings_.height;
  const std::size_t pixels = pixel_count(settings_), channels = image.channels.size();
  const double factor = std::ldexp(scale * static_cast<double>(pixels), unit_exponent_);
  for (std::size_t p = 0; p < pixels; ++p)
    for (int c = 0; c < 3; ++c)
      image.pixels[p * channels + c] =
          to_float(factor * static_cast<double>(rgb_[3 * p + c].load()));
  if (errors) add_error_layers(image, scale, group_scale);
  return image;
}

/// Group g's estimate e_g of a pixel has the share m_g ∝ 1/group_scale[g] of the mean and a
/// variance ∝ 1/m_g: with K groups Σ m_g (e_g − ē)² / (K − 1) is an unbiased estimate of the mean's
/// variance.
void Film::add_error_layers(Image& image, double scale,
                            const std::vector<double>& group_scale) const {
  const std::size_t pixels = pixel_count(settings_), channels = image.channels.size();
  const double unit = std::ldexp(static_cast<double>(pixels), unit_exponent_);
  std::array<double, kGroups> share{};
  double total = 0, groups = 0;
  for (int g = 0; g < kGroups; ++g)
    if (group_scale[g] != 0) {
      total += share[g] = scale / group_scale[g];
      ++groups;
    }
  for (double& m : share) m /= total;
  for (std::size_t p = 0; p < pixels; ++p) {
    std::array<double, kGroups> e;
    double mean = 0, sum = 0;
    for (int g = 0; g < kGroups; ++g) {
      e[g] = unit * group_scale[g] * static_cast<double>(group_[g * pixels + p].load());
      mean += share[g] * e[g];
    }
    for (int g = 0; g < kGroups; ++g) sum += share[g] * sqr(e[g] - mean);
    const double error = std::sqrt(sum / (groups - 1));
    float* pixel = &image.pixels[p * channels];
    const double brightness = luminance(RGB(pixel[0], pixel[1], pixel[2]));
    for (int c = 0; c < 3; ++c)
      pixel[3 + c] = to_float(brightness != 0 ? error * std::fabs(pixel[c] / brightness) : error);
  }
}

std::size_t Film::memory_bytes(const FilmSettings& settings) {
  const auto width =
      static_cast<std::size_t>(settings.crop_width > 0 ? settings.crop_width : settings.width);
  const auto height =
      static_cast<std::size_t>(settings.crop_width > 0 ? settings.crop_height : settings.height);
  return sizeof(Film) + sizeof(double) * (width + height) +
         sizeof(std::int64_t) * (3 + kGroups) * width * height;
}

}  // namespace fogbow
