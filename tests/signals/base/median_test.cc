#include "signals/base/median.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace vibrissa::signals {
namespace {

TEST(Median, IsTheMiddleOneOrTheUpperOneOfBoth) {
  EXPECT_EQ(median({3.}), 3.);
  EXPECT_EQ(median({5., -1., 2.}), 2.);
  EXPECT_EQ(median({4., 1., 3., 2.}), 3.);
}

TEST(RobustDeviation, OfNormalValuesIsTheirsWhateverAFewOutliersAre) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0., 3.);
  std::vector<double> magnitudes(20000);
  for (double& m : magnitudes) m = std::abs(normal(random));
  EXPECT_NEAR(robust_deviation(magnitudes), 3., 0.06);
  for (std::size_t i = 0; i < 100; ++i) magnitudes[i] = 1e9;
  EXPECT_NEAR(robust_deviation(magnitudes), 3., 0.08);
}

}  // namespace
}  // namespace vibrissa::signals
