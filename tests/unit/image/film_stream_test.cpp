// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <sstream>

#include "core/image/film.h"
#include "core/math/random.h"
#include "core/util/error.h"
#include "tests/helpers/statistics.h"

namespace fogbow {
namespace {

FilmSettings film_settings() {
  FilmSettings s;
  s.width = 10;
  s.height = 6;
  s.crop_x = 1;
  s.crop_y = 2;
  s.crop_width = 3;
  s.crop_height = 2;
  s.filter = make_tent_filter();
  return s;
}

std::string filled_stream() {
  Film film(film_settings(), -44);
  Rng rng(testing::suite_seed(), RngDomain::Test, 500, 0);
  for (int i = 0; i < 500; ++i)
    film.splat(uniform2(rng), 4.0 * uniform3(rng) - RGB(1), i % Film::kGroups, uniform2(rng));
  film.splat(Vec2(0.5), RGB(std::nan("")), 0, Vec2(0));
  std::ostringstream out;
  film.serialize(out);
  return out.str();
}

Film read(const std::string& bytes, const FilmSettings& settings = film_settings()) {
  std::istringstream in(bytes);
  return Film::deserialize(in, settings);
}

void expect_refused(const std::string& bytes, const FilmSettings& settings, const char* what) {
  try {
    read(bytes, settings);
    ADD_FAILURE() << "accepted: " << what;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::InputOutput) << what;
  }
}

TEST(FilmStream, RoundTripsBitForBit) {
  const std::string bytes = filled_stream();
  const Film film = read(bytes);
  EXPECT_EQ(film.unit_exponent(), -44);
  EXPECT_EQ(film.refused(), 1u);
  std::ostringstream again;
  film.serialize(again);
  EXPECT_EQ(again.str(), bytes);
}

TEST(FilmStream, LeavesWhatFollowsItUnread) {
  std::istringstream in(filled_stream() + "next");
  Film::deserialize(in, film_settings());
  std::string rest;
  in >> rest;
  EXPECT_EQ(rest, "next");
}

TEST(FilmStream, RefusesEveryTruncation) {
  const std::string bytes = filled_stream();
  for (std::size_t n = 0; n < bytes.size(); ++n)
    expect_refused(bytes.substr(0, n), film_settings(), "truncated");
}

TEST(FilmStream, RefusesEveryFlippedBit) {
  const std::string bytes = filled_stream();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string broken = bytes;
    broken[i] = static_cast<char>(broken[i] ^ (1 << (i % 8)));
    expect_refused(broken, film_settings(), "a flipped bit");
  }
}

TEST(FilmStream, RefusesFilmsOfOtherSettings) {
  const std::string bytes = filled_stream();
  for (int FilmSettings::*field : {&FilmSettings::width, &FilmSettings::height,
                                   &FilmSettings::crop_x, &FilmSettings::crop_y}) {
    FilmSettings other = film_settings();
    other.*field += 1;
    expect_refused(bytes, other, "another window");
  }
  FilmSettings other = film_settings();
  other.filter = make_tent_filter(1.5);
  expect_refused(bytes, other, "another radius");
  other.filter = make_box_filter(1);
  expect_refused(bytes, other, "another filter");
}

}  // namespace
}  // namespace fogbow
