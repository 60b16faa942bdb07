// SPDX-License-Identifier: GPL-3.0-or-later
// The stream of a film: tag, version, settings, counts, all little-endian, and an FNV-1a hash of
// what stands before it.
#include <array>
#include <bit>
#include <cstring>
#include <istream>
#include <ostream>
#include <string>

#include "core/image/film.h"
#include "core/util/error.h"

namespace fogbow {
namespace {

constexpr std::array<char, 8> kTag{'F', 'B', 'O', 'W', 'F', 'I', 'L', 'M'};
constexpr std::uint64_t kVersion = 1;

class Fnv1a {
 public:
  void add(const unsigned char* bytes, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) hash_ = (hash_ ^ bytes[i]) * 0x100000001b3u;
  }
  std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) {}
  void integer(std::uint64_t value) {
    unsigned char bytes[8];
    for (int i = 0; i < 8; ++i) bytes[i] = static_cast<unsigned char>(value >> (8 * i));
    hash_.add(bytes, sizeof(bytes));
    out_.write(reinterpret_cast<const char*>(bytes), sizeof(bytes));
  }
  void number(double value) { integer(std::bit_cast<std::uint64_t>(value)); }
  void text(const std::string& value) {
    integer(value.size());
    hash_.add(reinterpret_cast<const unsigned char*>(value.data()), value.size());
    out_.write(value.data(), static_cast<std::streamsize>(value.size()));
  }
  void finish() { integer(hash_.value()); }

 private:
  std::ostream& out_;
  Fnv1a hash_;
};

[[noreturn]] void broken(const std::string& what) {
  throw Error(ErrorKind::InputOutput, "film stream: " + what);
}

class Reader {
 public:
  explicit Reader(std::istream& in) : in_(in) {}
  std::uint64_t integer() {
    unsigned char bytes[8];
    take(bytes, sizeof(bytes));
    std::uint64_t value = 0;
    for (int i = 0; i < 8; ++i) value |= std::uint64_t{bytes[i]} << (8 * i);
    return value;
  }
  void expect(std::uint64_t wanted, const char* what) {
    const std::uint64_t found = integer();
    if (found != wanted)
      broken(std::string(what) + " is " + std::to_string(static_cast<std::int64_t>(found)) +
             " where " + std::to_string(static_cast<std::int64_t>(wanted)) + " was expected");
  }
  void expect_text(const std::string& wanted, const char* what) {
    if (integer() != wanted.size()) broken(std::string("another ") + what);
    std::string found(wanted.size(), '\0');
    take(reinterpret_cast<unsigned char*>(found.data()), found.size());
    if (found != wanted) broken(std::string("another ") + what);
  }
  void finish() {
    const std::uint64_t hash = hash_.value();
    if (integer() != hash) broken("the checksum is wrong");
  }

 private:
  void take(unsigned char* bytes, std::size_t n) {
    in_.read(reinterpret_cast<char*>(bytes), static_cast<std::streamsize>(n));
    if (!in_) broken("ends too early");
    hash_.add(bytes, n);
  }

  std::istream& in_;
  Fnv1a hash_;
};

/// The settings as numbers with what each is called in an error message.
std::array<std::pair<std::uint64_t, const char*>, 7> numbers(const FilmSettings& s) {
  return {{{static_cast<std::uint64_t>(s.width), "width"},
           {static_cast<std::uint64_t>(s.height), "height"},
           {static_cast<std::uint64_t>(s.crop_x), "crop x"},
           {static_cast<std::uint64_t>(s.crop_y), "crop y"},
           {static_cast<std::uint64_t>(s.crop_width), "crop width"},
           {static_cast<std::uint64_t>(s.crop_height), "crop height"},
           {std::bit_cast<std::uint64_t>(s.filter->radius()), "filter radius (as bits)"}}};
}

}  // namespace

void Film::serialize(std::ostream& out) const {
  Writer writer(out);
  writer.text(std::string(kTag.data(), kTag.size()));
  writer.integer(kVersion);
  for (const auto& [value, what] : numbers(settings_)) writer.integer(value);
  writer.text(settings_.filter->name());
  writer.integer(static_cast<std::uint64_t>(std::int64_t{unit_exponent_}));
  writer.integer(refused_.load());
  for (const auto& count : rgb_) writer.integer(static_cast<std::uint64_t>(count.load()));
  for (const auto& count : group_) writer.integer(static_cast<std::uint64_t>(count.load()));
  writer.finish();
  if (!out) throw Error(ErrorKind::InputOutput, "film stream: cannot be written");
}

Film Film::deserialize(std::istream& in, const FilmSettings& settings) {
  Film film(settings, 0);
  Reader reader(in);
  reader.expect_text(std::string(kTag.data(), kTag.size()), "kind of file");
  reader.expect(kVersion, "version");
  for (const auto& [value, what] : numbers(film.settings_)) reader.expect(value, what);
  reader.expect_text(film.settings_.filter->name(), "reconstruction filter");
  const auto unit = static_cast<std::int64_t>(reader.integer());
  if (unit < -kMaxUnitExponent || unit > kMaxUnitExponent) broken("the unit is out of range");
  film.set_unit(static_cast<int>(unit));
  film.refused_ = reader.integer();
  for (auto& count : film.rgb_) count = static_cast<std::int64_t>(reader.integer());
  for (auto& count : film.group_) count = static_cast<std::int64_t>(reader.integer());
  reader.finish();
  return film;
}

}  // namespace fogbow
