// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/image/reference_filters.h"

namespace fogbow {
namespace {

using testing::filter_cases;
using testing::quadrature;

TEST(Filter, IsItsDefinitionScaledToIntegralOne) {
  for (const auto& c : filter_cases()) {
    const double norm = quadrature(c.shape, -c.radius, c.radius, 200000);
    EXPECT_DOUBLE_EQ(c.filter->radius(), c.radius) << c.name;
    for (double x = -2.5; x < 2.5; x += 0.0371)
      EXPECT_NEAR(c.filter->evaluate(x), c.shape(x) / norm, 1e-8) << c.name << " at " << x;
  }
}

TEST(Filter, IntegralIsTheAreaUnderIt) {
  for (const auto& c : filter_cases()) {
    const auto h = [&](double x) { return c.filter->evaluate(x); };
    EXPECT_NEAR(c.filter->integral(c.radius), 1, 1e-14) << c.name;
    EXPECT_EQ(c.filter->integral(-c.radius), 0) << c.name;
    EXPECT_EQ(c.filter->integral(-100), 0) << c.name;
    EXPECT_EQ(c.filter->integral(100), c.filter->integral(c.radius)) << c.name;
    for (double x = -c.radius; x < c.radius; x += 0.113)
      EXPECT_NEAR(c.filter->integral(x), quadrature(h, -c.radius, x, 100000), 2e-5)
          << c.name << " at " << x;
  }
}

TEST(Filter, RefusesWidthsThatAreNotPositive) {
  for (const double width : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(make_box_filter(width), std::domain_error);
    EXPECT_THROW(make_tent_filter(width), std::domain_error);
    EXPECT_THROW(make_gaussian_filter(width), std::domain_error);
  }
}

}  // namespace
}  // namespace fogbow
