// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/scene_io/volume_grid.h"

#include <bit>
#include <cmath>
#include <cstring>

#include "core/scene_io/byte_cursor.h"
#include "core/scene_io/diagnostics.h"
#include "core/util/error.h"

namespace fogbow {

namespace {

enum Encoding { Float32 = 1, Float16 = 2, Uint8 = 3, Directions = 4 };

constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 31;
constexpr std::size_t kHeader = 48;

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t result = 0;
  for (std::size_t i = bytes.size(); i-- > 0;)
    result = result << 8 | static_cast<unsigned char>(bytes[i]);
  return result;
}

class VolParser {
 public:
  VolParser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  VolumeFile parse() {
    read_header();
    VoxelData& voxels = file_.voxels;
    const std::size_t count =
        std::size_t(voxels.size[0]) * voxels.size[1] * voxels.size[2] * voxels.channels;
    voxels.values.resize(count);
    for (std::size_t i = 0; i < count; ++i, at_ += value_bytes_) {
      const float v = value();
      if (!(v >= 0 && std::isfinite(v))) fail_voxel(i, v);
      voxels.values[i] = v;
    }
    file_.unread_bytes = bytes_.size() - at_;
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::Scene, {name_, 0, 0},
                message + " (at byte " + std::to_string(at_) + ")");
  }
  [[noreturn]] void fail_voxel(std::size_t i, float value) const {
    const VoxelData& v = file_.voxels;
    const std::size_t voxel = i / v.channels, nx = v.size[0], ny = v.size[1];
    fail("voxel (" + std::to_string(voxel % nx) + ", " + std::to_string(voxel / nx % ny) + ", " +
         std::to_string(voxel / nx / ny) + ") is " +
         (std::isfinite(value) ? "negative: " + number(value) : "not finite"));
  }

  std::uint32_t next_word() {
    const std::uint32_t word = little_endian(bytes_.substr(at_, 4));
    at_ += 4;
    return word;
  }

  void read_header() {
    if (bytes_.substr(0, 3) != "VOL") fail("expected a volume, which begins with \"VOL\"");
    at_ = 3;
    if (bytes_.size() < kHeader) fail("the file ends within its header of 48 bytes");
    if (bytes_[at_] != 3)
      fail("expected version 3 of the format, found " +
           std::to_string(static_cast<unsigned char>(bytes_[at_])));
    ++at_;
    read_encoding();
    read_size();
    for (const bool upper : {false, true})
      for (int axis = 0; axis < 3; ++axis) {
        const double v = std::bit_cast<float>(next_word());
        (upper ? file_.bounds.hi : file_.bounds.lo)[axis] = v;
      }
  }

  void read_encoding() {
    switch (const std::uint32_t encoding = next_word()) {
      case Float32: value_bytes_ = 4; break;
      case Float16: value_bytes_ = 2; break;
      case Uint8: value_bytes_ = 1; break;
      case Directions:
        at_ -= 4;
        fail("the volume holds directions (encoding 4), which no medium here takes");
      default:
        at_ -= 4;
        fail("expected the encoding 1 (float32), 2 (float16) or 3 (uint8), found " +
             std::to_string(static_cast<std::int32_t>(encoding)));
    }
    encoding_ = value_bytes_ == 4 ? Float32 : value_bytes_ == 2 ? Float16 : Uint8;
  }

  void read_size() {
    std::uint64_t count = 1;
    for (int axis = 0; axis < 4; ++axis, at_ += 4) {
      const auto n = static_cast<std::int32_t>(little_endian(bytes_.substr(at_, 4)));
      if (axis == 3 && n != 1 && n != 3)
        fail("expected 1 or 3 channels, found " + std::to_string(n));
      if (n < 1) fail("expected at least one voxel on each axis, found " + std::to_string(n));
      count *= static_cast<std::uint64_t>(n);
      if (count > kMaxValues) fail("more than " + std::to_string(kMaxValues) + " voxels");
      (axis < 3 ? file_.voxels.size[axis] : file_.voxels.channels) = n;
    }
    const std::uint64_t available = (bytes_.size() - kHeader) / value_bytes_;
    if (count > available)
      fail("the header promises " + std::to_string(count) + " values, but the file holds " +
           std::to_string(available));
  }

  float value() const {
    const std::uint32_t raw = little_endian(bytes_.substr(at_, value_bytes_));
    switch (encoding_) {
      case Float16: return from_half(raw);
      case Uint8: return static_cast<float>(raw) / 255;
      default: return std::bit_cast<float>(raw);
    }
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0, value_bytes_ = 0;
  Encoding encoding_ = Float32;
  VolumeFile file_;
};

}  // namespace

VolumeFile parse_vol(std::string_view bytes, const std::string& name) {
  return VolParser(bytes, name).parse();
}

}  // namespace fogbow
