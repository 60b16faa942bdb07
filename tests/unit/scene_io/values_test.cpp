// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "core/scene_io/diagnostics.h"
#include "core/scene_io/parse_values.h"

namespace fogbow {
namespace {

const SourceLocation kHere{"here.xml", 3, 7};

TEST(ParseNumber, ReadsWhatMitsubaReads) {
  const std::pair<const char*, double> cases[] = {
      {"2.5", 2.5},  {" 2.5 ", 2.5},  {"+2", 2},        {"-.5", -0.5},    {"1.", 1},
      {"1e3", 1000}, {"1E-3", 0.001}, {"\t-0\n", -0.0}, {"1e308", 1e308}, {"123456789", 123456789}};
  for (const auto& [text, value] : cases) EXPECT_EQ(parse_number(text, kHere), value) << text;
}

TEST(ParseNumber, TakesTooSmallForZero) {
  for (const char* text : {"1e-999", "-1E-400", "0.000e-9999"})
    EXPECT_EQ(parse_number(text, kHere), 0) << text;
  EXPECT_EQ(parse_number("0." + std::string(400, '0') + "1", kHere), 0);
}

TEST(ParseNumber, RefusesAllElse) {
  for (const char* text : {"", " ", "x", "2.5x", "2,5", "1 2", "nan", "inf", "-inf", "+-1", "++1",
                           "1e999", "-1e999", "0x10", "1e", "--1", "$x", "NaN", "infinity"}) {
    try {
      parse_number(text, kHere);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::Scene);
      EXPECT_EQ(std::string(error.what()).find("here.xml:3:7: expected a finite number, found \""),
                0u)
          << error.what();
    }
  }
  EXPECT_THROW(parse_number("1" + std::string(400, '0'), kHere), Error);
}

TEST(ParseInteger, ReadsWholeNumbersOnly) {
  EXPECT_EQ(parse_integer(" -12 ", kHere), -12);
  EXPECT_EQ(parse_integer("+7", kHere), 7);
  EXPECT_EQ(parse_integer("9223372036854775807", kHere), INT64_MAX);
  for (const char* text : {"", "10.0", "1e3", "12x", "9223372036854775808", "0x1", "1 2"})
    EXPECT_THROW(parse_integer(text, kHere), Error) << text;
}

TEST(ParseBoolean, ReadsTrueAndFalse) {
  EXPECT_TRUE(parse_boolean("true", kHere));
  EXPECT_TRUE(parse_boolean(" True ", kHere));
  EXPECT_FALSE(parse_boolean("FALSE", kHere));
  for (const char* text : {"", "1", "0", "yes", "truefoo", "true false"})
    EXPECT_THROW(parse_boolean(text, kHere), Error) << text;
}

TEST(ParseNumbers, SeparatesByCommasAndSpace) {
  const std::vector<double> expected{1, 2, 3};
  for (const char* text : {"1,2,3", "1 2 3", "1, 2, 3", " 1 ,2\n3 ", "1\t2,3"})
    EXPECT_EQ(parse_numbers(text, kHere), expected) << text;
  EXPECT_TRUE(parse_numbers("  ", kHere).empty());
  for (const char* text : {"1,,2", ",1", "1,", "1;2", "1 x", "1 nan", "1-2", "1+2"})
    EXPECT_THROW(parse_numbers(text, kHere), Error) << text;
}

TEST(ParseTriple, TakesOneNumberForAll) {
  EXPECT_EQ(parse_triple("2", kHere), Vec3(2));
  EXPECT_EQ(parse_triple("1, 2, 3", kHere), Vec3(1, 2, 3));
  for (const char* text : {"", "1,2", "1,2,3,4"}) EXPECT_THROW(parse_triple(text, kHere), Error);
}

TEST(Messages, QuoteHarmlesslyAndSuggest) {
  EXPECT_EQ(quote("a\n\x01"), "\"a\\x0a\\x01\"");
  EXPECT_EQ(quote(std::string(200, 'a')), "\"" + std::string(80, 'a') + "...\"");
  EXPECT_EQ(suggestion("difuse", {"null", "diffuse"}), " (did you mean \"diffuse\"?)");
  EXPECT_EQ(suggestion("plastic", {"null", "diffuse"}), "");
  EXPECT_EQ(listed({"a", "b", "c"}), "\"a\", \"b\" and \"c\"");
}

}  // namespace
}  // namespace fogbow
