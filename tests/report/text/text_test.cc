#include "report/text/text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibrissa::report {
namespace {

TEST(Significant, DropsTrailingZeros) {
  EXPECT_EQ(significant(27., 3), "27");
  EXPECT_EQ(significant(0.05, 4), "0.05");
  EXPECT_EQ(significant(-0.5, 3), "-0.5");
  EXPECT_EQ(significant(100., 4), "100");
  EXPECT_EQ(significant(37.3456, 4), "37.35");
}

TEST(Significant, CountsDigitsAfterRounding) {
  EXPECT_EQ(significant(9.996, 3), "10");
  EXPECT_EQ(significant(0.99951, 3), "1");
  EXPECT_EQ(significant(999999.7, 3), "1e+06");
}

TEST(Significant, NeverReplacesDigitsBeforeThePoint) {
  EXPECT_EQ(significant(12345., 3), "12345");
}

TEST(Significant, UsesPowersOfTenForVerySmallAndLargeNumbers) {
  EXPECT_EQ(significant(1.2345e-5, 3), "1.23e-05");
  EXPECT_EQ(significant(1e-4, 3), "0.0001");
  EXPECT_EQ(significant(-2.5e7, 3), "-2.5e+07");
}

TEST(Significant, ShowsWhatIsNoNumber) {
  EXPECT_EQ(significant(std::nan(""), 3), "-");
  EXPECT_EQ(significant(-std::numeric_limits<double>::infinity(), 3), "-inf");
  EXPECT_EQ(significant(0., 3), "0");
}

TEST(CsvField, IsQuotedOnlyWhereNeeded) {
  EXPECT_EQ(csv_field("Time [s]"), "Time [s]");
  EXPECT_EQ(csv_field("a,b"), "\"a,b\"");
  EXPECT_EQ(csv_field("a \"b\""), "\"a \"\"b\"\"\"");
  EXPECT_EQ(csv_field("a\nb"), "a b");
}

TEST(NCharacters, CountsCodePoints) {
  EXPECT_EQ(n_characters("mm"), 2u);
  EXPECT_EQ(n_characters("\u00b5m\u00b2"), 3u);
  EXPECT_EQ(n_characters(""), 0u);
}

}  // namespace
}  // namespace vibrissa::report
