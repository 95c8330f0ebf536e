#include "report/drawing/lettering.h"

#include <gtest/gtest.h>

namespace vibrissa::report {
namespace {

TEST(Lettering, MeasuresTextsInPixels) {
  EXPECT_EQ(text_width("", 15, false), 0.);
  const double width = text_width("Frequency", 20, false);
  EXPECT_GT(width, 60.);
  EXPECT_LT(width, 140.);
  EXPECT_NEAR(text_width("Frequency", 40, false), 2. * width, 0.1 * width);
  EXPECT_GT(text_width("Frequency", 20, true), width);
  EXPECT_GT(text_width("Frequency [Hz]", 20, false), width);
  EXPECT_GT(text_width("10\u207b\u2076", 20, false), text_width("10", 20, false))
      << "no character may vanish";
}

}  // namespace
}  // namespace vibrissa::report
