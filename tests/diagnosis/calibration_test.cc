#include "diagnosis/calibration.h"

#include <gtest/gtest.h>

#include <cmath>

namespace vibrissa::diagnosis {
namespace {

TEST(Calibration, TakesItsShareOfTheLogOdds) {
  EXPECT_NEAR(std::log(calibrated_odds(1e-4, 0.5)), 0.5 * std::log(1e-4), 1e-12);
  EXPECT_DOUBLE_EQ(calibrated_odds(1e-4, 1.), 1e-4);
  EXPECT_EQ(calibrated_odds(0., 0.5), 0.);
}

TEST(Calibration, MakesNoAnswerLikelierThanItsFitsDo) {
  for (const double odds : {1e-12, 1e-3, 0.3, 0.99, 1., 3., 40.})
    EXPECT_GE(calibrated_odds(odds), odds);
}

TEST(Calibration, LeavesTheLikeliestAnswerTheLikeliest) {
  for (const double odds : {1e-12, 1e-3, 0.3, 0.99}) EXPECT_LT(calibrated_odds(odds), 1.);
  for (const double odds : {1., 3., 40.}) EXPECT_EQ(calibrated_odds(odds), odds);
}

}  // namespace
}  // namespace vibrissa::diagnosis
