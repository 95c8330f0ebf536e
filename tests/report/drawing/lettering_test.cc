#include "report/drawing/lettering.h"

#include <gtest/gtest.h>

namespace vibrissa::report {
namespace {

TEST(Lettering, WritesSuperscriptsSoThatNoFontCanLoseThem) {
  EXPECT_EQ(without_superscripts("\u00d710\u207b\u00b9\u2076 m/s\u00b2"), "\u00d710^-16 m/s^2");
  EXPECT_EQ(without_superscripts("plain \u00b0"), "plain \u00b0");
}

TEST(Lettering, MeasuresTextsInPixels) {
  EXPECT_EQ(text_width("", 15, false), 0.);
  const double width = text_width("Frequency", 20, false);
  EXPECT_GT(width, 60.);
  EXPECT_LT(width, 140.);
  EXPECT_NEAR(text_width("Frequency", 40, false), 2. * width, 0.1 * width);
  EXPECT_GT(text_width("Frequency", 20, true), width);
  EXPECT_GT(text_width("Frequency [Hz]", 20, false), width);
}

}  // namespace
}  // namespace vibrissa::report
