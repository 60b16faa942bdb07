// SPDX-License-Identifier: GPL-3.0-or-later
#include <OpenImageIO/imageio.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>

#include "core/image/image_io.h"
#include "core/util/error.h"

namespace fogbow {
namespace {

/// Floats of the largest picture that is read: a broken header must not eat the machine's memory.
constexpr std::uint64_t kMaxValues = std::uint64_t{1} << 31;

[[noreturn]] void fail(const std::string& path, const std::string& message) {
  throw Error(ErrorKind::InputOutput, path + ": " + message);
}

void check_layout(const std::string& path, const Image& image) {
  const std::size_t values =
      static_cast<std::size_t>(image.width) * image.height * image.channels.size();
  if (image.width <= 0 || image.height <= 0 || image.channels.empty() ||
      image.pixels.size() != values)
    fail(path, "an image without pixels cannot be written");
}

void set_windows(OIIO::ImageSpec& spec, const Image& image) {
  spec.x = image.x;
  spec.y = image.y;
  spec.full_x = spec.full_y = 0;
  spec.full_width = image.full_width;
  spec.full_height = image.full_height;
}

void set_metadata(const std::string& path, OIIO::ImageSpec& spec, const Image& image) {
  for (const auto& [name, value] : image.metadata) {
    if (const auto* number = std::get_if<int>(&value)) {
      spec.attribute(name, *number);
    } else if (const auto* real = std::get_if<float>(&value)) {
      spec.attribute(name, *real);
    } else if (const auto* text = std::get_if<std::string>(&value)) {
      spec.attribute(name, *text);
    } else {
      const auto& matrix = std::get<std::vector<float>>(value);
      if (matrix.size() != 16) fail(path, "metadata \"" + name + "\" is no 4x4 matrix");
      spec.attribute(name, OIIO::TypeMatrix44, matrix.data());
    }
  }
}

void get_metadata(const OIIO::ImageSpec& spec, Image& image) {
  for (const auto& attribute : spec.extra_attribs) {
    const std::string name = attribute.name().string();
    const OIIO::TypeDesc type = attribute.type();
    if (type == OIIO::TypeInt) {
      image.metadata[name] = attribute.get_int();
    } else if (type == OIIO::TypeFloat) {
      image.metadata[name] = attribute.get_float();
    } else if (type == OIIO::TypeString) {
      image.metadata[name] = attribute.get_string();
    } else if (type == OIIO::TypeMatrix44) {
      const auto* values = static_cast<const float*>(attribute.data());
      image.metadata[name] = std::vector<float>(values, values + 16);
    }
  }
}

/// A file that takes its name only when it is complete and on disk; gone otherwise.
class AtomicFile {
 public:
  explicit AtomicFile(const std::string& path) : path_(path) {
    static std::atomic<unsigned> counter{0};
    const std::filesystem::path target(path);
    // OpenImageIO chooses the format by the extension: it stays last.
    temporary_ =
        target.parent_path() / ("." + target.stem().string() + "." + std::to_string(::getpid()) +
                                "-" + std::to_string(counter++) + target.extension().string());
  }
  ~AtomicFile() {
    if (!committed_) ::unlink(temporary_.c_str());
  }
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  const std::string& temporary() const { return temporary_; }

  void commit() {
    sync(temporary_, O_RDONLY);
    if (::rename(temporary_.c_str(), path_.c_str()) != 0) fail(path_, std::strerror(errno));
    committed_ = true;
    const auto folder = std::filesystem::path(path_).parent_path().string();
    sync(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
  }

 private:
  void sync(const std::string& name, int flags) const {
    const int file = ::open(name.c_str(), flags);
    if (file < 0) fail(path_, std::strerror(errno));
    // Some file systems cannot sync folders and say EINVAL.
    const bool failed = ::fsync(file) != 0 && errno != EINVAL;
    const int error = errno;
    ::close(file);
    if (failed) fail(path_, std::strerror(error));
  }

  std::string path_, temporary_;
  bool committed_ = false;
};

void write(const std::string& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
           const void* pixels) {
  AtomicFile file(path);
  auto out = OIIO::ImageOutput::create(file.temporary());
  if (!out) fail(path, OIIO::geterror());
  if (!out->open(file.temporary(), spec) || !out->write_image(type, pixels) || !out->close())
    fail(path, out->geterror());
  file.commit();
}

/// The sRGB curve (IEC 61966-2-1), to 8 bits.
unsigned char encode_srgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055;
  return static_cast<unsigned char>(std::lround(255 * encoded));
}

void require_extension(const std::string& path, const char* extension) {
  std::string found = std::filesystem::path(path).extension().string();
  std::transform(found.begin(), found.end(), found.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (found != extension) fail(path, std::string("the name must end in ") + extension);
}

}  // namespace

Image read_image(const std::string& path) {
  auto in = OIIO::ImageInput::open(path);
  if (!in) fail(path, OIIO::geterror());
  const OIIO::ImageSpec& spec = in->spec();
  if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1)
    fail(path, "no picture of two dimensions");
  if (spec.image_pixels() > kMaxValues / static_cast<std::uint64_t>(spec.nchannels))
    fail(path, "too large a picture: " + std::to_string(spec.width) + "x" +
                   std::to_string(spec.height) + " with " + std::to_string(spec.nchannels) +
                   " channels");
  Image image(spec.width, spec.height, spec.channelnames);
  image.x = spec.x - spec.full_x;
  image.y = spec.y - spec.full_y;
  image.full_width = spec.full_width;
  image.full_height = spec.full_height;
  image.integers = !spec.format.is_floating_point();
  get_metadata(spec, image);
  if (!in->read_image(0, 0, 0, spec.nchannels, OIIO::TypeFloat, image.pixels.data()))
    fail(path, in->geterror());
  in->close();
  return image;
}

void write_exr(const std::string& path, const Image& image) {
  require_extension(path, ".exr");
  check_layout(path, image);
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(image.channels.size()),
                       OIIO::TypeFloat);
  spec.channelnames = image.channels;
  set_windows(spec, image);
  set_metadata(path, spec, image);
  spec.attribute("compression", "zip");
  write(path, spec, OIIO::TypeFloat, image.pixels.data());
}

void write_png(const std::string& path, const Image& image, double exposure) {
  require_extension(path, ".png");
  check_layout(path, image);
  const int rgb[3] = {image.channel("R"), image.channel("G"), image.channel("B")};
  if (rgb[0] < 0 || rgb[1] < 0 || rgb[2] < 0) fail(path, "the image has no channels R, G, B");
  const double gain = std::exp2(exposure);
  std::vector<unsigned char> bytes;
  bytes.reserve(std::size_t{3} * image.width * image.height);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const float r = image.at(column, row, rgb[0]), g = image.at(column, row, rgb[1]),
                  b = image.at(column, row, rgb[2]);
      if (std::isfinite(r) && std::isfinite(g) && std::isfinite(b))
        for (const float value : {r, g, b}) bytes.push_back(encode_srgb(gain * value));
      else
        bytes.insert(bytes.end(), {255, 0, 255});
    }
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeUInt8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  write(path, spec, OIIO::TypeUInt8, bytes.data());
}

}  // namespace fogbow
