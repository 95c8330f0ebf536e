#include "signals/base/significant_digits.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::signals {
namespace {

TEST(SignificantDigits, AreThoseOfTheNearestNumber) {
  EXPECT_EQ(with_significant_digits(123456., 3), 123000.);
  EXPECT_EQ(with_significant_digits(-0.0099951, 3), -0.01);
  EXPECT_EQ(with_significant_digits(2e-300, 1), 2e-300);
  EXPECT_EQ(with_significant_digits(0., 5), 0.);
  EXPECT_TRUE(std::isnan(with_significant_digits(std::nan(""), 3)));
}

TEST(SignificantDigits, AreTheDigitsOfTheText) {
  EXPECT_EQ(rounded(123456., 3), "123000");
  EXPECT_EQ(rounded(0.1 + 0.2, 4), "0.3");
  EXPECT_EQ(rounded(-1. / 3., 2), "-0.33");
  EXPECT_EQ(rate_text(500.00002344255614), "500.00002 Hz");
  EXPECT_EQ(rate_text(48000.), "48000 Hz");
}

}  // namespace
}  // namespace vibrissa::signals
