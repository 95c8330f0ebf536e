#include "signals/base/number_text.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <locale>
#include <random>
#include <string>

namespace vibrissa::signals {
namespace {

TEST(NumberText, IsTheShortestFormThatReadsBackTheSame) {
  EXPECT_EQ(to_text(0.1), "0.1");
  EXPECT_EQ(to_text(500.), "500");
  EXPECT_EQ(to_text(0.1 + 0.2), "0.30000000000000004");
  for (const double value : {1. / 3., -4.9e-324, 1.7976931348623157e308, 3.09328e-4})
    EXPECT_EQ(to_number(to_text(value)), value);
}

TEST(NumberText, TakesOnlyTextThatIsANumberAsAWhole) {
  EXPECT_EQ(to_number("-1.5e-3"), -1.5e-3);
  EXPECT_EQ(to_number("+2"), 2.);
  EXPECT_EQ(to_number(".5"), 0.5);
  for (const char* const text :
       {"", " 1", "1 ", "1,5", "1.5x", "0x10", "+-1", "++1", "--1", "e5", "-"})
    EXPECT_FALSE(to_number(text)) << text;
}

// strtod of the C library rounds to nearest, whatever the number of digits.
TEST(NumberText, RoundsNumbersOfAnyLengthToTheNearest) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 20000; ++i) {
    const std::size_t n_digits = 1 + random() % 19, n_decimals = random() % 24;
    std::string text = std::to_string(random()).substr(0, n_digits);
    text.insert(std::min(n_decimals, text.size()), 1, '.');
    if (random() % 2) text = "-" + text;
    if (random() % 2) text += "e" + std::to_string(int(random() % 80) - 40);
    EXPECT_EQ(to_number(text), std::strtod(text.c_str(), nullptr)) << text;
  }
  EXPECT_TRUE(std::signbit(to_number("-0.0").value()));
  for (const char* const text : {"1e", "1e+", "1e+-2", "1e2147483648", ".", "-.", "1.2.3"})
    EXPECT_FALSE(to_number(text)) << text;
}

TEST(NumberText, RefusesANumberBeyondTheRangeOfADouble) {
  EXPECT_FALSE(to_number("1e400"));
  EXPECT_FALSE(to_number("-1e400"));
}

TEST(NumberText, KnowsTheNumbersThatAreNotFinite) {
  EXPECT_TRUE(std::isnan(to_number("NaN").value()));
  EXPECT_EQ(to_number("-inf"), -std::numeric_limits<double>::infinity());
}

TEST(NumberText, KeepsThePointInALocaleWithCommas) {
  struct Comma : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
  };
  const std::locale old = std::locale::global(std::locale(std::locale(), new Comma));
  EXPECT_EQ(to_text(1.5), "1.5");
  EXPECT_EQ(to_number("1.5"), 1.5);
  EXPECT_FALSE(to_number("1,5"));
  std::locale::global(old);
}

}  // namespace
}  // namespace vibrissa::signals
