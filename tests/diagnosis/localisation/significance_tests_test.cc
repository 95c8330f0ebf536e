#include "diagnosis/localisation/significance_tests.h"

#include <gmock/gmock.h>

namespace vibrissa::diagnosis {
namespace {

TEST(SignificanceTests, NormalTailHasItsTextbookQuantiles) {
  EXPECT_NEAR(normal_tail(1.959964), 0.025, 1e-6);
  EXPECT_NEAR(normal_tail(0.), 0.5, 1e-12);
  EXPECT_GE(normal_tail(100.), 1e-300);
}

TEST(SignificanceTests, VarianceRatioMeetsTabledPercentiles) {
  // Upper 5 % and 1 % points of F (Pearson and Hartley, tables 18).
  EXPECT_NEAR(variance_ratio_tail(2.9782, 10., 10.), 0.05, 0.002);
  EXPECT_NEAR(variance_ratio_tail(2.2033, 30., 20.) / 0.035, 1., 0.15);
  EXPECT_NEAR(variance_ratio_tail(4.8491, 10., 10.), 0.01, 0.001);
}

TEST(SignificanceTests, HolmMultipliesTheSmallestMostAndKeepsOrder) {
  EXPECT_THAT(holm_corrected({0.01, 0.04, 0.03}), testing::ElementsAre(0.03, 0.06, 0.06));
  EXPECT_THAT(holm_corrected({0.9, 0.8}), testing::ElementsAre(1., 1.));
}

}  // namespace
}  // namespace vibrissa::diagnosis
